// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/system.h"

namespace oca {

/// How long a Vector port of a Function is: a number, or a name for a length that the wiring
/// settles. Ports that give the same name are equally long.
class Length {
 public:
  Length(int n) : n_(n) {}                              // NOLINT: a number is a length
  Length(const char* name) : name_(name) {}             // NOLINT: so is a name
  Length(std::string name) : name_(std::move(name)) {}  // NOLINT
  int number() const { return n_; }                     ///< -1 if it has a name
  const std::string& name() const { return name_; }

 private:
  int n_{-1};
  std::string name_;
};

/// A port of a Function. Length and unit count for Vectors; without a unit it connects to all.
struct FunctionPort {
  std::string name{};
  Length length{"n"};
  std::string unit{};
};

struct FunctionPorts {
  std::vector<FunctionPort> inputs{};
  FunctionPort output{};
};

/// The output of a Function that remembers: a state, `initial` at the start, which the callable
/// changes every period.
struct Memory {
  Period period{};
  PerComponent initial{};
};

/// All inputs of a Function whose callable takes any number of Vectors.
class VectorInputs {
 public:
  VectorInputs(const std::byte* arena, const Slot* slots, int count)
      : arena_(arena), slots_(slots), count_(count) {}
  int size() const { return count_; }
  VectorView operator[](int i) const { return ViewOf<Vector>::Read(arena_, slots_[i]); }

 private:
  const std::byte* arena_;
  const Slot* slots_;
  int count_;
};

/// A block that is given as a callable; MakeBlock makes one.
class Function final : public System {
 public:
  /// Finds what it was declared to read in the arena at `slots`, in that order, then its output.
  using Compute = std::function<void(std::byte* arena, const Slot* slots)>;
  struct Argument {
    const SignalType* type;  ///< nullptr: the time
    bool optional;
  };

  /// `arguments` are what the callable takes, an input each but the time. With `memory` the output
  /// is a state. throws WiringError if there are not as many ports as arguments, ConfigError if the
  /// period is not positive
  Function(const FunctionPorts& ports, const std::vector<Argument>& arguments,
           const SignalType& output, Compute compute, const std::optional<Memory>& memory = {});

 private:
  static void Call(const System& system, std::byte* arena, const Slot* slots);
  const Compute compute_;
};

namespace internal {

/// What a parameter of a callable is declared as.
template <class A>
struct ArgumentOf {
  using Type = Input<A>;
  static Function::Argument Declare() { return {&TypeOf<A>(), false}; }
};
template <class T>
struct ArgumentOf<const T*> {
  using Type = OptionalInput<T>;
  static Function::Argument Declare() { return {&TypeOf<T>(), true}; }
};
template <>
struct ArgumentOf<double> {
  using Type = Time;
  static Function::Argument Declare() { return {nullptr, false}; }
};
template <>
struct ArgumentOf<VectorView> {
  using Type = Input<Vector>;
  static Function::Argument Declare() { return {&kVectorType, false}; }
};
template <>
struct ArgumentOf<std::optional<VectorView>> {
  using Type = OptionalInput<Vector>;
  static Function::Argument Declare() { return {&kVectorType, true}; }
};

/// throws ConfigError unless the lengths are equal.
void CheckLength(Eigen::Index got, Eigen::Index expected);

template <class R>
inline constexpr bool kIsMatrix = std::is_base_of_v<Eigen::EigenBase<R>, R>;
/// The signal type of what a callable returns or takes to write to: numbers are a Vector.
template <class R>
using SignalFor = std::conditional_t<std::is_arithmetic_v<R> || kIsMatrix<R>, Vector, R>;

template <class R>
void StoreValue(const R& value, std::byte* arena, Slot slot) {
  auto&& kept = ViewOf<SignalFor<R>>::Write(arena, slot);
  if constexpr (std::is_arithmetic_v<R>) {
    CheckLength(1, kept.size());
    kept[0] = static_cast<double>(value);
  } else {
    if constexpr (kIsMatrix<R>) CheckLength(value.size(), kept.size());
    kept = value;
  }
}

/// What a callable reads and writes, by its signature.
template <class Signature>
struct Callable;
template <class R, class... A>
struct Callable<std::function<R(A...)>> {
  static constexpr bool kReturns = !std::is_void_v<R>;
  static_assert(kReturns || sizeof...(A) > 0,
                "a block's callable returns its output or takes it as its last parameter");
  static constexpr std::size_t kReads = sizeof...(A) - (kReturns ? 0 : 1);
  template <std::size_t I>
  using At = std::remove_cvref_t<std::tuple_element_t<I, std::tuple<A..., R>>>;
  using Output = SignalFor<At<kReturns ? sizeof...(A) : kReads>>;
  static constexpr std::size_t kTimes = kReads > 0 && std::same_as<At<0>, double> ? 1 : 0;
  static constexpr bool kAnyNumber = kReads == kTimes + 1 && std::same_as<At<kTimes>, VectorInputs>;

