// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/function.h"

#include <fmt/format.h>

#include <exception>
#include <map>

#include "oca/framework/dataflow/error.h"

namespace oca {

namespace internal {

void CheckLength(Eigen::Index got, Eigen::Index expected) {
  if (got != expected) {
    throw ConfigError(fmt::format("length; got {}; expected {}", got, expected));
  }
}

}  // namespace internal

Function::Function(const FunctionPorts& ports, const std::vector<Argument>& arguments,
                   const SignalType& output, Compute compute, const std::optional<Memory>& memory)
    : compute_(std::move(compute)) {
  std::map<std::string, Size> sizes;
  const auto spec_of = [&](const FunctionPort& port) -> PortSpec {
    if (port.length.number() >= 0) return {port.length.number(), port.unit};
    const auto [size, fresh] = sizes.try_emplace(port.length.name(), 0);
    if (fresh) size->second = DeclareSize();
    return {size->second, port.unit};
  };
  Calculation calculation{&Function::Call, {}};
  std::size_t taken = 0;
  for (const Argument& argument : arguments) {
    if (argument.type == nullptr) {
      calculation.reads.push_back({Read::Kind::kOfTime});
      continue;
    }
    if (taken < ports.inputs.size()) {
      const FunctionPort& port = ports.inputs[taken];
      const InputHandle input =
          AddInput({port.name, argument.type, spec_of(port), argument.optional});
      calculation.reads.push_back({Read::Kind::kInput, input.index, this});
    }
    ++taken;
  }
  if (taken != ports.inputs.size()) {
    throw WiringError(
        fmt::format("block of '{}': inputs; got {} ports; expected {}, as many as "
                    "its callable takes",
                    ports.output.name, ports.inputs.size(), taken));
  }
  const std::string& name = ports.output.name;
  if (!memory) {
    AddOutput({name, &output, spec_of(ports.output), std::move(calculation)});
    return;
  }
  if (!memory->period.positive()) {
    throw ConfigError(fmt::format("block of '{}': period; got {}; expected > 0 s", name,
                                  memory->period.ToString()));
  }
  const StateHandle state =
      AddState({name, &output, spec_of(ports.output), false, memory->initial});
  AddEvent({Stage::kUpdate, {memory->period}, std::move(calculation), {state.index}});
  AddStateOutput(name, state);
}

void Function::Call(const System& system, std::byte* arena, const Slot* slots) {
  try {
    static_cast<const Function&>(system).compute_(arena, slots);
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    throw Error("threw something that is no std::exception");
  }
}

}  // namespace oca
