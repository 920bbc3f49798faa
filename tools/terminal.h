// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

namespace oca::tools {

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

}  // namespace oca::tools