  static std::vector<Function::Argument> Arguments(std::size_t ports) {
    if constexpr (kAnyNumber) {
      std::vector<Function::Argument> arguments(ports, {&kVectorType, false});
      if (kTimes > 0) arguments.insert(arguments.begin(), {nullptr, false});
      return arguments;
    } else {
      return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::vector<Function::Argument>{ArgumentOf<At<I>>::Declare()...};
      }
      (std::make_index_sequence<kReads>());
    }
  }

  template <class F, class... Values>
  static void Call(const F& f, std::byte* arena, Slot output, Values&&... values) {
    if constexpr (kReturns) {
      StoreValue(f(std::forward<Values>(values)...), arena, output);
    } else {
      f(std::forward<Values>(values)..., ViewOf<Output>::Write(arena, output));
    }
  }

  template <class F>
  static Function::Compute ComputeOf(F f, int ports) {
    if constexpr (kAnyNumber) {
      return [f = std::move(f), ports](std::byte* arena, const Slot* slots) {
        const VectorInputs inputs(arena, slots + kTimes, ports);
        const Slot output = slots[kTimes + static_cast<std::size_t>(ports)];
        if constexpr (kTimes > 0) {
          Call(f, arena, output, Access<Time>::Get(arena, slots[0]), inputs);
        } else {
          Call(f, arena, output, inputs);
        }
      };
    } else {
      return [f = std::move(f)](std::byte* arena, const Slot* slots) {
        [&]<std::size_t... I>(std::index_sequence<I...>) {
          Call(f, arena, slots[kReads],
               Access<typename ArgumentOf<At<I>>::Type>::Get(arena, slots[I])...);
        }
        (std::make_index_sequence<kReads>());
      };
    }
  }
};

template <class F>
std::unique_ptr<System> MakeFunction(const FunctionPorts& ports, F f,
                                     const std::optional<Memory>& memory) {
  using C = Callable<decltype(std::function(std::declval<F>()))>;
  return std::make_unique<Function>(
      ports, C::Arguments(ports.inputs.size()), TypeOf<typename C::Output>(),
      C::ComputeOf(std::move(f), static_cast<int>(ports.inputs.size())), memory);
}

}  // namespace internal

/// A block from a callable, for scripts and for what no file needs a class for:
///
///     builder.AddSystem("speed", MakeBlock({.inputs = {{"velocity", 7, "rad/s"}},
///                                           .output = {"norm", 1, "rad/s"}},
///                                          [](VectorView velocity) { return velocity.norm(); }));
///
/// The callable takes the inputs in the order of their ports: a `VectorView`, a `const T&` of a
/// signal type T, or, for inputs that may stay unconnected, a `std::optional<VectorView>` or a
/// `const T*`; or, of any number of Vectors, all at once as a `const VectorInputs&`. A `double`
/// before them is the time, s. It returns the output, or takes it last: a `MutableVectorView` or a
/// `T&`. It must be const, be it called from several threads; what it throws, a length that is not
/// that of its port and numbers that are not finite fail the run as those of any system do.
template <class F>
std::unique_ptr<System> MakeBlock(const FunctionPorts& ports, F callable) {
  return internal::MakeFunction(ports, std::move(callable), {});
}

/// The same with an output that is a state: x[k + 1] = callable(inputs[k], x[k]), every period. The
/// callable takes it last, as a `MutableVectorView` that holds x[k] and leaves with x[k + 1].
template <class F>
std::unique_ptr<System> MakeBlock(const FunctionPorts& ports, const Memory& memory, F callable) {
  using C = internal::Callable<decltype(std::function(std::declval<F>()))>;
  static_assert(!C::kReturns && std::same_as<typename C::Output, Vector>,
                "a callable with memory takes it as its last parameter, a MutableVectorView");
  return internal::MakeFunction(ports, std::move(callable), memory);
}

}  // namespace oca
