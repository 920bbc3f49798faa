// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/framework/dataflow/port.h"

namespace oca {

class Wiring;

/// What a walk up the wiring follows: only what a value is computed from at the same instant
/// (direct feedthrough), or also what the states on the way are made from, at whatever instant.
enum class Through { kInstant, kStates };

/// All that a port depends on, found in the declarations of the systems: an output depends on what
/// its calculation reads, a state on what its derivative and the events that write it read. Inputs
/// that a system has for another purpose are not followed.
struct Upstream {
  struct Entry {
    OutputHandle output;  ///< of a leaf
    int connections;      ///< the least number of them between it and the port
  };
  std::vector<Entry> outputs;         ///< the nearest first, the port itself included
  std::vector<InputHandle> exported;  ///< inputs of the root
  std::vector<StateHandle> states;
  bool time{false};

  /// Whether the port is a function of the time and nothing else.
  bool of_time_alone() const { return exported.empty() && states.empty(); }

  static Upstream Of(const Wiring& wiring, const OutputHandle& output, Through through);
  static Upstream Of(const Wiring& wiring, const InputHandle& input, Through through);
};

}  // namespace oca
