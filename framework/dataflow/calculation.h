// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/port.h"

namespace oca {

/// One thing that a calculation reads.
struct Read {
  enum class Kind { kOfTime, kOfLog, kInput, kOutput, kCached, kState } kind;
  int index{-1};                  ///< of the input, output, cached value or state in its system
  const System* system{nullptr};  ///< the one that declared it; none for the time and the log
};

/// A member function of a system with the list of what it reads. `function` finds the values in
/// the arena at `slots`: first one slot a read, then one a write.
struct Calculation {
  using Function = void (*)(const System& system, std::byte* arena, const Slot* slots);
  Function function{nullptr};
  std::vector<Read> reads;
};

/// Stands for the value that a calculation writes.
template <class T>
struct WriteOf {};

/// The signal type behind a state handle.
template <class State>
struct SignalOf;
template <class T>
struct SignalOf<DiscreteState<T>> {
  using Type = T;
};
template <>
struct SignalOf<ContinuousState> {
  using Type = Vector;
};

namespace internal {

template <class H>
struct Access;
template <>
struct Access<Time> {
  static double Get(std::byte* arena, Slot slot) {
    return *reinterpret_cast<const double*>(arena + slot.offset);
  }
  static Read Declare(Time) { return {Read::Kind::kOfTime}; }
};
template <>
struct Access<LogAccess> {
  static Log& Get(std::byte* arena, Slot slot) {
    return **reinterpret_cast<Log**>(arena + slot.offset);
  }
  static Read Declare(LogAccess) { return {Read::Kind::kOfLog}; }
};
template <class T>
struct Access<Input<T>> {
  static decltype(auto) Get(std::byte* arena, Slot slot) { return ViewOf<T>::Read(arena, slot); }
  static Read Declare(const Handle& handle) {
    return {Read::Kind::kInput, handle.index, handle.system};
  }
};
template <class T>
struct Access<OptionalInput<T>> {
  static auto Get(std::byte* arena, Slot slot) { return ViewOf<T>::ReadOptional(arena, slot); }
  static Read Declare(const Handle& handle) {
    return {Read::Kind::kInput, handle.index, handle.system};
  }
};
template <class T>
struct Access<Output<T>> {
  static decltype(auto) Get(std::byte* arena, Slot slot) { return ViewOf<T>::Read(arena, slot); }
  static Read Declare(const Handle& handle) {
    return {Read::Kind::kOutput, handle.index, handle.system};
  }
};
template <class T>
struct Access<Cached<T>> {
  static const T& Get(std::byte* arena, Slot slot) { return ViewOf<T>::Read(arena, slot); }
  static Read Declare(const Handle& handle) {
    return {Read::Kind::kCached, handle.index, handle.system};
  }
};
template <class T>
struct Access<DiscreteState<T>> {
  static decltype(auto) Get(std::byte* arena, Slot slot) { return ViewOf<T>::Read(arena, slot); }
  static Read Declare(const Handle& handle) {
    return {Read::Kind::kState, handle.index, handle.system};
  }
};
template <>
struct Access<ContinuousState> {
  static VectorView Get(std::byte* arena, Slot slot) { return ViewOf<Vector>::Read(arena, slot); }
  static Read Declare(const Handle& handle) {
    return {Read::Kind::kState, handle.index, handle.system};
  }
};
template <class T>
struct Access<WriteOf<T>> {
  static decltype(auto) Get(std::byte* arena, Slot slot) { return ViewOf<T>::Write(arena, slot); }
};

template <class M>
struct OwnerOf;
template <class S, class R, class... A>
struct OwnerOf<R (S::*)(A...) const> {
  using Type = S;
};

/// What a method computes that takes it last, as a reference to write to.
template <class M>
struct LastOf;
template <class S, class R, class... A>
struct LastOf<R (S::*)(A...) const> {
  using Reference = std::tuple_element_t<sizeof...(A) - 1, std::tuple<A...>>;
  using Type = std::remove_reference_t<Reference>;
  static_assert(std::is_lvalue_reference_v<Reference> && !std::is_const_v<Type>,
                "the last parameter is the value to write, a T&");
};

/// Calls a method that returns a double and stores it at the last slot.
template <auto kMethod, class... Handles>
void InvokeWitness(const System& system, std::byte* arena, const Slot* slots) {
  using Owner = typename OwnerOf<decltype(kMethod)>::Type;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    *reinterpret_cast<double*>(arena + slots[sizeof...(Handles)].offset) =
        (static_cast<const Owner&>(system).*kMethod)(Access<Handles>::Get(arena, slots[I])...);
  }
  (std::index_sequence_for<Handles...>());
}

/// Shows a member of what it reads: a number or a vector as a Vector, others as they are.
template <auto kMember, class From, class To>
void InvokeMember(const System& /*system*/, std::byte* arena, const Slot* slots) {
  const auto& value = Access<From>::Get(arena, slots[0]).*kMember;
  auto&& shown = Access<To>::Get(arena, slots[1]);
  if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
    shown[0] = static_cast<double>(value);
  } else {
    shown = value;
  }
}

template <auto kMethod, class... Handles>
void Invoke(const System& system, std::byte* arena, const Slot* slots) {
  using Owner = typename OwnerOf<decltype(kMethod)>::Type;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (static_cast<const Owner&>(system).*kMethod)(Access<Handles>::Get(arena, slots[I])...);
  }
  (std::index_sequence_for<Handles...>());
}

}  // namespace internal

/// Binds a member function to what it reads and then writes. A method whose parameters do not fit
/// the handles does not compile. A data member, of the one value that is read, is copied.
template <auto kMember, class... WriteTypes, class... Reads>
Calculation MakeCalculation(const Reads&... reads) {
  if constexpr (std::is_member_object_pointer_v<decltype(kMember)>) {
    return {&internal::InvokeMember<kMember, Reads..., WriteTypes...>,
            {internal::Access<Reads>::Declare(reads)...}};
  } else {
    return {&internal::Invoke<kMember, Reads..., WriteTypes...>,
            {internal::Access<Reads>::Declare(reads)...}};
  }
}

/// Binds a witness function, which returns its value, to what it reads.
template <auto kMethod, class... Reads>
Calculation MakeWitness(const Reads&... reads) {
  return {&internal::InvokeWitness<kMethod, Reads...>,
          {internal::Access<Reads>::Declare(reads)...}};
}

}  // namespace oca
