// SPDX-License-Identifier: BSD-3-Clause
#include "framework/dynamic_port.h"

#include <fmt/format.h>

#include "framework/error.h"
#include "framework/plan.h"
#include "framework/port_access.h"
#include "framework/system.h"

namespace oca {

const SignalType& TypeOfPort(const OutputHandle& output) {
  return *output.system->outputs().at(output.index).type;
}

const SignalType& TypeOfPort(const InputHandle& input) {
  return *input.system->inputs().at(input.index).type;
}

void EvalJson(const OutputHandle& output, const Context& context, std::string& out) {
  const internal::Location at = internal::Find(output, context);
  const SignalType& type = TypeOfPort(output);
  const std::byte* const value = at.arena + at.slot.offset;
  if (&type == &kVectorType) {
    WriteVectorJson(reinterpret_cast<const double*>(value), at.slot.size, out);
  } else {
    type.write_json(value, out);
  }
}

std::span<const double> EvalVector(const OutputHandle& output, const Context& context) {
  if (&TypeOfPort(output) != &kVectorType) {
    throw WiringError(
        {fmt::format("output '{}': type; got {}; expected Vector",
                     output.system->outputs()[output.index].name, TypeOfPort(output).name)});
  }
  const internal::Location at = internal::Find(output, context);
  return {reinterpret_cast<const double*>(at.arena + at.slot.offset), at.slot.size};
}

const void* EvalObject(const OutputHandle& output, const Context& context) {
  if (&TypeOfPort(output) == &kVectorType) {
    throw WiringError({fmt::format("output '{}': type; got Vector; expected another one",
                                   output.system->outputs()[output.index].name)});
  }
  const internal::Location at = internal::Find(output, context);
  return at.arena + at.slot.offset;
}

int VectorSize(const OutputHandle& output, const Context& context) {
  return static_cast<int>(Plan::Of(output, context).output(output).slot.size);
}

void FixJson(const InputHandle& input, Context& context, std::string_view json) {
  const internal::Location at = internal::FindExported(input, context);
  const SignalType& type = TypeOfPort(input);
  if (&type == &kVectorType) {
    internal::Assign<Vector>(at, ReadVectorJson(json));
  } else {
    type.read_json(json, at.arena + at.slot.offset);
  }
  internal::MarkChanged(input, context);
}

bool ShowsState(const OutputHandle& output) {
  return output.system->outputs().at(output.index).state >= 0;
}

}  // namespace oca
