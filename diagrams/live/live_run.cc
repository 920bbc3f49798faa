// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <optional>

#include "oca/diagrams/live/continued_sink.h"
#include "oca/diagrams/live/live_session.h"
#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/runs/chatter_check.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/simulation/simulator.h"

namespace oca::live {
namespace {

using files::Override;
using loading::LoadedDiagram;

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

class LiveRunner {
 public:
  LiveRunner(const LiveRunOptions& options, LiveServer& server)
      : options_(options),
        server_(server),
        blueprint_(options.file, options.catalogue),
        overrides_(options.overrides),
        epoch_(WallClock()) {
    for (record::RecordSink* const sink : options.sinks) {
      files_.push_back(std::make_unique<ContinuedSink>(*sink));
    }
    LoadedDiagram loaded = Build(overrides_);
    runs::AddChatterWarnings(loaded);
    for (const std::string& warning : loaded.warnings) Warn(warning);
    std::vector<std::string> warnings = loaded.warnings;
    session_ = MakeSession(std::move(loaded));
    told_ = std::move(warnings);
    judged_diagram_ = session_->shared_diagram();
    server_.SetParameters(Parameters());
    server_.AddMetadata({"oca.ranges", RangesOf(session_->loaded())});
    session_->Start(Monitor());
  }

  LiveRunResult Run() {
    const double end = options_.duration.value_or(kLiveDuration);
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
    runs::RunResult end_of_run{};
    end_of_run.failure = result_.failure;
    end_of_run.interrupted = stop_;
    end_of_run.metrics = runs::MetricsOf(session_->loaded(), session_->simulator().context());
    session_->End(end_of_run);
    if (!result_.failure.empty()) {
      server_.Tell(StatusLevel::kError, "the run failed: " + result_.failure);
    }
    return result_;
  }

 private:
  LoadedDiagram Build(const std::vector<Override>& overrides) const {
    return blueprint_.Build(overrides, {.movable = true});
  }

  void Warn(const std::string& warning) const {
    if (options_.warned) options_.warned(warning);
  }

  /// Says what a changed diagram is warned of. What takes long to find out is found elsewhere, and
  /// no change waits for it.
  void Judge() {
    if (judge_.valid()) {
      if (judge_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
      const std::vector<std::string> warnings = judge_.get();
      if (judged_diagram_ == session_->shared_diagram()) TellWarnings(warnings);
    }
    if (judged_diagram_ == session_->shared_diagram()) return;
    judged_diagram_ = session_->shared_diagram();
    judge_ = std::async(std::launch::async, [loaded = judged_diagram_] {
      std::vector<std::string> warnings = loaded->warnings;
      for (std::string& one : runs::ChatterWarnings(*loaded)) {
        warnings.push_back(std::move(one));
      }
      return warnings;
    });
  }

  void TellWarnings(const std::vector<std::string>& warnings) {
    if (warnings == *told_) return;
    for (const std::string& warning : warnings) {
      if (std::find(told_->begin(), told_->end(), warning) == told_->end()) Warn(warning);
    }
    session_->SetWarnings(warnings);
    told_ = warnings;
    server_.AddMetadata({"oca.warnings", record::WarningTexts(warnings)});
    server_.ShowMetadata();
  }

  std::unique_ptr<LiveSession> MakeSession(LoadedDiagram loaded) const {
    std::vector<record::RecordSink*> sinks{&server_};
    for (const auto& file : files_) sinks.push_back(file.get());
    record::RecorderOptions options{.version = options_.version,
                                    .overrides = options_.overrides,
                                    .start_epoch = epoch_,
                                    .attach_files = !told_ && !files_.empty(),
                                    .warnings = told_};
    auto session =
        std::make_unique<LiveSession>(std::move(loaded), std::move(options), std::move(sinks),
                                      options_.realtime_factor, options_.log);
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
      Judge();
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

  /// Takes what clients asked for: moves for the next tick; for the rest, builds the diagram
  /// elsewhere.
  void BeginChange() {
    const std::vector<LiveParameter> changes = server_.TakeChanges();
    wanted_ = overrides_;
    bool build = false;
    try {
      for (const LiveParameter& change : changes) {
        if (const auto move = MoveOf(change)) {
          moved_[change.name] = *move;
        } else {
          Put(wanted_, OverrideOf(session_->loaded(), change));
          build = true;
        }
      }
    } catch (const std::exception& error) {
      return Refuse(error.what());
    }
    if (!build) return;
    next_ = std::async(std::launch::async, [this, wanted = wanted_] { return Build(wanted); });
  }

  void Move() {
    Moves moves = moves_;
    for (const auto& [name, move] : moved_) moves[name] = move;
    moved_.clear();
    try {
      session_->Place(moves);
      moves_ = std::move(moves);
      ++result_.changes;
    } catch (const std::exception& error) {
      Refuse(error.what());
    }
  }

  void Change() {
    try {
      auto next = MakeSession(next_.get());
      next->Adopt(*session_);
      session_->End({});
      next->StartFrom(*session_, Monitor());
      session_ = std::move(next);
      overrides_ = wanted_;
      ++result_.changes;
      server_.SetParameters(Parameters());
    } catch (const std::exception& error) {
      Refuse(error.what());
    }
  }

  void Refuse(const std::string& why) {
    if (options_.refused) options_.refused(why);
    server_.Tell(StatusLevel::kError, "change refused: " + why);
    server_.SetParameters(Parameters());
  }

  const LiveRunOptions& options_;
  LiveServer& server_;
  const loading::Blueprint blueprint_;
  std::vector<Override> overrides_, wanted_;
  std::uint64_t epoch_;
  std::vector<std::unique_ptr<ContinuedSink>> files_;
  Moves moves_, moved_;  ///< in effect; asked for
  std::unique_ptr<LiveSession> session_;
  std::future<LoadedDiagram> next_;
  std::optional<std::vector<std::string>> told_;  ///< what was warned of; none before the run
  std::shared_ptr<const LoadedDiagram> judged_diagram_;
  std::future<std::vector<std::string>> judge_;  ///< what that one is warned of
  bool stop_{false};
  LiveRunResult result_{};
};

}  // namespace

LiveRunResult RunLive(const LiveRunOptions& options, LiveServer& server) {
  return LiveRunner(options, server).Run();
}

}  // namespace oca::live
