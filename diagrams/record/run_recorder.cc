// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/run_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "oca/diagrams/record/plot_hints.h"
#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/record/signal_json.h"
#include "oca/diagrams/runs/position_unit.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/signal_table.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/version.h"

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

int CapacityFor(double duration, const Period& period) {
  return static_cast<int>(std::clamp(duration / period.seconds() + 3.0, 64.0, kMostSamples));
}

}  // namespace

RunRecorder::RunRecorder(const runs::RunStart& run, const RecorderOptions& options,
                         std::vector<Attachment> files, std::vector<RecordSink*> sinks,
                         std::optional<std::vector<std::string>> told)
    : loaded_(run.loaded),
      options_(options),
      warnings_(told.value_or(run.loaded.warnings)),
      sinks_(std::move(sinks)),
      simulator_(run.simulator),
      paced_(run.paced),
      duration_(run.duration),
      facts_(run.loaded),
      scene_(run.loaded, facts_),
      channels_(Scene::Channels()) {
  log_channel_ = AddChannel({"/log", "foxglove.Log", FoxgloveSchema("foxglove.Log")});
  const SignalFormat metrics{"", "metrics", &TypeOf<systems::MotionMetricsValue>(), 0, "", {}};
  metrics_channel_ = AddChannel({"/metrics", "oca.Metrics", R"({"type":"object"})", metrics});
  Groups groups;
  AddSignals(groups);
  AddLimits(groups);
  AddScene(groups);
  queue_ = std::make_unique<SampleQueue>(std::move(groups), *loaded_.diagram, simulator_.context());
  for (int group = 0; group < scene_group_; ++group) {
    simulator_.AddPublish(signals_[static_cast<std::size_t>(group)].period,
                          [this, group](const Context& context) { Store(group, context); });
  }
  simulator_.AddPublish(kNeverAgain, [this](const Context& context) { SampleScene(context); });
  simulator_.AddMonitor([this](const Context& context) {
    if (context.time() >= loaded_.scene_period.seconds(scene_count_)) SampleScene(context);
    return true;
  });
  BeginSinks(std::move(files), !told);
  thread_ = std::thread([this] { Work(); });
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
  format.joints = facts_.JointsOf(output);
  return format;
}

void RunRecorder::AddSignals(Groups& groups) {
  for (const RecordedSignal& signal : loaded_.record) {
    auto same = std::find_if(signals_.begin(), signals_.end(),
                             [&](const auto& group) { return group.period == signal.period; });
    if (same == signals_.end()) {
      same = signals_.insert(signals_.end(), SignalGroup{signal.period, {}});
      groups.push_back({{}, CapacityFor(duration_, signal.period)});
    }
    same->channels.push_back(AddChannel(ChannelOf(FormatOf(signal.output))));
    groups[static_cast<std::size_t>(same - signals_.begin())].outputs.push_back(signal.output);
  }
}

/// What shows when a system limits and nobody records, at the system's own instants.
void RunRecorder::AddLimits(Groups& groups) {
  for (const LimitHint& hint : LimitHintsOf(loaded_)) {
    if (!hint.period.positive() || HasChannelOf(hint.output)) continue;
    signals_.push_back({hint.period, {AddChannel(ChannelOf(FormatOf(hint.output)))}});
    groups.push_back({{hint.output}, CapacityFor(duration_, hint.period)});
  }
}

bool RunRecorder::HasChannelOf(const OutputHandle& output) const {
  const std::string topic = TopicOf(FormatOf(output));
  return std::any_of(channels_.begin(), channels_.end(),
                     [&](const auto& other) { return other.topic == topic; });
}

/// The last group: what the scene shows, then what plots and limits need and nobody records.
void RunRecorder::AddScene(Groups& groups) {
  scene_group_ = static_cast<int>(groups.size());
  SampleQueue::Group group{scene_.sources(), CapacityFor(duration_, loaded_.scene_period)};
  SignalGroup extra{loaded_.scene_period, {}};
  const auto add = [&](const OutputHandle& output) {
    if (HasChannelOf(output)) return;
    extra.channels.push_back(AddChannel(ChannelOf(FormatOf(output))));
    group.outputs.push_back(output);
  };
  for (const PlotHint& hint : PlotHintsOf(loaded_)) {
    for (const OutputHandle& output : hint.outputs) add(output);
  }
  for (const LimitHint& hint : LimitHintsOf(loaded_)) add(hint.output);
  signals_.push_back(std::move(extra));
  groups.push_back(std::move(group));
}

