// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"

namespace oca {

/// One system on a bench: all its required inputs can be fixed, all its outputs evaluated, and
/// time passes for it.
///
///     SystemBench<Gain> bench(Gain::Params{.gain = 2.0});
///     bench->in.Fix(bench.context(), x);
///     bench.AdvanceTo(1.0);
///     bench->out.Eval(bench.context());
template <class S>
class SystemBench {
 public:
  template <class... Arguments>
  explicit SystemBench(Arguments&&... arguments) {
    auto owned = std::make_unique<S>(std::forward<Arguments>(arguments)...);
    system_ = owned.get();
    diagram_ = MakeDiagramOf(std::move(owned));
    simulator_ = std::make_unique<Simulator>(*diagram_);
  }

  const S* operator->() const { return system_; }
  const S& system() const { return *system_; }
  Context& context() { return simulator_->context(); }
  Simulator& simulator() { return *simulator_; }
  const Diagram& diagram() const { return *diagram_; }
  void AdvanceTo(double time) { simulator_->AdvanceTo(time); }

 private:
  const S* system_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Simulator> simulator_;
};

}  // namespace oca
