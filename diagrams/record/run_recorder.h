// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "oca/diagrams/record/record_sink.h"
#include "oca/diagrams/record/recorder_options.h"
#include "oca/diagrams/record/sample_queue.h"
#include "oca/diagrams/record/scene.h"
#include "oca/diagrams/runs/run_output.h"
#include "oca/diagrams/runs/signal_facts.h"
#include "oca/framework/dataflow/log.h"

namespace oca::record {

/// Records a run of one diagram into sinks: the scene, the signals of section `record` at their
/// rates, those that plots of the run need, the log and the metrics.
///
/// The thread of the run only copies values (SampleQueue); another one hands them to the sinks. A
/// run that is paced by the wall clock never waits: what does not fit is dropped and counted.
/// Any other run waits for room. Recording does not change a run: the scene is sampled after
/// steps that happen anyway, and the rates of `record` are events of every run.
class RunRecorder {
 public:
  /// Attaches itself to the simulator, begins the sinks and the thread. Everything must outlive the
  /// run. `told`: what a recorder before this one told the run to be warned of; without one this
  /// one tells.
  /// `files` are attached.
  RunRecorder(const runs::RunStart& run, const RecorderOptions& options,
              std::vector<Attachment> files, std::vector<RecordSink*> sinks,
              std::optional<std::vector<std::string>> told);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// After the last step: hands on what is left and ends the sinks; without a result the run goes
  /// on with another recorder, and the sinks do not end.
  /// throws ConfigError if writing failed on the recorder's thread.
  void Finish(const runs::RunResult* result);

  /// A line of the log. On the run's thread, as the next one.
  void AddText(LogLevel level, double time, std::string_view text);
  /// What the diagram is warned of from now on: what is new into the log.
  void SetWarnings(const std::vector<std::string>& warnings);
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Samples that found no room.
  std::int64_t dropped() const { return queue_->dropped(); }

 private:
  /// Channels that are sampled together.
  struct SignalGroup {
    Period period;
    std::vector<int> channels;
  };
  using Groups = std::vector<SampleQueue::Group>;

  void AddSignals(Groups& groups);
  void AddLimits(Groups& groups);
  void AddScene(Groups& groups);
  bool HasChannelOf(const OutputHandle& output) const;
  SignalFormat FormatOf(const OutputHandle& output) const;
  int AddChannel(RecordChannel channel);
  void Store(int group, const Context& context);
  void StoreText(int level, double time, std::string_view text);
  void WaitFor(const std::function<bool()>& room);
  void SampleScene(const Context& context);
  void BeginSinks(std::vector<Attachment> files, bool tells_warnings);
  void Work();
  void HandOn(const SampleQueue::Sample& sample);
  void Emit(int channel, const RecordSample& sample);
  void EmitText(int channel, double time, std::string_view message);
  std::uint64_t TimeOf(double time) const;
  Metadata MainMetadata(const std::string& outcome, const runs::RunResult* result) const;

  const loading::LoadedDiagram& loaded_;
  const RecorderOptions options_;
  std::vector<std::string> warnings_;
  std::vector<RecordSink*> sinks_;
  Simulator& simulator_;
  const bool paced_;
  const double duration_;  ///< s
  runs::SignalFacts facts_;
  Scene scene_;
  std::unique_ptr<SampleQueue> queue_;
  std::vector<RecordChannel> channels_;
  std::vector<SignalGroup> signals_;
  int log_channel_{0}, metrics_channel_{0}, scene_group_{0};
  std::int64_t scene_count_{0};  ///< of the next sample of the scene
  double scene_time_{-1.0};      ///< s; of the last
  std::string text_;
  std::atomic<bool> done_{false};
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace oca::record
