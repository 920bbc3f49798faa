// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The templates behind port.h's handles. They come with context.h: whoever has a Context can read
// and write ports; a block, which has none, does not pay for them.

#include <span>

#include "oca/framework/dataflow/port.h"

namespace oca {
namespace internal {

/// Where the value of a port or a state lies in a context.
struct Storage {
  std::byte* arena;
  Slot slot;
  std::span<const Plausible* const> plausible;  ///< of an exported input
};

Storage Find(const OutputHandle& output, const Context& context);
Storage Find(const CachedHandle& cached, const Context& context);
Storage Find(const StateHandle& state, const Context& context);
Storage FindExported(const InputHandle& input, const Context& context);
void MarkChanged(const InputHandle& input, Context& context);
void MarkChanged(const StateHandle& state, Context& context);
/// What is wrong with a vector: its length, its numbers.
Fault CheckVector(const double* values, Eigen::Index size, const Storage& at);
/// throws ConfigError `type: what` if anything is wrong.
void RequireValid(const char* type, const Fault& fault);

/// Keeps a value from outside that is good.
template <class T>
void Store(const Storage& at, const T& value) {
  T& kept = ViewOf<T>::Write(at.arena, at.slot);
  kept = value;
  if constexpr (requires { Signal<T>::FromOutside(kept); }) Signal<T>::FromOutside(kept);
}

template <class T, class Value>
void Assign(Storage at, const Value& value) {
  if constexpr (std::is_same_v<T, Vector>) {
    const Eigen::Ref<const Eigen::VectorXd> vector(value);
    RequireValid("vector", CheckVector(vector.data(), vector.size(), at));
    ViewOf<Vector>::Write(at.arena, at.slot) = vector;
  } else {
    const T& object = value;
    RequireValid(Signal<T>::kName, Signal<T>::Check(object, Look::kWhole));
    Store(at, object);
  }
}

}  // namespace internal

template <class T>
template <class Value>
void Input<T>::Fix(Context& context, const Value& value) const {
  internal::Assign<T>(internal::FindExported(*this, context), value);
  internal::MarkChanged(*this, context);
}

template <class T>
typename ViewOf<T>::Const Output<T>::Eval(const Context& context) const {
  const internal::Storage at = internal::Find(*this, context);
  return ViewOf<T>::Read(at.arena, at.slot);
}

template <class T>
const T& Cached<T>::Eval(const Context& context) const {
  const internal::Storage at = internal::Find(*this, context);
  return ViewOf<T>::Read(at.arena, at.slot);
}

template <class T>
typename ViewOf<T>::Const DiscreteState<T>::Get(const Context& context) const {
  const internal::Storage at = internal::Find(*this, context);
  return ViewOf<T>::Read(at.arena, at.slot);
}

template <class T>
template <class Value>
void DiscreteState<T>::Set(Context& context, const Value& value) const {
  internal::Assign<T>(internal::Find(*this, context), value);
  internal::MarkChanged(*this, context);
}

}  // namespace oca
