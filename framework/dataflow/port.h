// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/signal.h"

namespace oca {

class Context;
class Log;
class Schedule;
class System;

/// The length of a vector port or state: a number, or a variable that Build settles from what is
/// connected. Make variables with System::DeclareSize.
class Size {
 public:
  Size(int n) : n_(n) {}  // NOLINT: an int is a size
  static Size Variable(int index) {
    Size size(-1);
    size.variable_ = index;
    return size;
  }
  int number() const { return n_; }           ///< -1 for a variable
  int variable() const { return variable_; }  ///< -1 for a number

 private:
  int n_;
  int variable_{-1};
};

/// The unit of a port, `any` (connects to everything), or a variable that Build settles.
class Unit {
 public:
  Unit(const char* text) : Unit(std::string(text)) {}  // NOLINT: a literal is a unit
  Unit(std::string text);                              // NOLINT: a string is a unit
  static Unit Any() { return Unit(std::string()); }
  static Unit Variable(int index) {
    Unit unit = Any();
    unit.variable_ = index;
    return unit;
  }
  /// This unit per second, as often as said: rad -> rad/s -> rad/s^2.
  Unit Rate(int times = 1) const {
    Unit rate = *this;
    rate.rates_ += times;
    return rate;
  }
  bool any() const { return variable_ < 0 && base_.empty(); }
  int variable() const { return variable_; }
  int rates() const { return rates_; }  ///< how often the base is taken per second
  /// As people write it: `rad/s^2`; `u/s` for a variable, nothing for any.
  std::string ToString() const;
  friend bool operator==(const Unit&, const Unit&) = default;

 private:
  std::string base_;  ///< of rad/s^2: rad
  int variable_{-1};
  int rates_{0};
};

/// What the numbers of an input can be at all: one that lies outside is no value but the mistake of
/// who gave it, and refused. One entry a number; `names` say what each is ("joint 'a1'"), `rule`
/// where the bounds come from.
struct Plausible {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  std::vector<std::string> names;
  std::string rule;

  /// What is wrong with the numbers, as many as there are bounds; takes no memory.
  Fault Check(const double* values) const;
  friend bool operator==(const Plausible&, const Plausible&) = default;
};

/// Length and unit of a vector port or state, and what an input can be; null: anything finite.
/// Ports of other types ignore it.
struct PortSpec {
  Size size{1};
  Unit unit{Unit::Any()};
  std::shared_ptr<const Plausible> plausible{};
};

/// Where a port, a state or an update sits in its system. Handles are small values; the system
/// they belong to must outlive them.
struct Handle {
  const System* system{nullptr};
  int index{-1};
  friend bool operator==(const Handle&, const Handle&) = default;
};

struct InputHandle : Handle {};
struct OutputHandle : Handle {};
struct CachedHandle : Handle {};
struct StateHandle : Handle {};

template <class T>
struct Input;
template <class T>
struct Output;
/// The same port with its type; dynamic_port.h. throws WiringError if it has another one.
template <class T>
Input<T> Typed(const InputHandle& input, const std::string& path = {});
template <class T>
Output<T> Typed(const OutputHandle& output, const std::string& path = {});

// Typed handles come from System::Declare..., Diagram::Get... and Typed alone: all of them know the
// type. One that was made by default is no port.

/// An input port. Calculations that name it read what it is connected to.
template <class T>
struct Input : InputHandle {
  Input() = default;
  /// Gives an input that a root diagram exports its value. throws WiringError for other inputs.
  template <class Value>
  void Fix(Context& context, const Value& value) const;

 private:
  friend class System;
  friend Input Typed<T>(const InputHandle& input, const std::string& path);
  explicit Input(const InputHandle& handle) : InputHandle(handle) {}
};

/// An input port that may stay unconnected; calculations then read an empty optional or nullptr.
template <class T>
struct OptionalInput : InputHandle {
  OptionalInput() = default;
  OptionalInput(const Input<T>& required) : InputHandle(required) {}  // NOLINT: one that is there

 private:
  friend class System;
  explicit OptionalInput(const InputHandle& handle) : InputHandle(handle) {}
};

/// An output port.
template <class T>
struct Output : OutputHandle {
  Output() = default;
  /// The value at the context's time and state; computed only if something it depends on changed.
  /// throws SimulationError if a calculation fails or yields a number that is not finite.
  typename ViewOf<T>::Const Eval(const Context& context) const;

 private:
  friend class System;
  friend Output Typed<T>(const OutputHandle& output, const std::string& path);
  explicit Output(const OutputHandle& handle) : OutputHandle(handle) {}
};

/// A value that several calculations of one system share, computed at most once an instant. It is
/// no port: nothing outside the system reads it, files and records do not know it.
template <class T>
struct Cached : CachedHandle {
  Cached() = default;
  /// As of an output; for tests of the system.
  const T& Eval(const Context& context) const;

 private:
  friend class System;
  explicit Cached(const CachedHandle& handle) : CachedHandle(handle) {}
};

/// A part of the state that updates change at discrete times.
template <class T>
struct DiscreteState : StateHandle {
  DiscreteState() = default;
  typename ViewOf<T>::Const Get(const Context& context) const;
  template <class Value>
  void Set(Context& context, const Value& value) const;

 private:
  friend class System;
  explicit DiscreteState(const StateHandle& handle) : StateHandle(handle) {}
};

/// A part of the state that a derivative drives.
struct ContinuousState : StateHandle {
  ContinuousState() = default;
  VectorView Get(const Context& context) const;
  void Set(Context& context, const Eigen::Ref<const Eigen::VectorXd>& value) const;

 private:
  friend class System;
  explicit ContinuousState(const StateHandle& handle) : StateHandle(handle) {}
};

/// Which sign changes of a witness function count: any, from below, or from above.
enum class Direction { kBoth, kRising, kFalling };

/// A function of the state, the inputs and the time; a reset may wait for its zero crossings.
struct Witness : Handle {};

/// The moment at which a witness function reaches or crosses zero.
struct When {
  Witness witness;
};

/// Names the time among the things a calculation reads; it arrives as a double in s.
struct Time {};
inline constexpr Time kTime;

/// Names the log among the things a publish event or an update reads; it arrives as a Log&.
struct LogAccess {};
inline constexpr LogAccess kLog;

}  // namespace oca
