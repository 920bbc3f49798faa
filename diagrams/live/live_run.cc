// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/live/live_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <future>
#include <map>
#include <memory>

#include "diagrams/live/adopt_state.h"
#include "diagrams/live/continued_sink.h"
#include "diagrams/record/run_recorder.h"
#include "diagrams/run.h"
#include "framework/error.h"
#include "framework/port_access.h"
#include "framework/simulator.h"

namespace oca::live {
namespace {

using diagrams::LoadedDiagram;
using diagrams::Override;

constexpr double kForever = 1e6;  // s

std::uint64_t WallClock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

/// A later override of a path takes the place of an earlier one.
void Put(std::vector<Override>& overrides, const Override& one) {
  std::erase_if(overrides, [&](const Override& other) { return other.path == one.path; });
  overrides.push_back(one);
}

/// Where obstacles were moved to from where the file has them, m, by the names of their positions.
using Moves = std::map<std::string, Eigen::Vector3d>;

/// A diagram while it runs, with what shows it.
class Session {
 public:
  Session(LoadedDiagram loaded, const LiveRunOptions& options, LiveServer& server,
          std::uint64_t epoch, const std::vector<record::RecordSink*>& files, bool first)
      : loaded_(std::move(loaded)),
        recorder_(loaded_,
                  {.version = options.version,
                   .overrides = options.overrides,
                   .start_epoch = epoch,
                   .attach_files = first && !files.empty()},
                  SinksOf(server, files), options.log),
        simulator_(*loaded_.diagram, loaded_.integrator) {
    simulator_.SetLog(&recorder_);
    simulator_.SetRealtimeFactor(options.realtime_factor);
  }
  ~Session() { End({}); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void Start(Simulator::Monitor monitor) {
    simulator_.AddMonitor(std::move(monitor));
    recorder_.Attach(simulator_, true, kForever);
    attached_ = true;
  }

  /// Takes over time and states. throws ConfigError or SimulationError if it cannot go on from
  /// them.
  void Adopt(const Session& previous) {
    const Context& old = previous.simulator_.context();
    Simulator trial(*loaded_.diagram, simulator_.context(), loaded_.integrator);
    AdoptFrom(previous, old, trial.context());
    trial.Initialize();
    AdoptFrom(previous, old, simulator_.context());
  }

  /// As Start, where another session is now; that one must have ended.
  void StartFrom(const Session& previous, Simulator::Monitor monitor) {
    Start(std::move(monitor));
    simulator_.Initialize();  // which writes states
    AdoptFrom(previous, previous.simulator_.context(), simulator_.context());
  }

  /// No more is recorded. `result` says how the run ended; none of a run that goes on has metrics.
  void End(diagrams::RunResult result) {
    if (!attached_) return;
    attached_ = false;
    result.duration = simulator_.context().time();
    try {
      recorder_.Finish(result);
    } catch (const std::exception&) {
      // nobody is left to be shown anything
    }
  }

  /// Puts obstacles where they were moved to, and all others where the file has them.
  void Place(const Moves& moves) {
    std::map<std::string, Eigen::VectorXd> offsets;
    for (const Diagram::ExportedInput& input : loaded_.diagram->exported_inputs()) {
      const auto& ports = input.to.front().system->inputs();
      const int size = ports[static_cast<std::size_t>(input.to.front().index)].spec.size.number();
      offsets[input.name] = Eigen::VectorXd::Zero(size);
    }
    for (const auto& [id, standing] : StandingObstacles(loaded_)) {
      const auto move = moves.find(PositionName(id));
      const auto offset = offsets.find(standing.input);
      if (move == moves.end() || offset == offsets.end()) continue;
      offset->second.segment<3>(static_cast<Eigen::Index>(standing.first)) = move->second;
    }
    for (const auto& [name, offset] : offsets) {
      loaded_.diagram->GetInput<Vector>(name).Fix(simulator_.context(), offset);
    }
  }

  Simulator& simulator() { return simulator_; }
  const LoadedDiagram& loaded() const { return loaded_; }

 private:
  static std::vector<record::RecordSink*> SinksOf(LiveServer& server,
                                                  const std::vector<record::RecordSink*>& files) {
    std::vector<record::RecordSink*> sinks{&server};
    sinks.insert(sinks.end(), files.begin(), files.end());
    return sinks;
  }
  void AdoptFrom(const Session& previous, const Context& from, Context& to) const {
    to.SetTime(from.time());
    AdoptStates(*previous.loaded_.diagram, from, *loaded_.diagram, to);
  }

  LoadedDiagram loaded_;
  record::RunRecorder recorder_;
  Simulator simulator_;
  bool attached_{false};
};

class LiveRunner {
 public:
  LiveRunner(const LiveRunOptions& options, LiveServer& server)
      : options_(options), server_(server), overrides_(options.overrides), epoch_(WallClock()) {
    for (record::RecordSink* const sink : options.sinks) {
      files_.push_back(std::make_unique<ContinuedSink>(*sink));
    }
    session_ = MakeSession(Load(overrides_), true);
    server_.SetParameters(Parameters());
    server_.AddMetadata({"oca.ranges", RangesOf(session_->loaded())});
    session_->Start(Monitor());
  }

