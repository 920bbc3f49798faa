// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <string_view>
#include <utility>

namespace oca::tools {

/// To be called first. Standard streams that are closed get a descriptor that cannot be used, lest
/// a file of ours takes its number and gets our messages; a closed pipe, or a file at its limit,
/// is an error of the write, not the end of the program.
void PrepareTerminal();

/// Write to standard error and to standard output. None fails, so that a run goes on and its record
/// is complete when nobody reads: what cannot be written is lost. Names of others are in the text,
/// so nothing of it is obeyed by a terminal but the colours of Good, Bad and Dim; lines of errors
/// that have more than 2000 characters are cut in their middle.
void WriteError(std::string_view text);
void WriteOutput(std::string_view text);
/// What another program reads, or a file takes: as it is, unless standard output is a terminal.
void WriteData(std::string_view text);
/// At the end: whether all that was written to standard output, in any way, has got there. Says so
/// on standard error if not, unless the reader has gone.
bool FlushOutput();

/// The first two with formatting.
template <class... Values>
void Tell(fmt::format_string<Values...> format, Values&&... values) {
  WriteError(fmt::format(format, std::forward<Values>(values)...));
}
template <class... Values>
void Print(fmt::format_string<Values...> format, Values&&... values) {
  WriteOutput(fmt::format(format, std::forward<Values>(values)...));
}

/// Whether the stream behind a file descriptor is a terminal that moves the cursor.
bool IsTerminal(int descriptor);
/// Whether colour is welcome there: a terminal, and NO_COLOR is not set.
bool WantsColour(int descriptor);

/// Text in bold green, bold red or dim if `colour`, else as it is.
std::string Good(const std::string& text, bool colour);
std::string Bad(const std::string& text, bool colour);
std::string Dim(const std::string& text, bool colour);

/// A bar on standard error that redraws itself a few times a second and leaves no trace.
class ProgressBar {
 public:
  explicit ProgressBar(double end) : end_(end), start_(Clock::now()) {}
  ~ProgressBar();
  void Show(double time);

 private:
  using Clock = std::chrono::steady_clock;
  double end_;
  Clock::time_point start_;
  Clock::time_point shown_{};
  bool visible_{false};
  int skipped_{0};
};

/// How far tasks are that take their time, on standard error: on a terminal a line that redraws
/// itself and leaves no trace, else a line now and then.
class TaskProgress {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Says nothing of a task in its first `patience`; not to a terminal once every `interval`.
  explicit TaskProgress(Seconds patience = Seconds(1.0), Seconds interval = Seconds(10.0))
      : patience_(patience), interval_(interval) {}
  ~TaskProgress() { Clear(); }
  TaskProgress(const TaskProgress&) = delete;
  TaskProgress& operator=(const TaskProgress&) = delete;

  /// `share` of the task from 0 to 1, with which it ends.
  void Show(const std::string& task, double share);

 private:
  using Clock = std::chrono::steady_clock;
  void Clear();

  const Seconds patience_, interval_;
  std::string task_;
  Clock::time_point start_, shown_;
  bool visible_{false};
};

}  // namespace oca::tools
