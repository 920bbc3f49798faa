// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/port_name.h"

#include <fmt/format.h>

#include <iterator>

#include "oca/framework/dataflow/system.h"

namespace oca::internal {
namespace {

template <class Info>
std::string NameIn(const std::vector<Info>& infos, const char* kind, int index) {
  if (index < 0 || index >= std::ssize(infos)) return fmt::format("{} {}", kind, index);
  return fmt::format("{} '{}'", kind, infos[static_cast<std::size_t>(index)].name);
}

constexpr const char* kEmptyHandle = "an empty handle";

}  // namespace

std::string NameOf(const InputHandle& input) {
  return input.system == nullptr ? kEmptyHandle
                                 : NameIn(input.system->inputs(), "input", input.index);
}

std::string NameOf(const OutputHandle& output) {
  return output.system == nullptr ? kEmptyHandle
                                  : NameIn(output.system->outputs(), "output", output.index);
}

std::string NameOf(const CachedHandle& cached) {
  return cached.system == nullptr ? kEmptyHandle : fmt::format("cached value {}", cached.index);
}

std::string NameOf(const StateHandle& state) {
  return state.system == nullptr ? kEmptyHandle
                                 : NameIn(state.system->states(), "state", state.index);
}

}  // namespace oca::internal
