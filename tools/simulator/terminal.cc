// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/terminal.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "oca/models/foreign_text.h"

namespace oca::tools {
namespace {

constexpr std::string_view kGood = "\033[1;32m", kBad = "\033[1;31m", kDim = "\033[2m",
                           kPlain = "\033[0m", kRedraw = "\r\033[K";

std::string Paint(const std::string& text, std::string_view colour, bool wanted) {
  return wanted ? fmt::format("{}{}{}", colour, text, kPlain) : text;
}

void Write(std::string_view text, std::FILE* stream) {
  std::fwrite(text.data(), 1, text.size(), stream);
}

/// Harmless, with our own colours.
std::string Shown(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t escape = std::min(text.find('\033'), text.size());
    shown += models::internal::Harmless(text.substr(0, escape));
    text.remove_prefix(escape);
    std::string_view own = text.substr(0, 1);
    for (const std::string_view colour : {kGood, kBad, kDim, kPlain}) {
      if (text.starts_with(colour)) own = colour;
    }
    shown += own.size() > 1 ? std::string(own) : models::internal::Harmless(own);
    text.remove_prefix(own.size());
  }
  return shown;
}

/// A message's lines, those without end cut in their middle: names of others may have a megabyte.
std::string WithoutTheMiddles(std::string_view text) {
  constexpr std::size_t kMost = 2000, kBegin = 1200, kEnd = 600;
  std::string cut;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    if (line.size() <= kMost) {
      cut += line;
      continue;
    }
    cut += fmt::format("{} [... {} characters ...] {}", line.substr(0, kBegin),
                       line.size() - kBegin - kEnd, line.substr(line.size() - kEnd));
  }
  return cut;
}

/// Draws a line of progress over the one before.
void Redraw(std::string_view line) {
  Write(kRedraw, stderr);
  Write(Shown(line), stderr);
  std::fflush(stderr);
}

}  // namespace

void PrepareTerminal() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The least number that is free, hence this one; opened the wrong way round.
    open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
  for (const int failure_of_a_write : {SIGPIPE, SIGXFSZ}) std::signal(failure_of_a_write, SIG_IGN);
}

void WriteError(std::string_view text) {
  Write(Shown(WithoutTheMiddles(text)), stderr);
  std::fflush(stderr);
}

void WriteOutput(std::string_view text) { Write(Shown(text), stdout); }

void WriteData(std::string_view text) {
  if (isatty(STDOUT_FILENO) != 0) return WriteOutput(text);
  Write(text, stdout);
}

bool FlushOutput() {
  errno = 0;
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  const bool reader_gone = errno == EPIPE;
  if (std::cout && flushed && std::ferror(stdout) == 0) return true;
  if (!reader_gone) WriteError("error: standard output cannot be written\n");
  return false;
}

bool IsTerminal(int descriptor) {
  const char* const term = std::getenv("TERM");
  return isatty(descriptor) != 0 && term != nullptr && std::string_view(term) != "dumb";
}

bool WantsColour(int descriptor) {
  const char* const no_colour = std::getenv("NO_COLOR");
  return IsTerminal(descriptor) && (no_colour == nullptr || *no_colour == '\0');
}

std::string Good(const std::string& text, bool colour) { return Paint(text, kGood, colour); }
std::string Bad(const std::string& text, bool colour) { return Paint(text, kBad, colour); }
std::string Dim(const std::string& text, bool colour) { return Paint(text, kDim, colour); }

ProgressBar::~ProgressBar() {
  if (visible_) Redraw("");
}

void ProgressBar::Show(double time) {
  // Asking the clock costs more than a tick.
  if (++skipped_ < 64) return;
  skipped_ = 0;
  const auto now = Clock::now();
  if (now - start_ < std::chrono::milliseconds(300) ||
      now - shown_ < std::chrono::milliseconds(100)) {
    return;
  }
  shown_ = now;
  visible_ = true;
  constexpr int kWidth = 30;
  const double share = end_ > 0.0 ? std::clamp(time / end_, 0.0, 1.0) : 1.0;
  const int filled = static_cast<int>(share * kWidth);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  Redraw(fmt::format("[{:#<{}}{:.<{}}] {:.1f} of {:g} s, {:.0f} times real time", "", filled, "",
                     kWidth - filled, time, end_, time / seconds));
}

void TaskProgress::Show(const std::string& task, double share) {
  const auto now = Clock::now();
  if (task != task_) {
    task_ = task;
    start_ = now;
    shown_ = now - std::chrono::duration_cast<Clock::duration>(interval_);
  }
  if (share >= 1.0) {
    Clear();
    task_.clear();
    return;
  }
  const bool terminal = IsTerminal(STDERR_FILENO);
  if (now - start_ < patience_ || now - shown_ < (terminal ? Seconds(0.1) : interval_)) return;
  shown_ = now;
  visible_ = terminal;
  const std::string line = fmt::format("{}: {:.0f} % after {:.0f} s", task, 100.0 * share,
                                       Seconds(now - start_).count());
  terminal ? Redraw(line) : WriteError(line + '\n');
}

void TaskProgress::Clear() {
  if (visible_) Redraw("");
  visible_ = false;
}

}  // namespace oca::tools
