// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/recording.h"

#include <chrono>
#include <optional>
#include <utility>

#include "oca/diagrams/record/record_files.h"
#include "oca/diagrams/record/run_recorder.h"

namespace oca::record {
namespace {

std::uint64_t WallClock() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

}  // namespace

Recording::Recording(std::vector<RecordSink*> sinks, RecorderOptions options)
    : options_(std::move(options)), sinks_(std::move(sinks)) {}

Recording::Recording(RecorderOptions options) : Recording({}, std::move(options)) {}

Recording::~Recording() = default;

std::int64_t Recording::dropped() const {
  return dropped_ + (recorder_ ? recorder_->dropped() : 0);
}

void Recording::Stop() { recorder_.reset(); }

void Recording::Prepare(const runs::RunStart& run) {
  if (options_.attach_files) files_ = FilesOf(run.loaded, run.duration);
}

void Recording::Begin(const runs::RunStart& run) {
  std::optional<std::vector<std::string>> told;
  RecorderOptions options = options_;
  if (run.continued && recorder_) {
    told = recorder_->warnings();
    dropped_ += recorder_->dropped();
  } else {
    dropped_ = 0;
    start_epoch_ = options_.start_epoch == 0 ? WallClock() : options_.start_epoch;
  }
  options.start_epoch = start_epoch_;
  recorder_.reset();
  recorder_ = std::make_unique<RunRecorder>(run, options, std::exchange(files_, {}), sinks_,
                                            std::move(told));
}

void Recording::Pause() {
  if (recorder_) recorder_->Finish(nullptr);
}

void Recording::SetWarnings(const std::vector<std::string>& warnings) {
  if (recorder_) recorder_->SetWarnings(warnings);
}

void Recording::End(const runs::RunResult& result) {
  if (recorder_) recorder_->Finish(&result);
}

void Recording::Write(LogLevel level, double time, std::string_view text) {
  if (recorder_) recorder_->AddText(level, time, text);
}

}  // namespace oca::record
