// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/live/live_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <future>
#include <memory>

#include "diagrams/live/adopt_state.h"
#include "diagrams/record/run_recorder.h"
#include "framework/error.h"
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

/// Where an obstacle that stands still has its position; empty if there is none of that name.
struct Standing {
  std::string path;
  std::vector<double> position;
};

std::vector<std::pair<std::string, Standing>> StandingObstacles(const LoadedDiagram& loaded) {
  std::vector<std::pair<std::string, Standing>> found;
  for (const LoadedDiagram::Block& block : loaded.systems) {
    const Value* const list =
        block.type == "ObstacleSource" ? block.params.Find("obstacles") : nullptr;
    if (list == nullptr || list->list() == nullptr) continue;
    for (std::size_t i = 0; i < list->list()->size(); ++i) {
      const Value& obstacle = (*list->list())[i];
      const Value* const id = obstacle.Find("id");
      const Value* const pose = obstacle.Find("pose");
      const Value* const xyz = pose == nullptr ? nullptr : pose->Find("xyz");
      const bool in_world = obstacle.Find("motion") == nullptr && obstacle.Find("frame") == nullptr;
      if (!in_world || id == nullptr || id->string() == nullptr || xyz == nullptr ||
          xyz->list() == nullptr) {
        continue;
      }
      Standing standing{fmt::format("systems.{}.obstacles.{}.pose.xyz", block.name, i), {}};
      for (const Value& number : *xyz->list()) {
        double value = 0.0;
        if (number.number(value)) standing.position.push_back(value);
      }
      if (standing.position.size() == 3) found.emplace_back(*id->string(), standing);
    }
  }
  return found;
}

std::string PositionName(const std::string& id) { return "obstacles." + id + ".position"; }

std::string Yaml(const LiveParameter::Value& value) {
  if (const bool* const flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* const number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* const text = std::get_if<std::string>(&value)) return *text;
  std::string list;
  for (const double number : std::get<std::vector<double>>(value)) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", number);
  }
  return "[" + list + "]";
}

/// A diagram while it runs, with what shows it.
class Session {
 public:
  Session(LoadedDiagram loaded, const LiveRunOptions& options, LiveServer& server,
          std::uint64_t epoch)
      : loaded_(std::move(loaded)),
        recorder_(loaded_,
                  {.version = options.version,
                   .overrides = {},
                   .start_epoch = epoch,
                   .attach_files = false},
                  {&server}, options.log),
        simulator_(*loaded_.diagram, loaded_.integrator) {
    simulator_.SetLog(&recorder_);
    simulator_.SetRealtimeFactor(options.realtime_factor);
  }
  ~Session() {
    diagrams::RunResult result{};
    result.duration = simulator_.context().time();
    result.metrics = "{}";
    try {
      if (attached_) recorder_.Finish(result);
    } catch (const std::exception&) {
      // nobody is left to be shown anything
    }
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void Start(Simulator::Monitor monitor) {
    simulator_.AddMonitor(std::move(monitor));
    recorder_.Attach(simulator_, true, kForever);
    attached_ = true;
  }

  /// As Start, where another session is now.
  void StartFrom(const Session& previous, Simulator::Monitor monitor) {
    const Context& old = previous.simulator_.context();
    simulator_.context().SetTime(old.time());
    // Before, so that what initialization reads is right; after, because it writes states.
    AdoptStates(*previous.loaded_.diagram, old, *loaded_.diagram, simulator_.context());
    Start(std::move(monitor));
    simulator_.Initialize();
    AdoptStates(*previous.loaded_.diagram, old, *loaded_.diagram, simulator_.context());
  }

  Simulator& simulator() { return simulator_; }
  const LoadedDiagram& loaded() const { return loaded_; }

 private:
  LoadedDiagram loaded_;
  record::RunRecorder recorder_;
  Simulator simulator_;
  bool attached_{false};
};

class LiveRunner {
 public:
  LiveRunner(const LiveRunOptions& options, LiveServer& server)
      : options_(options), server_(server), overrides_(options.overrides), epoch_(WallClock()) {
    session_ = std::make_unique<Session>(Load(overrides_), options_, server_, epoch_);
    server_.SetParameters(LiveParametersOf(session_->loaded()));
    session_->Start(Monitor());
  }

