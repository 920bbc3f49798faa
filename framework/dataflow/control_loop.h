// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/dataflow/status.h"

namespace oca {

/// Runs a root diagram inside a robot's own control loop, one Tick a cycle: no simulator, no
/// integrator, no thread, and after Initialize neither an exception nor the heap.
///
///     ControlLoop loop(*diagram, Period(1, 1000));
///     const auto q = diagram->GetInput<Vector>("plant.position");
///     const auto delta = diagram->GetOutput<Vector>("limiter.limited_delta");
///     loop.Watch(delta);
///     ... Set every input once ...
///     loop.Initialize();
///     for (;;) {  // 1 kHz
///       if (Status status = loop.Set(q, measured); !status.ok()) Stop(status.message());
///       if (Status status = loop.Tick(); !status.ok()) Stop(status.message());
///       Command(loop.Get(delta));
///     }
///
/// Tick k = 0, 1, 2, ... is the instant t = k period, in the order of the simulator's contract:
/// publish events, then resets, then discrete updates, each as often as its own period says; then
/// the watched outputs, which see the new state. With the same inputs it gives the simulator's
/// bits. The updates of one stage happen all or not at all: if one fails the states stay, and what
/// was due is due again at the next Tick.
///
/// The diagram must outlive the loop, and must not be nested. One loop belongs to one thread at a
/// time; several loops may share a diagram.
class ControlLoop {
 public:
  /// throws ConfigError naming the system if the diagram has continuous state or witnesses, which
  /// want a Simulator, or events that are not due at whole multiples of `period`, s.
  ControlLoop(const Diagram& diagram, const Period& period);

  /// Has every Tick compute an output. throws WiringError if it is none of the diagram.
  void Watch(const OutputHandle& output);
  /// Receives what publish events log; nullptr drops it.
  void SetLog(Log* log);
  /// Runs the initialization events, computes the watched outputs once and takes all memory that
  /// ticks will need. Every input must have been Set, to the largest value expected of it.
  /// throws SimulationError.
  void Initialize();

  /// Gives an exported input its value, which is copied; it stays until the next one. A value that
  /// is refused leaves the last one: a vector of the wrong length, not finite or outside what its
  /// port can be (joints far beyond their limits), another signal that its type's Check refuses.
  Status Set(const Input<Vector>& input, const Eigen::Ref<const Eigen::VectorXd>& value) noexcept;
  template <class T>
  requires(!std::is_same_v<T, Vector>) Status Set(const Input<T>& input, const T& value)
  noexcept;

  /// The next instant. A system that throws or yields a number that is not finite is named; only
  /// then may memory be taken, for the exception inside.
  Status Tick() noexcept;

  /// A watched output as the last Tick left it; without meaning if that failed.
  template <class T>
  typename ViewOf<T>::Const Get(const Output<T>& output) const noexcept {
    return ViewOf<T>::Read(Locate(output).arena, Locate(output).slot);
  }

  double time() const noexcept { return context_.time(); }  ///< s, of the last Tick
  std::int64_t ticks() const noexcept { return ticks_; }
  const Context& context() const noexcept { return context_; }

 private:
  /// When the events of a group of the schedule are due, in ticks.
  struct Beat {
    std::int64_t offset;
    std::int64_t multiple;
    /// The first event that is not before `tick`.
    std::int64_t FirstCount(std::int64_t tick) const;
  };

  internal::Storage Locate(const OutputHandle& output) const noexcept;
  Status Refuse(const InputHandle& input, std::string_view what) const noexcept;
  bool Due(std::size_t group) const;
  void RunPublishes();
  void RunStage(System::Stage stage);
  void ComputeWatched();

  const Schedule& schedule_;
  Context context_;
  const Period period_;
  std::vector<Beat> beats_;   // one a group of the schedule
  std::vector<int> due_;      // events of the present stage
  std::vector<int> watched_;  // nodes
  std::int64_t ticks_{0};
  bool initialized_{false};
};

template <class T>
requires(!std::is_same_v<T, Vector>) Status ControlLoop::Set(const Input<T>& input, const T& value)
noexcept {
  try {
    if (const Fault fault = Signal<T>::Check(value, Look::kWhole); !fault.ok()) {
      return Refuse(input, fault.text());
    }
    internal::Store(internal::FindExported(input, context_), value);
    internal::MarkChanged(input, context_);
    return {};
  } catch (...) {
    return Status::OfCurrentException(time());
  }
}

}  // namespace oca
