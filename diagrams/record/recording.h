// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "oca/diagrams/record/attachment.h"
#include "oca/diagrams/record/record_sink.h"
#include "oca/diagrams/record/recorder_options.h"
#include "oca/diagrams/runs/run_output.h"

namespace oca::record {

class RunRecorder;

/// A run into sinks: whatever the diagram that it goes on with, it is one recording.
class Recording : public runs::RunOutput, private Log {
 public:
  /// The sinks must outlive the run.
  explicit Recording(std::vector<RecordSink*> sinks, RecorderOptions options = {});
  ~Recording() override;

  /// Reads what is attached. throws ConfigError if a file cannot be read any more.
  void Prepare(const runs::RunStart& run) override;
  void Begin(const runs::RunStart& run) override;
  void Pause() override;
  void SetWarnings(const std::vector<std::string>& warnings) override;
  void End(const runs::RunResult& result) override;
  Log* log() override { return this; }

  /// Samples that found no room in the last run.
  std::int64_t dropped() const;

 protected:
  explicit Recording(RecorderOptions options);
  void SetSink(RecordSink& sink) { sinks_ = {&sink}; }
  /// Ends the thread that writes, if it still does: before what it writes to goes.
  void Stop();

 private:
  bool enabled(LogLevel level) const override { return level != LogLevel::kDebug; }
  void Write(LogLevel level, double time, std::string_view text) override;

  const RecorderOptions options_;
  std::vector<RecordSink*> sinks_;
  std::vector<Attachment> files_;  ///< of a run that is prepared
  std::unique_ptr<RunRecorder> recorder_;
  std::uint64_t start_epoch_{0};  ///< of the present run
  std::int64_t dropped_{0};       ///< by the recorders before this one
};

}  // namespace oca::record
