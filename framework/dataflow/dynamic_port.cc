// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/dynamic_port.h"

#include <fmt/format.h>

#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/dataflow/system.h"

namespace oca {

const SignalType& TypeOfPort(const OutputHandle& output) {
  return *output.system->outputs().at(output.index).type;
}

const SignalType& TypeOfPort(const InputHandle& input) {
  return *input.system->inputs().at(input.index).type;
}

namespace internal {
namespace {

template <class Info>
void CheckTypeOf(const char* kind, const Handle& port, const std::vector<Info>* infos,
                 const SignalType& type, const std::string& path) {
  if (infos == nullptr || port.index < 0 || port.index >= static_cast<int>(infos->size())) {
    throw WiringError(fmt::format("{}: got none of any system; expected a {}", kind, type.name));
  }
  const Info& info = (*infos)[static_cast<std::size_t>(port.index)];
  if (info.type == &type) return;
  throw WiringError(fmt::format("{} '{}': type; got {}; expected {}", kind,
                                path.empty() ? info.name : path, type.name, info.type->name));
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
  if (&TypeOfPort(output) != &kVectorType) {
    throw WiringError(fmt::format("output '{}': type; got {}; expected Vector",
                                  output.system->outputs()[output.index].name,
                                  TypeOfPort(output).name));
  }
  const internal::Storage at = internal::Find(output, context);
  return {reinterpret_cast<const double*>(at.arena + at.slot.offset), at.slot.size};
}

const void* EvalObject(const OutputHandle& output, const Context& context) {
  if (&TypeOfPort(output) == &kVectorType) {
    throw WiringError(fmt::format("output '{}': type; got Vector; expected another one",
                                  output.system->outputs()[output.index].name));
  }
  const internal::Storage at = internal::Find(output, context);
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
  return output.system->outputs().at(output.index).state >= 0;
}

}  // namespace oca
