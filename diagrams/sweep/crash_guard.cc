// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/crash_guard.h"

#include <unistd.h>

#include <csignal>
#include <mutex>

namespace oca::sweep {
namespace {

struct LastWords {
  int descriptor{-1};
  const char* text{nullptr};
  std::size_t size{0};
};
thread_local LastWords last_words;

// Nothing but what a signal handler may call.
void WriteLastWords(int signal) {
  const LastWords words = last_words;
  if (words.text != nullptr) {
    [[maybe_unused]] const ssize_t written = ::write(words.descriptor, words.text, words.size);
  }
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

}  // namespace

CrashGuard::CrashGuard(int descriptor, std::string line) : line_(std::move(line)) {
  static std::once_flag once;
  std::call_once(once, [] {
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
      std::signal(signal, WriteLastWords);
    }
  });
  last_words = {descriptor, line_.data(), line_.size()};
}

CrashGuard::~CrashGuard() { last_words = {}; }

}  // namespace oca::sweep
