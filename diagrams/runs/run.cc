// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "oca/diagrams/runs/adopt_state.h"
#include "oca/diagrams/runs/expectations.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/systems/signals/roles.h"

namespace oca::runs {
namespace {

using loading::LoadedDiagram;

/// What systems log, for whoever asked for it and for outputs.
class SharedLog final : public Log {
 public:
  SharedLog(Log* first, const std::vector<RunOutput*>& outputs) : first_(first) {
    for (RunOutput* const output : outputs) {
      if (Log* const log = output->log()) logs_.push_back(log);
    }
  }
  bool enabled(LogLevel level) const override {
    const bool kept = !logs_.empty() && level != LogLevel::kDebug;
    return kept || (first_ != nullptr && first_->enabled(level));
  }
  void Write(LogLevel level, double time, std::string_view text) override {
    if (first_ != nullptr && first_->enabled(level)) first_->Write(level, time, text);
    for (Log* const log : logs_) log->Write(level, time, text);
  }

 private:
  Log* const first_;
  std::vector<Log*> logs_;
};

void CheckOutputList(const std::vector<RunOutput*>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i] == nullptr) {
      throw ConfigError(fmt::format("outputs[{}]: got none; expected an output", i));
    }
    const auto first = std::find(outputs.begin(), outputs.end(), outputs[i]) - outputs.begin();
    if (first == static_cast<std::ptrdiff_t>(i)) continue;
    throw ConfigError(
        fmt::format("outputs[{}]: got the same as outputs[{}]; expected each once", i, first));
  }
}

std::vector<Blocked> WhatBlocks(const LoadedDiagram& loaded, const Context& context) {
  std::vector<Blocked> blocked;
  for (const auto& knows : loaded.diagram->FindRoles<systems::KnowsWhatBlocks>()) {
    if (auto by = knows.role->what(context)) blocked.push_back({knows.path, *std::move(by)});
  }
  return blocked;
}

class Runner final : public RunControl {
 public:
  Runner(const LoadedDiagram& loaded, const RunOptions& options)
      : options_(options),
        duration_(options.duration.value_or(loaded.simulator.duration)),
        log_(options.log, options.outputs),
        loaded_(&loaded) {
    if (options.judge) check_.emplace(loaded, duration_);
    result_.paced = FactorOf(loaded) > 0.0;
    simulator_ = Make(loaded);
    for (RunOutput* const output : options.outputs) output->Prepare(Start(false));
    Begin(false);
  }

  RunResult Run() {
    const auto start = std::chrono::steady_clock::now();
    try {
      simulator_->Initialize();
      AdvanceThroughExpectations();
    } catch (const SimulationError& error) {
      result_.failure = RunFailure{error.system, error.port, error.time, error.what()};
    }
    result_.wall_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result_.duration = simulator_->context().time();
    result_.statistics = simulator_->statistics();
    result_.profile = simulator_->profile();
    result_.judgements = JudgementsOf(*loaded_, simulator_->context());
    result_.metrics = MetricsOfAll(result_.judgements);
    if (!result_.failure) result_.blocked = WhatBlocks(*loaded_, simulator_->context());
    if (check_) {
      result_.expectations = check_->Finish(*loaded_, result_.metrics, result_.duration);
    }
    for (RunOutput* const output : options_.outputs) End(*output);
    return std::move(result_);
  }

  Context& context() override { return simulator_->context(); }

  /// A trial shows whether the run can go on before anything of it is given up.
  void Replace(std::shared_ptr<const LoadedDiagram> next) override {
    if (!next) throw ConfigError("replace: got no diagram; expected one");
    auto simulator = Make(*next);
    Simulator trial(*next->diagram, simulator->context(), next->simulator.integration);
    Adopt(*next, trial.context());
    trial.Initialize();
    Adopt(*next, simulator->context());
    next_ = std::move(next);
    next_simulator_ = std::move(simulator);
  }

  void SetWarnings(const std::vector<std::string>& warnings) override {
    for (RunOutput* const output : options_.outputs) output->SetWarnings(warnings);
  }

 private:
  double FactorOf(const LoadedDiagram& loaded) const {
    return options_.realtime_factor.value_or(loaded.simulator.realtime_factor);
  }

  std::unique_ptr<Simulator> Make(const LoadedDiagram& loaded) {
    auto simulator = std::make_unique<Simulator>(*loaded.diagram, loaded.simulator.integration);
    simulator->SetLog(&log_);
    simulator->SetRealtimeFactor(FactorOf(loaded));
    if (options_.profile) simulator->EnableProfile();
    if (options_.hook != nullptr) options_.hook->Prepare(loaded, simulator->context());
    return simulator;
  }

  RunStart Start(bool continued) {
    return {*loaded_, *simulator_, result_.paced, duration_, continued};
  }

  void Begin(bool continued) {
    AddRecordedInstants();
    for (RunOutput* const output : options_.outputs) {
      output->Begin(Start(continued));
    }
    if (options_.progress || options_.hook != nullptr) {
      simulator_->AddMonitor([this](const Context& context) { return GoesOn(context.time()); });
    }
  }

