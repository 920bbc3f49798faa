// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/interrupt.h"

#include <atomic>
#include <csignal>

namespace oca::tools {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void Interrupt(int signal) {
  interrupted.store(true, std::memory_order_relaxed);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void CatchInterrupts() {
  std::signal(SIGINT, Interrupt);
  std::signal(SIGTERM, Interrupt);
}

bool Interrupted() { return interrupted.load(std::memory_order_relaxed); }

}  // namespace oca::tools