  LiveRunResult Run() {
    const double end = options_.duration.value_or(kForever);
    try {
      while (!stop_ && !session_->simulator().AdvanceTo(end)) {
        if (!stop_) Change();
      }
    } catch (const SimulationError& error) {
      result_.failure = error.what();
    }
    if (next_.valid()) next_.wait();
    result_.duration = session_->simulator().context().time();
    return result_;
  }

 private:
  LoadedDiagram Load(const std::vector<Override>& overrides) const {
    return diagrams::LoadDiagram(options_.file, overrides);
  }

  Simulator::Monitor Monitor() {
    return [this](const Context&) {
      if (options_.interrupted && options_.interrupted()) stop_ = true;
      if (!next_.valid()) BeginChange();
      const bool ready =
          next_.valid() && next_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
      return !stop_ && !ready;
    };
  }

  /// Loads what clients asked for, elsewhere.
  void BeginChange() {
    const std::vector<LiveParameter> changes = server_.TakeChanges();
    if (changes.empty()) return;
    wanted_ = overrides_;
    try {
      for (const LiveParameter& change : changes) {
        Put(wanted_, OverrideOf(session_->loaded(), change));
      }
    } catch (const ConfigError& error) {
      return Refuse(error.what());
    }
    next_ = std::async(std::launch::async, [this, wanted = wanted_] { return Load(wanted); });
  }

  void Change() {
    try {
      auto next = std::make_unique<Session>(next_.get(), options_, server_, epoch_);
      next->StartFrom(*session_, Monitor());
      session_ = std::move(next);
      overrides_ = wanted_;
      ++result_.changes;
    } catch (const oca::Error& error) {
      Refuse(error.what());
    }
  }

  void Refuse(const std::string& why) {
    if (options_.refused) options_.refused(why);
    server_.SetParameters(LiveParametersOf(session_->loaded()));
  }

  const LiveRunOptions& options_;
  LiveServer& server_;
  std::vector<Override> overrides_, wanted_;
  std::uint64_t epoch_;
  std::unique_ptr<Session> session_;
  std::future<LoadedDiagram> next_;
  bool stop_{false};
  LiveRunResult result_{};
};

}  // namespace

std::vector<LiveParameter> LiveParametersOf(const LoadedDiagram& loaded) {
  std::vector<LiveParameter> parameters;
  const Value* const section = loaded.document.Find("parameters");
  if (section != nullptr && section->map() != nullptr) {
    for (const Value::Entry& entry : *section->map()) {
      double number = 0.0;
      if (entry.value.boolean() != nullptr) {
        parameters.push_back({entry.key, *entry.value.boolean()});
      } else if (entry.value.number(number)) {
        parameters.push_back({entry.key, number});
      }
    }
  }
  for (const auto& [id, standing] : StandingObstacles(loaded)) {
    parameters.push_back({PositionName(id), standing.position});
  }
  return parameters;
}

Override OverrideOf(const LoadedDiagram& loaded, const LiveParameter& change) {
  for (const auto& [id, standing] : StandingObstacles(loaded)) {
    if (change.name == PositionName(id)) return {standing.path, Yaml(change.value)};
  }
  const Value* const section = loaded.document.Find("parameters");
  if (section == nullptr || section->Find(change.name) == nullptr) {
    throw ConfigError(
        fmt::format("live: parameter; got '{}'; expected one of the diagram's, or "
                    "obstacles.ID.position",
                    change.name));
  }
  return {"parameters." + change.name, Yaml(change.value)};
}

LiveRunResult RunLive(const LiveRunOptions& options, LiveServer& server) {
  return LiveRunner(options, server).Run();
}

}  // namespace oca::live
