// SPDX-License-Identifier: BSD-3-Clause
//
// What a tick of the simulator costs. An iteration is a tick of 1 ms; each run advances a warmed-up
// Context from 0.1 s to 10.1 s and checks what it reaches.

#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "oca/framework/simulation/signal_log.h"
#include "oca/framework/simulation/simulator.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/engine_floors.h"
#include "tools/bench/tick_diagram.h"

namespace oca::bench {
namespace {

void Limit(benchmark::State& state, const TickDiagram::Options& options, double expected) {
  const TickDiagram ticks(options);
  Simulator simulator(*ticks.diagram);
  ticks.FixInputs(simulator.context());
  RunTicks(state, ticks, simulator, expected);
}

void Log(benchmark::State& state) {
  const TickDiagram ticks({});
  Simulator simulator(*ticks.diagram);
  const SignalLog log(simulator, {ticks.ramp, ticks.limiter}, Period(1, 1000), 20000);
  RunTicks(state, ticks, simulator, 0.10099);
  if (log.rows() < kTicks) state.SkipWithError("rows are missing");
}

void LimitFloor(benchmark::State& state, int trivial_blocks) {
  std::vector<std::unique_ptr<FloorBlock>> blocks;
  blocks.push_back(std::make_unique<FloorRamp>());
  for (int i = 0; i < trivial_blocks; ++i) blocks.push_back(std::make_unique<FloorTrivial>());
  blocks.push_back(std::make_unique<FloorLimiter>());
  std::vector<Array7> values(blocks.size() + 1);
  for (auto& value : values) value.fill(0.0);
  std::int64_t tick = 0;
  for (auto _ : state) {
    const double t = static_cast<double>(++tick) / 1000.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i]->Calc(t, values[i], values[i + 1]);
    benchmark::DoNotOptimize(values.back()[0]);
  }
}

/// Row c in several threads that share a diagram, each with a simulator and a Context of its own.
/// It scales if a tick takes no more of the processor than in one thread.
void Threads(benchmark::State& state) {
  static const TickDiagram ticks({});
  Simulator simulator(*ticks.diagram);
  RunTicks(state, ticks, simulator, 0.10099);
}

const TickDiagram::Options kSeven{.trivial_blocks = 7};
const TickDiagram::Options kIdleOnConstant{.idle_on_constant = 100};
const TickDiagram::Options kIdleDownstream{.idle_downstream = 100};

BENCHMARK_CAPTURE(Limit, c, TickDiagram::Options{}, 0.10099)->Name("engine/c");
BENCHMARK_CAPTURE(LimitFloor, c, 0)->Name("engine/c/floor");
BENCHMARK_CAPTURE(Limit, c7, kSeven, 0.107264222)->Name("engine/c7");
BENCHMARK_CAPTURE(LimitFloor, c7, 7)->Name("engine/c7/floor");
BENCHMARK_CAPTURE(Limit, constant, kIdleOnConstant, 0.10099)->Name("engine/c-idle/constant");
BENCHMARK_CAPTURE(Limit, downstream, kIdleDownstream, 0.10099)->Name("engine/c-idle/downstream");
BENCHMARK(Log)->Name("engine/log");
BENCHMARK(Threads)->Name("engine/threads")->Threads(1)->Threads(2);

}  // namespace
}  // namespace oca::bench
