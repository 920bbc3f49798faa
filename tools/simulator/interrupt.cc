// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "oca/models/whole_file.h"
#include "oca/tools/simulator/simulator_main.h"

namespace oca::tools {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void EndAtOnce(int /*signal*/) {
  models::RemoveUnfinished();
  _exit(kInterrupted);
}

void Remember(int signal) {
  interrupted.store(true, std::memory_order_relaxed);
  std::signal(signal, EndAtOnce);
}

void OnInterrupts(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

}  // namespace

void EndOnInterrupts() { OnInterrupts(EndAtOnce); }

void CatchInterrupts() { OnInterrupts(Remember); }

bool Interrupted() { return interrupted.load(std::memory_order_relaxed); }

}  // namespace oca::tools
