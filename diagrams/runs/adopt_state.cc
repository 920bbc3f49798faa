// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/adopt_state.h"

#include <fmt/format.h>

#include <cstring>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/schedule.h"

namespace oca::runs {
namespace {

bool Alike(const Schedule::StateEntry& a, const Schedule::StateEntry& b) {
  return a.type == b.type && a.continuous == b.continuous && a.slot.size == b.slot.size &&
         a.info->name == b.info->name;
}

void CheckAlike(const Schedule& previous, const Schedule& next) {
  bool alike = previous.paths == next.paths && previous.states.size() == next.states.size();
  for (std::size_t i = 0; alike && i < next.states.size(); ++i) {
    alike = Alike(previous.states[i], next.states[i]);
  }
  if (alike) return;
  throw ConfigError(
      "change of a run; got other systems or states than before; expected the same, so "
      "that the run can go on");
}

}  // namespace

void AdoptStates(const Diagram& previous, const Context& from, const Diagram& next, Context& to) {
  const Schedule& old_schedule = previous.schedule();
  const Schedule& schedule = next.schedule();
  CheckAlike(old_schedule, schedule);
  for (std::size_t i = 0; i < schedule.states.size(); ++i) {
    const Schedule::StateEntry& entry = schedule.states[i];
    std::byte* const at = schedule.arena(to) + entry.slot.offset;
    const std::byte* const old = old_schedule.arena(from) + old_schedule.states[i].slot.offset;
    if (entry.type == &kVectorType) {
      std::memcpy(at, old, entry.slot.size * sizeof(double));
    } else {
      entry.type->assign(at, old);
    }
    schedule.MarkChanged(to, entry.source);
  }
}

}  // namespace oca::runs
