// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "oca/framework/dataflow/port.h"

namespace oca {

// Ports whose types are known only at run time: for files, recorders and `eval`.

/// The type of a port.
const SignalType& TypeOfPort(const OutputHandle& output);
const SignalType& TypeOfPort(const InputHandle& input);

namespace internal {
/// throw WiringError unless the port has that type; it is named by `path`, or its own name.
void CheckType(const OutputHandle& output, const SignalType& type, const std::string& path);
void CheckType(const InputHandle& input, const SignalType& type, const std::string& path);
}  // namespace internal

template <class T>
Input<T> Typed(const InputHandle& input, const std::string& path) {
  internal::CheckType(input, TypeOf<T>(), path);
  return Input<T>(input);
}
template <class T>
Output<T> Typed(const OutputHandle& output, const std::string& path) {
  internal::CheckType(output, TypeOf<T>(), path);
  return Output<T>(output);
}

/// The output as JSON, appended to `out`. throws SimulationError as Output::Eval does.
void EvalJson(const OutputHandle& output, const Context& context, std::string& out);

/// A Vector output's numbers, valid until the context changes.
/// throws WiringError if the port is no Vector.
std::span<const double> EvalVector(const OutputHandle& output, const Context& context);

/// A value that is no Vector, as its TypeOfPort knows it, valid until the context changes.
/// throws WiringError if the port is a Vector.
const void* EvalObject(const OutputHandle& output, const Context& context);

/// Fixes an exported input from JSON. throws ConfigError if the text is not of the port's type.
void FixJson(const InputHandle& input, Context& context, std::string_view json);

/// True if the output shows a state, so that it changes only when an update or the integrator
/// changes that state.
bool ShowsState(const OutputHandle& output);

}  // namespace oca
