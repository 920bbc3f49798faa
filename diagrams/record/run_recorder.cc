// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/run_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "oca/diagrams/record/plot_hints.h"
#include "oca/diagrams/record/record_files.h"
#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/runs/blind_spots.h"
#include "oca/diagrams/runs/signal_table.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"

namespace oca::record {
namespace {

using files::RecordedSignal;

/// Samples that one group keeps for the recorder's thread.
constexpr double kMostSamples = 16384.0;
/// Levels of foxglove.Log.
constexpr int kWarning = 3;
constexpr int kError = 4;
/// Once only, at the start: no run lasts longer.
const Period kNeverAgain(10'000'000, 1);

std::uint64_t WallClock() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

int CapacityFor(double duration, const Period& period) {
  return static_cast<int>(std::clamp(duration / period.seconds() + 3.0, 64.0, kMostSamples));
}

}  // namespace

RunRecorder::RunRecorder(const loading::LoadedDiagram& loaded, RecorderOptions options,
                         std::vector<RecordSink*> sinks, Log* log)
    : loaded_(loaded),
      options_(std::move(options)),
      warnings_(options_.warnings.value_or(loaded.warnings)),
      sinks_(std::move(sinks)),
      log_(log) {
  if (options_.start_epoch == 0) options_.start_epoch = WallClock();
}

RunRecorder::~RunRecorder() {
  done_.store(true);
  if (thread_.joinable()) thread_.join();
}

int RunRecorder::AddChannel(RecordChannel channel) {
  channels_.push_back(std::move(channel));
  return static_cast<int>(channels_.size()) - 1;
}

SignalFormat RunRecorder::FormatOf(const OutputHandle& output) const {
  const std::string name = loaded_.diagram->PathOf(output);
  SignalFormat format;
  format.system = name.substr(0, name.rfind('.'));
  format.port = name.substr(name.rfind('.') + 1);
  format.type = &TypeOfPort(output);
  format.brief = options_.brief;
  format.length = loaded_.diagram->SizeOf(output);
  if (format.type != &kVectorType) return format;
  format.unit = loaded_.diagram->UnitOf(output).ToString();
  format.joints = facts_->JointsOf(output);
  return format;
}

void RunRecorder::AddSignals(double duration, Groups& groups) {
  for (const RecordedSignal& signal : loaded_.record) {
    auto same = std::find_if(signals_.begin(), signals_.end(),
                             [&](const auto& group) { return group.period == signal.period; });
    if (same == signals_.end()) {
      same = signals_.insert(signals_.end(), SignalGroup{signal.period, {}, {}});
      groups.push_back({{}, CapacityFor(duration, signal.period)});
    }
    same->formats.push_back(FormatOf(signal.output));
    same->channels.push_back(AddChannel(ChannelOf(same->formats.back())));
    groups[static_cast<std::size_t>(same - signals_.begin())].outputs.push_back(signal.output);
  }
}

/// What shows when a system limits and nobody records, at the system's own instants.
void RunRecorder::AddLimits(double duration, Groups& groups) {
  for (const LimitHint& hint : LimitHintsOf(loaded_)) {
    if (!hint.period.positive() || HasChannelOf(hint.output)) continue;
    const SignalFormat format = FormatOf(hint.output);
    const int channel = AddChannel(ChannelOf(format));
    signals_.push_back({hint.period, {format}, {channel}});
    groups.push_back({{hint.output}, CapacityFor(duration, hint.period)});
  }
}

bool RunRecorder::HasChannelOf(const OutputHandle& output) const {
  const RecordChannel channel = ChannelOf(FormatOf(output));
  return std::any_of(channels_.begin(), channels_.end(),
                     [&](const auto& other) { return other.topic == channel.topic; });
}

/// The last group: what the scene shows, then what plots and limits need and nobody records.
void RunRecorder::AddScene(double duration, Groups& groups) {
  scene_group_ = static_cast<int>(groups.size());
  SampleQueue::Group group{scene_->sources(), CapacityFor(duration, loaded_.scene_period)};
  SignalGroup extra{loaded_.scene_period, {}, {}};
  const auto add = [&](const OutputHandle& output) {
    if (HasChannelOf(output)) return;
    extra.formats.push_back(FormatOf(output));
    extra.channels.push_back(AddChannel(ChannelOf(extra.formats.back())));
    group.outputs.push_back(output);
  };
  for (const PlotHint& hint : PlotHintsOf(loaded_)) {
    for (const OutputHandle& output : hint.outputs) add(output);
  }
  for (const LimitHint& hint : LimitHintsOf(loaded_)) add(hint.output);
  signals_.push_back(std::move(extra));
  groups.push_back(std::move(group));
}

void RunRecorder::Attach(Simulator& simulator, bool paced, double duration) {
  simulator_ = &simulator;
  paced_ = paced;
  duration_ = duration;
  facts_ = std::make_unique<runs::SignalFacts>(loaded_);
  scene_ = std::make_unique<Scene>(loaded_, *facts_);
  channels_ = Scene::Channels();
  log_channel_ = AddChannel({"/log", "foxglove.Log", FoxgloveSchema("foxglove.Log")});
  metrics_channel_ = AddChannel({"/metrics", "oca.Metrics", R"({"type":"object"})"});
  Groups groups;
  AddSignals(duration, groups);
  AddLimits(duration, groups);
  AddScene(duration, groups);
  queue_ = std::make_unique<SampleQueue>(std::move(groups), *loaded_.diagram, simulator.context());
  for (int group = 0; group < scene_group_; ++group) {
    simulator.AddPublish(signals_[static_cast<std::size_t>(group)].period,
                         [this, group](const Context& context) { Store(group, context); });
  }
  simulator.AddPublish(kNeverAgain, [this](const Context& context) { SampleScene(context); });
  simulator.AddMonitor([this](const Context& context) {
    if (context.time() >= loaded_.scene_period.seconds(scene_count_)) {
      SampleScene(context);
    }
    return true;
  });
  BeginSinks();
  thread_ = std::thread([this] { Work(); });
}

void RunRecorder::BeginSinks() {
  for (RecordSink* const sink : sinks_) {
    if (options_.attach_files) {
      for (McapAttachment& file : FilesOf(loaded_, duration_)) {
        file.log_time = options_.start_epoch;
        sink->AddAttachment(file);
      }
    }
    sink->AddMetadata(MainMetadata("running", nullptr));
    sink->AddMetadata({"oca.parameters", ParameterTexts(loaded_)});
    sink->AddMetadata({"oca.overrides", OverrideTexts(options_.overrides)});
    const std::string plots = PlotHintsJson(loaded_, PlotHintsOf(loaded_));
    const std::string limits = LimitHintsJson(loaded_, LimitHintsOf(loaded_));
    sink->AddMetadata({"oca.plots", {{"plots", plots}, {"limits", limits}}});
    sink->AddMetadata({"oca.warnings", WarningTexts(warnings_)});
    sink->Begin(channels_);
  }
  if (!options_.warnings) {
    for (const std::string& warning : warnings_) {
      Emit(log_channel_, 0.0, LogMessage(TimeOf(0.0), kWarning, warning));
    }
  }
  scene_->DrawRobots(options_.start_epoch,
                     [this](int channel, const std::string& json) { Emit(channel, 0.0, json); });
}

std::uint64_t RunRecorder::TimeOf(double time) const {
  return options_.start_epoch + static_cast<std::uint64_t>(runs::Nanoseconds(time));
}

void RunRecorder::WaitFor(const std::function<bool()>& room) {
  while (!paced_ && !room() && !done_.load(std::memory_order_relaxed)) {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

void RunRecorder::Store(int group, const Context& context) {
  if (!queue_->HasRoom(group)) WaitFor([&] { return queue_->HasRoom(group); });
  queue_->Store(group, context);
}

void RunRecorder::SampleScene(const Context& context) {
  if (context.time() == scene_time_) return;
  Store(scene_group_, context);
  scene_time_ = context.time();
  scene_count_ = loaded_.scene_period.CountAt(scene_time_) + 1;
}

bool RunRecorder::enabled(LogLevel level) const {
  return level != LogLevel::kDebug || (log_ != nullptr && log_->enabled(level));
}

void RunRecorder::Write(LogLevel level, double time, std::string_view text) {
  if (log_ != nullptr && log_->enabled(level)) log_->Write(level, time, text);
  if (!queue_) return;
  if (!queue_->HasRoomForText()) WaitFor([this] { return queue_->HasRoomForText(); });
  queue_->StoreText(static_cast<int>(level) + 1, time, text);
}

void RunRecorder::SetWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    if (std::find(warnings_.begin(), warnings_.end(), warning) != warnings_.end()) continue;
    if (!queue_->HasRoomForText()) WaitFor([this] { return queue_->HasRoomForText(); });
    queue_->StoreText(kWarning, simulator_->context().time(), warning);
  }
  warnings_ = warnings;
}

/// Runs on the recorder's thread until the run is over and the queue empty.
void RunRecorder::Work() {
  try {
    while (true) {
      const bool last = done_.load(std::memory_order_acquire);
      int count = 0;
      while (queue_->Take([this](const SampleQueue::Sample& sample) { Encode(sample); })) {
        if (++count % 256 == 0) {
          for (RecordSink* const sink : sinks_) sink->Idle();
        }
      }
      if (last) return;
      for (RecordSink* const sink : sinks_) sink->Idle();
      if (count == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  } catch (...) {
    failure_ = std::current_exception();
    done_.store(true);
  }
}

void RunRecorder::Encode(const SampleQueue::Sample& sample) {
  if (sample.group < 0) {
    Emit(log_channel_, sample.time, LogMessage(TimeOf(sample.time), sample.level, sample.text));
    return;
  }
  std::size_t at = 0;
  if (sample.group == scene_group_) {
    scene_->Draw(TimeOf(sample.time), sample.values,
                 [&](int channel, const std::string& json) { Emit(channel, sample.time, json); });
    at = scene_->sources().size();
  }
  const SignalGroup& group = signals_[static_cast<std::size_t>(sample.group)];
  for (std::size_t i = 0; i < group.formats.size(); ++i) {
    text_.clear();
    AppendSignal(text_, group.formats[i], sample.values[at + i]);
    Emit(group.channels[i], sample.time, text_);
  }
}

void RunRecorder::Emit(int channel, double time, std::string_view json) {
  for (RecordSink* const sink : sinks_) sink->Write(channel, TimeOf(time), json);
}

McapMetadata RunRecorder::MainMetadata(const std::string& outcome,
                                       const runs::RunResult* result) const {
  McapTexts values{{"version", options_.version},
                   {"diagram", loaded_.name},
                   {"description", loaded_.description},
                   {"seed", std::to_string(loaded_.simulator.seed)},
                   {"start_epoch_ns", std::to_string(options_.start_epoch)},
                   {"dropped_messages", std::to_string(dropped())},
                   {"not_seen", NotSeenJson(loaded_)},
                   {"outcome", outcome}};
  if (result != nullptr) {
    values["duration"] = fmt::format("{}", result->duration);
    values["expectations"] = ExpectationsJson(*result);
  }
  return {"oca", values};
}

void RunRecorder::Finish(const runs::RunResult& result) {
  try {
    SampleScene(simulator_->context());
  } catch (const SimulationError&) {
    // What failed the run fails here again.
  }
  if (!result.failure.empty()) {
    WaitFor([this] { return queue_->HasRoomForText(); });
    queue_->StoreText(kError, result.duration, result.failure);
  }
  done_.store(true, std::memory_order_release);
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  const double end = simulator_->context().time();
  scene_->Finish(TimeOf(end),
                 [&](int channel, const std::string& json) { Emit(channel, end, json); });
  if (!result.metrics.empty()) Emit(metrics_channel_, end, result.metrics);
  const std::string outcome = !result.failure.empty() ? "failed: " + result.failure
                              : result.interrupted    ? "interrupted"
                                                      : "done";
  for (RecordSink* const sink : sinks_) {
    sink->AddMetadata(MainMetadata(outcome, &result));
    sink->AddMetadata({"oca.warnings", WarningTexts(warnings_)});
    sink->End();
  }
}

}  // namespace oca::record
