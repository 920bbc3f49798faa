// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "oca/framework/dataflow/port_access.h"

namespace oca {

class Profile;

/// Every mutable value of one run: time, states, cached outputs, counters of discrete events and
/// the integrator's step, in one block of memory. A value: copy it to save a run, assign it to
/// restore one; assigning within one diagram does not allocate.
///
/// A Context belongs to the root diagram that made it, which must outlive it. Different Contexts
/// of one diagram may be used by different threads; one Context by one thread at a time, reading
/// included, because outputs are cached in it.
class Context {
 public:
  Context(const Context& other);
  Context(Context&& other) noexcept;
  Context& operator=(const Context& other);
  Context& operator=(Context&& other) noexcept;
  ~Context();

  double time() const { return header().time; }  ///< s
  /// throws ConfigError if `time` is not finite.
  void SetTime(double time);

  /// All continuous state, in the order of the systems in the diagram.
  VectorView continuous_state() const;
  void SetContinuousState(const Eigen::Ref<const Eigen::VectorXd>& state);

 private:
  friend class ControlLoop;
  friend class Diagram;
  friend class Schedule;
  friend class ScheduleCompiler;
  friend class Simulator;

  /// The first bytes of the arena.
  struct Header {
    double time;
    Log* log;
    std::uint64_t epoch;     ///< counts changes of time, states and fixed inputs
    double integrator_step;  ///< s; the step an adaptive integrator would try next, 0 unknown
    std::int64_t initialized;
    Profile* profile;  ///< of the simulator that advances this context now; not copied
  };

  explicit Context(const Schedule* schedule);
  const Header& header() const { return *reinterpret_cast<const Header*>(arena_.get()); }
  Header& header() { return *reinterpret_cast<Header*>(arena_.get()); }
  void DestroyObjects();

  struct FreeArena {
    void operator()(std::byte* arena) const;
  };

  const Schedule* schedule_;
  std::unique_ptr<std::byte, FreeArena> arena_;
};

}  // namespace oca