  LiveRunResult Run() {
    const double end = options_.duration.value_or(kForever);
    try {
      while (!stop_ && !session_->simulator().AdvanceTo(end)) {
        if (stop_) break;
        if (!moved_.empty()) Move();
        if (Ready()) Change();
      }
    } catch (const SimulationError& error) {
      result_.failure = error.what();
    }
    if (next_.valid()) next_.wait();
    result_.duration = session_->simulator().context().time();
    diagrams::RunResult end_of_run{};
    end_of_run.failure = result_.failure;
    end_of_run.interrupted = stop_;
    end_of_run.metrics = diagrams::MetricsOf(session_->loaded(), session_->simulator().context());
    session_->End(end_of_run);
    return result_;
  }

 private:
  LoadedDiagram Load(const std::vector<Override>& overrides) const {
    return diagrams::LoadMovable(options_.file, overrides);
  }

  std::unique_ptr<Session> MakeSession(LoadedDiagram loaded, bool first) const {
    std::vector<record::RecordSink*> files;
    for (const auto& file : files_) files.push_back(file.get());
    auto session =
        std::make_unique<Session>(std::move(loaded), options_, server_, epoch_, files, first);
    session->Place(moves_);
    return session;
  }

  bool Ready() const {
    return next_.valid() && next_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  Simulator::Monitor Monitor() {
    return [this](const Context&) {
      if (options_.interrupted && options_.interrupted()) stop_ = true;
      if (!next_.valid()) BeginChange();
      return !stop_ && moved_.empty() && !Ready();
    };
  }

  /// The file's parameters, with obstacles where they were moved to.
  std::vector<LiveParameter> Parameters() const {
    std::vector<LiveParameter> parameters = LiveParametersOf(session_->loaded());
    for (LiveParameter& parameter : parameters) {
      const auto move = moves_.find(parameter.name);
      auto* const position = std::get_if<std::vector<double>>(&parameter.value);
      if (move == moves_.end() || position == nullptr) continue;
      for (int i = 0; i < 3; ++i) (*position)[static_cast<std::size_t>(i)] += move->second[i];
    }
    return parameters;
  }

  /// Whether an obstacle can be moved by an input, and by how much that is.
  std::optional<Eigen::Vector3d> MoveOf(const LiveParameter& change) const {
    const auto* const position = std::get_if<std::vector<double>>(&change.value);
    if (position == nullptr) return std::nullopt;
    const auto& inputs = session_->loaded().diagram->exported_inputs();
    for (const auto& [id, standing] : StandingObstacles(session_->loaded())) {
      if (change.name != PositionName(id)) continue;
      const bool exported =
          std::any_of(inputs.begin(), inputs.end(),
                      [&input = standing.input](const auto& one) { return one.name == input; });
      if (!exported) return std::nullopt;
      return Eigen::Vector3d(Eigen::Vector3d::Map(position->data()) -
                             Eigen::Vector3d::Map(standing.position.data()));
    }
    return std::nullopt;
  }

  /// Takes what clients asked for: moves for the next tick; for the rest, loads the diagram
  /// elsewhere.
  void BeginChange() {
    const std::vector<LiveParameter> changes = server_.TakeChanges();
    wanted_ = overrides_;
    bool load = false;
    try {
      for (const LiveParameter& change : changes) {
        if (const auto move = MoveOf(change)) {
          moved_[change.name] = *move;
        } else {
          Put(wanted_, OverrideOf(session_->loaded(), change));
          load = true;
        }
      }
    } catch (const ConfigError& error) {
      return Refuse(error.what());
    }
    if (!load) return;
    next_ = std::async(std::launch::async, [this, wanted = wanted_] { return Load(wanted); });
  }

  void Move() {
    Moves moves = moves_;
    for (const auto& [name, move] : moved_) moves[name] = move;
    moved_.clear();
    try {
      session_->Place(moves);
      moves_ = std::move(moves);
      ++result_.changes;
    } catch (const ConfigError& error) {
      Refuse(error.what());
    }
  }

  void Change() {
    try {
      auto next = MakeSession(next_.get(), false);
      next->Adopt(*session_);
      session_->End({});
      next->StartFrom(*session_, Monitor());
      session_ = std::move(next);
      overrides_ = wanted_;
      ++result_.changes;
      server_.SetParameters(Parameters());
    } catch (const oca::Error& error) {
      Refuse(error.what());
    }
  }

  void Refuse(const std::string& why) {
    if (options_.refused) options_.refused(why);
    server_.SetParameters(Parameters());
  }

  const LiveRunOptions& options_;
  LiveServer& server_;
  std::vector<Override> overrides_, wanted_;
  std::uint64_t epoch_;
  std::vector<std::unique_ptr<ContinuedSink>> files_;
  Moves moves_, moved_;  ///< in effect; asked for
  std::unique_ptr<Session> session_;
  std::future<LoadedDiagram> next_;
  bool stop_{false};
  LiveRunResult result_{};
};

}  // namespace

LiveRunResult RunLive(const LiveRunOptions& options, LiveServer& server) {
  return LiveRunner(options, server).Run();
}

}  // namespace oca::live