void RunRecorder::BeginSinks(std::vector<Attachment> files, bool tells_warnings) {
  for (RecordSink* const sink : sinks_) {
    for (Attachment& file : files) {
      file.log_time = options_.start_epoch;
      sink->AddAttachment(file);
    }
    sink->AddMetadata(MainMetadata("running", nullptr));
    sink->AddMetadata({"oca.parameters", ParameterTexts(loaded_)});
    sink->AddMetadata(
        {"oca.overrides", OverrideTexts(options_.overrides.value_or(loaded_.overrides))});
    const std::string plots = PlotHintsJson(loaded_, PlotHintsOf(loaded_));
    const std::string limits = LimitHintsJson(loaded_, LimitHintsOf(loaded_));
    sink->AddMetadata({"oca.plots", {{"plots", plots}, {"limits", limits}}});
    sink->AddMetadata({"oca.warnings", WarningTexts(warnings_)});
    sink->Begin(channels_);
  }
  if (tells_warnings) {
    for (const std::string& warning : warnings_) {
      EmitText(log_channel_, 0.0, LogMessage(TimeOf(0.0), kWarning, warning));
    }
  }
  scene_.DrawRobots(options_.start_epoch,
                    [this](int channel, const std::string& text) { EmitText(channel, 0.0, text); });
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

void RunRecorder::StoreText(int level, double time, std::string_view text) {
  if (!queue_->HasRoomForText()) WaitFor([this] { return queue_->HasRoomForText(); });
  queue_->StoreText(level, time, text);
}

void RunRecorder::AddText(LogLevel level, double time, std::string_view text) {
  StoreText(static_cast<int>(level) + 1, time, text);
}

void RunRecorder::SetWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    if (std::find(warnings_.begin(), warnings_.end(), warning) != warnings_.end()) continue;
    StoreText(kWarning, simulator_.context().time(), warning);
  }
  warnings_ = warnings;
}

/// Runs on the recorder's thread until the run is over and the queue empty.
void RunRecorder::Work() {
  try {
    while (true) {
      const bool last = done_.load(std::memory_order_acquire);
      int count = 0;
      while (queue_->Take([this](const SampleQueue::Sample& sample) { HandOn(sample); })) {
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

void RunRecorder::HandOn(const SampleQueue::Sample& sample) {
  const std::uint64_t time = TimeOf(sample.time);
  if (sample.group < 0) {
    EmitText(log_channel_, sample.time, LogMessage(time, sample.level, sample.text));
    return;
  }
  std::size_t at = 0;
  if (sample.group == scene_group_) {
    scene_.Draw(time, sample.values, [&](int channel, const std::string& text) {
      EmitText(channel, sample.time, text);
    });
    at = scene_.sources().size();
  }
  for (const int channel : signals_[static_cast<std::size_t>(sample.group)].channels) {
    const SignalFormat& format = *channels_[static_cast<std::size_t>(channel)].signal;
    Emit(channel, RecordSample(format, sample.values[at++], time, text_));
  }
}

void RunRecorder::Emit(int channel, const RecordSample& sample) {
  for (RecordSink* const sink : sinks_) sink->Write(channel, sample);
}

void RunRecorder::EmitText(int channel, double time, std::string_view message) {
  Emit(channel, RecordSample(message, TimeOf(time)));
}

Metadata RunRecorder::MainMetadata(const std::string& outcome,
                                   const runs::RunResult* result) const {
  Texts values{{"version", Version()},
               {"diagram", loaded_.name},
               {"description", loaded_.description},
               {"seed", std::to_string(loaded_.simulator.seed)},
               {"start_epoch_ns", std::to_string(options_.start_epoch)},
               {"dropped_messages", std::to_string(dropped())},
               {"not_seen", NotSeenJson(loaded_)},
               {"position_unit", runs::PositionUnit(loaded_)},
               {"outcome", outcome}};
  if (result != nullptr) {
    values["duration"] = fmt::format("{}", result->duration);
    values["expectations"] = runs::ExpectationsJson(*result);
  }
  return {"oca", values};
}

void RunRecorder::Finish(const runs::RunResult* result) {
  try {
    SampleScene(simulator_.context());
  } catch (const SimulationError&) {
    // What failed the run fails here again.
  }
  if (result != nullptr && result->failure) {
    WaitFor([this] { return queue_->HasRoomForText(); });
    queue_->StoreText(kError, result->duration, result->failure->message);
  }
  done_.store(true, std::memory_order_release);
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  const double end = simulator_.context().time();
  scene_.Finish(TimeOf(end),
                [&](int channel, const std::string& text) { EmitText(channel, end, text); });
  if (result == nullptr) return;
  if (result->metrics) {
    const SignalFormat& format = *channels_[static_cast<std::size_t>(metrics_channel_)].signal;
    Emit(metrics_channel_, RecordSample(format, &*result->metrics, TimeOf(end), text_));
  } else {
    EmitText(metrics_channel_, end, runs::MetricsJson({}));
  }
  const std::string outcome = result->failure       ? "failed: " + result->failure->message
                              : result->interrupted ? "interrupted"
                                                    : "done";
  for (RecordSink* const sink : sinks_) {
    sink->AddMetadata(MainMetadata(outcome, result));
    sink->AddMetadata({"oca.warnings", WarningTexts(warnings_)});
    sink->End();
  }
}

}  // namespace oca::record
