// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/dynamic_port.h"

#include <fmt/format.h>

#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/dataflow/port_name.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/dataflow/system.h"

namespace oca {

const SignalType& TypeOfPort(const OutputHandle& output) {
  if (output.system == nullptr) throw WiringError(internal::ForeignText(output, "a system"));
  return *output.system->outputs().at(output.index).type;
}

const SignalType& TypeOfPort(const InputHandle& input) {
  if (input.system == nullptr) throw WiringError(internal::ForeignText(input, "a system"));
  return *input.system->inputs().at(input.index).type;
}

namespace internal {
namespace {

/// A port was asked for as what it is not.
[[noreturn]] void ThrowAskedFor(const std::string& port, const char* as, const SignalType& is) {
  throw WiringError(fmt::format("{} was asked for as {}; it is {}", port, as, is.name));
}

template <class Info>
void CheckTypeOf(const char* kind, const Handle& port, const std::vector<Info>* infos,
                 const SignalType& type, const std::string& path) {
  if (infos == nullptr || port.index < 0 || port.index >= static_cast<int>(infos->size())) {
    throw WiringError(fmt::format(
        "{}: got {}; expected a {}", path.empty() ? kind : fmt::format("{} '{}'", kind, path),
        port.system == nullptr ? "a handle that was made by default"
                               : fmt::format("number {}, which its system has not", port.index),
        type.name));
  }
  const Info& info = (*infos)[static_cast<std::size_t>(port.index)];
  if (info.type == &type) return;
  ThrowAskedFor(fmt::format("{} '{}'", kind, path.empty() ? info.name : path), type.name,
                *info.type);
}

/// The value of an output that is a Vector, or that is none.
Storage FindOf(const OutputHandle& output, const Context& context, bool vector) {
  const Schedule& schedule = Schedule::Of(output, context);
  const SignalType& type = TypeOfPort(output);
  if ((&type == &kVectorType) != vector) {
    ThrowAskedFor(fmt::format("output '{}.{}'", schedule.PathOf(*output.system),
                              output.system->outputs()[output.index].name),
                  vector ? "Vector" : "what is no Vector", type);
  }
  return Find(output, context);
}

}  // namespace

void CheckType(const OutputHandle& output, const SignalType& type, const std::string& path) {
  const bool none = output.system == nullptr;
  CheckTypeOf("output", output, none ? nullptr : &output.system->outputs(), type, path);
}

void CheckType(const InputHandle& input, const SignalType& type, const std::string& path) {
  const bool none = input.system == nullptr;
  CheckTypeOf("input", input, none ? nullptr : &input.system->inputs(), type, path);
}

}  // namespace internal

void EvalJson(const OutputHandle& output, const Context& context, std::string& out) {
  const internal::Storage at = internal::Find(output, context);
  const SignalType& type = TypeOfPort(output);
  const std::byte* const value = at.arena + at.slot.offset;
  if (&type == &kVectorType) {
    WriteVectorJson(reinterpret_cast<const double*>(value), at.slot.size, out);
  } else {
    type.write_json(value, out);
  }
}

std::span<const double> EvalVector(const OutputHandle& output, const Context& context) {
  const internal::Storage at = internal::FindOf(output, context, true);
  return {reinterpret_cast<const double*>(at.arena + at.slot.offset), at.slot.size};
}

const void* EvalObject(const OutputHandle& output, const Context& context) {
  const internal::Storage at = internal::FindOf(output, context, false);
  return at.arena + at.slot.offset;
}

void FixJson(const InputHandle& input, Context& context, std::string_view json) {
  const internal::Storage at = internal::FindExported(input, context);
  const SignalType& type = TypeOfPort(input);
  if (&type == &kVectorType) {
    internal::Assign<Vector>(at, ReadVectorJson(json));
  } else {
    type.read_json(json, at.arena + at.slot.offset);
  }
  internal::MarkChanged(input, context);
}

bool ShowsState(const OutputHandle& output) {
  if (output.system == nullptr) throw WiringError(internal::ForeignText(output, "a system"));
  return output.system->outputs().at(output.index).state >= 0;
}

}  // namespace oca
