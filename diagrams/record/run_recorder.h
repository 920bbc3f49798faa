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
#include "oca/diagrams/record/sample_queue.h"
#include "oca/diagrams/record/scene.h"
#include "oca/diagrams/record/signal_json.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/log.h"

namespace oca::record {

struct RecorderOptions {
  std::string version{};                     ///< of the program
  std::vector<files::Override> overrides{};  ///< as given on the command line
  std::uint64_t start_epoch{0};              ///< ns; 0: the wall clock's
  bool attach_files{true};                   ///< diagram and models, to run the record again
  bool brief{false};  ///< for a picture: of proximities only names and distance
  /// What the recorder before this one told, if it goes on with a record; else it tells what the
  /// diagram is warned of.
  std::optional<std::vector<std::string>> warnings{};
};

/// Records a run into sinks: the scene, the signals of section `record` at their rates, those that
/// plots of the run need, the log and the metrics.
///
/// The thread of the run only copies values (SampleQueue); another one makes messages of them. A
/// run that is paced by the wall clock never waits: what does not fit is dropped and counted.
/// Any other run waits for room. Recording does not change a run: the scene is sampled after
/// steps that happen anyway, and the rates of `record` are events of every run.
class RunRecorder final : public runs::RunObserver, public Log {
 public:
  /// Everything must outlive the run. `log` receives what is logged too; may be nullptr.
  RunRecorder(const loading::LoadedDiagram& loaded, RecorderOptions options,
              std::vector<RecordSink*> sinks, Log* log);
  ~RunRecorder() override;

  void Attach(Simulator& simulator, bool paced, double duration) override;
  /// throws ConfigError if writing failed on the recorder's thread.
  void Finish(const runs::RunResult& result) override;

  bool enabled(LogLevel level) const override;
  void Write(LogLevel level, double time, std::string_view text) override;

  /// What the diagram is warned of from now on: what is new into the log. On the run's thread.
  void SetWarnings(const std::vector<std::string>& warnings);

  /// Samples that found no room.
  std::int64_t dropped() const { return queue_ ? queue_->dropped() : 0; }

 private:
  struct SignalGroup {
    Period period;
    std::vector<SignalFormat> formats;
    std::vector<int> channels;
  };
  using Groups = std::vector<SampleQueue::Group>;

  void AddSignals(double duration, Groups& groups);
  void AddLimits(double duration, Groups& groups);
  void AddScene(double duration, Groups& groups);
  bool HasChannelOf(const OutputHandle& output) const;
  SignalFormat FormatOf(const OutputHandle& output) const;
  int AddChannel(RecordChannel channel);
  void Store(int group, const Context& context);
  void WaitFor(const std::function<bool()>& room);
  void SampleScene(const Context& context);
  void BeginSinks();
  void Work();
  void Encode(const SampleQueue::Sample& sample);
  void Emit(int channel, double time, std::string_view json);
  std::uint64_t TimeOf(double time) const;
  McapMetadata MainMetadata(const std::string& outcome, const runs::RunResult* result) const;

  const loading::LoadedDiagram& loaded_;
  RecorderOptions options_;
  std::vector<std::string> warnings_;
  std::vector<RecordSink*> sinks_;
  Log* log_;
  Simulator* simulator_{nullptr};
  bool paced_{false};
  double duration_{0.0};  ///< s
  std::unique_ptr<runs::SignalFacts> facts_;
  std::unique_ptr<Scene> scene_;
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