  bool GoesOn(double time) {
    stopped_ = stopped_ || (options_.progress && !options_.progress(time));
    changes_ = !stopped_ && options_.hook != nullptr && options_.hook->WantsChange();
    return !stopped_ && !changes_;
  }

  /// A run stops where its signals are recorded also if nobody records them, so that recording does
  /// not change a bit of it.
  void AddRecordedInstants() {
    std::vector<Period> periods;
    for (const files::RecordedSignal& signal : loaded_->record) {
      if (std::find(periods.begin(), periods.end(), signal.period) != periods.end()) continue;
      periods.push_back(signal.period);
      simulator_->AddPublish(signal.period, [](const Context&) {});
    }
  }

  void AdvanceThroughExpectations() {
    for (const double stop : check_ ? check_->stops() : std::vector{duration_}) {
      if (!AdvanceTo(stop)) {
        result_.interrupted = true;
        return;
      }
      if (check_) check_->CheckAt(stop, *loaded_, simulator_->context());
    }
  }

  /// Returns false if it was interrupted before.
  bool AdvanceTo(double stop) {
    while (true) {
      const double slice = SliceTo(stop);
      const bool there = simulator_->AdvanceTo(slice);
      if (stopped_ && !there) return false;
      if (changes_) Change();
      if (there && slice == stop) return true;
    }
  }

  /// Without events a run is one step, after which alone an interrupt would be seen.
  double SliceTo(double stop) const {
    constexpr double kSlice = 1.0;  // s
    const double time = simulator_->context().time();
    const bool events = !loaded_->diagram->schedule().groups.empty();
    return events || stop - time <= kSlice ? stop : time + kSlice;
  }

  void Change() {
    changes_ = false;
    options_.hook->Change(*this);
    if (!next_) return;
    for (RunOutput* const output : options_.outputs) output->Pause();
    const auto before = std::move(simulator_);
    const auto kept = std::move(changed_);  // what `before` runs
    const LoadedDiagram& diagram_before = *loaded_;
    simulator_ = std::move(next_simulator_);
    changed_ = std::move(next_);
    loaded_ = changed_.get();
    Begin(true);
    simulator_->Initialize();  // which writes states
    AdoptFrom(diagram_before, before->context(), *loaded_, simulator_->context());
  }

  void Adopt(const LoadedDiagram& next, Context& to) const {
    AdoptFrom(*loaded_, simulator_->context(), next, to);
  }
  static void AdoptFrom(const LoadedDiagram& previous, const Context& from,
                        const LoadedDiagram& next, Context& to) {
    to.SetTime(from.time());
    AdoptStates(*previous.diagram, from, *next.diagram, to);
  }

  void End(RunOutput& output) {
    try {
      output.End(result_);
    } catch (const Error& error) {
      if (!result_.failure) result_.failure = RunFailure{"", "", result_.duration, error.what()};
    }
  }

  const RunOptions& options_;
  const double duration_;
  SharedLog log_;
  const LoadedDiagram* loaded_;
  std::shared_ptr<const LoadedDiagram> changed_, next_;  ///< that the run went, is to go on with
  std::unique_ptr<Simulator> simulator_, next_simulator_;
  std::optional<ExpectationCheck> check_;
  bool stopped_{false}, changes_{false};
  RunResult result_{};
};

}  // namespace

bool RunResult::ExpectationsMet() const {
  return std::all_of(expectations.begin(), expectations.end(),
                     [](const ExpectationResult& result) { return result.ok; });
}

std::vector<Judgement> JudgementsOf(const LoadedDiagram& loaded, const Context& context) {
  return JudgementsOf(loaded.metrics, context);
}

std::vector<Judgement> JudgementsOf(const files::NamedOutputs& judges, const Context& context) {
  std::vector<Judgement> judgements;
  try {
    for (const auto& [name, output] : judges) {
      judgements.push_back({name, Typed<systems::MotionMetricsValue>(output).Eval(context)});
    }
  } catch (const SimulationError&) {
    return {};  // what failed a run fails here again
  }
  return judgements;
}

void CheckRunFiles(const LoadedDiagram& loaded, const RunOptions& options) {
  std::vector<OutputFile> outputs;
  for (const RunOutput* const output : options.outputs) {
    for (OutputFile& file : output->Files(loaded)) outputs.push_back(std::move(file));
  }
  std::vector<InputFile> inputs = options.inputs;
  if (!loaded.file.empty()) inputs.push_back({loaded.file, "what is run"});
  for (InputFile& input : InputsOf(loaded.opened, "read by what is run")) {
    inputs.push_back(std::move(input));
  }
  CheckOutputs(outputs, inputs);
}

RunResult Run(const LoadedDiagram& loaded, const RunOptions& options) {
  if (options.duration && !(*options.duration >= 0.0 && *options.duration <= 1e7)) {
    throw ConfigError(fmt::format("duration: got {} s; expected in [0, 1e7]", *options.duration));
  }
  CheckOutputList(options.outputs);
  CheckRunFiles(loaded, options);
  return Runner(loaded, options).Run();
}

}  // namespace oca::runs
