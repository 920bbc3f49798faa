// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <string>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/engine_blocks.h"

namespace oca::bench {

inline constexpr int kTicks = 10000;  ///< of a run

/// ramp -> trivial blocks -> limiter, then perhaps a plant, and idle blocks beside them.
struct TickDiagram {
  enum class Plant { kNone, kIntegrator, kGuarded, kServo };
  struct Options {
    int trivial_blocks{0};
    int idle_on_constant{0};  ///< blocks on an input that never changes
    int idle_downstream{0};   ///< blocks behind the limiter whose outputs nobody reads
    Plant plant{Plant::kNone};
  };

  explicit TickDiagram(const Options& options) {
    DiagramBuilder builder;
    ramp = builder.Add<Ramp>("ramp").out;
    Output<Vector> last = ramp;
    for (int i = 0; i < options.trivial_blocks; ++i) {
      const auto& block = builder.Add<Trivial>("block" + std::to_string(i));
      builder.Connect(last, block.in);
      last = block.out;
    }
    const auto& limits = builder.Add<Limiter>("limiter");
    builder.Connect(last, limits.in);
    result = limiter = limits.out;
    for (int i = 0; i < options.idle_on_constant; ++i) {
      builder.ExportInput("fixed", builder.Add<Trivial>("constant" + std::to_string(i)).in);
    }
    for (int i = 0; i < options.idle_downstream; ++i) {
      builder.Connect(limiter, builder.Add<Trivial>("down" + std::to_string(i)).in);
    }
    if (options.plant == Plant::kIntegrator) AddPlant(builder, builder.Add<Integrator7>("plant"));
    if (options.plant == Plant::kGuarded) AddPlant(builder, builder.Add<Guarded7>("plant"));
    if (options.plant == Plant::kServo) AddPlant(builder, builder.Add<Servo14>("plant"));
    diagram = builder.Build();
  }

  void FixInputs(Context& context) const {
    if (diagram->exported_inputs().empty()) return;
    diagram->GetInput<Vector>("fixed").Fix(context, Eigen::VectorXd::Ones(kWidth));
  }

  Output<Vector> ramp, limiter, result;
  std::unique_ptr<Diagram> diagram;

 private:
  template <class S>
  void AddPlant(DiagramBuilder& builder, const S& plant) {
    builder.Connect(limiter, plant.in);
    result = plant.out;
  }
};

/// A tick an iteration; every run of kTicks starts over from 0.1 s and must come `within` of
/// `expected`.
inline void RunTicks(benchmark::State& state, const TickDiagram& ticks, Simulator& simulator,
                     double expected, double within = 1e-9) {
  simulator.AdvanceTo(0.1);
  const Context warm = simulator.context();
  const AllocationCounter allocations(state);
  while (state.KeepRunningBatch(kTicks)) {
    simulator.context() = warm;
    simulator.AdvanceTo(10.1);
    const double reached = ticks.result.Eval(simulator.context())[0];
    if (!(std::fabs(reached - expected) < within)) {
      state.SkipWithError("wrong result");
      break;
    }
  }
}

}  // namespace oca::bench
