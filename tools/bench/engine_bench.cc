// SPDX-License-Identifier: BSD-3-Clause
//
// What the engine costs, row by row; each row `engine/ROW` beside its floor `engine/ROW/floor`: the
// same arithmetic on std::array<double, 7> through virtual calls in planned order.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <vector>

#include "framework/diagram.h"
#include "framework/port_access.h"
#include "framework/simulator.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/engine_blocks.h"

namespace oca::bench {
namespace {

using Array7 = std::array<double, kWidth>;

/// A chain of `n` trivial blocks, its input and its last output exported.
struct Chain {
  explicit Chain(int n) {
    DiagramBuilder builder;
    for (int i = 0; i < n; ++i) {
      blocks.push_back(&builder.Add<Trivial>("block" + std::to_string(i)));
      if (i > 0) builder.Connect(blocks[i - 1]->out, blocks[i]->in);
    }
    builder.ExportInput("in", blocks.front()->in);
    diagram = builder.Build();
  }
  std::vector<const Trivial*> blocks;
  std::unique_ptr<Diagram> diagram;
};

class FloorBlock {
 public:
  virtual ~FloorBlock() = default;
  virtual void Calc(double t, const Array7& u, Array7& y) const = 0;
};
class FloorTrivial final : public FloorBlock {
 public:
  void Calc(double /*t*/, const Array7& u, Array7& y) const override {
    for (int i = 0; i < kWidth; ++i) y[i] = 0.999 * u[i] + 0.001;
  }
};
class FloorRamp final : public FloorBlock {
 public:
  void Calc(double t, const Array7& /*u*/, Array7& y) const override {
    for (int i = 0; i < kWidth; ++i) y[i] = (i + 1) * 0.01 * t;
  }
};
class FloorLimiter final : public FloorBlock {
 public:
  void Calc(double /*t*/, const Array7& u, Array7& y) const override {
    for (int i = 0; i < kWidth; ++i) {
      y[i] = std::clamp(y[i] + std::clamp(u[i] - y[i], -1e-3, 1e-3), -2.9, 2.9);
    }
  }
};

void CountBlocks(benchmark::State& state, int blocks) {
  state.counters["ns_per_block"] = benchmark::Counter(
      static_cast<double>(blocks) * 1e-9,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void ChainRow(benchmark::State& state, int n) {
  Chain chain(n);
  Context context = chain.diagram->MakeContext();
  Eigen::VectorXd u = Eigen::VectorXd::Constant(kWidth, 0.5);
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    u[0] += 1e-9;
    chain.blocks.front()->in.Fix(context, u);
    benchmark::DoNotOptimize(chain.blocks.back()->out.Eval(context)[0]);
  }
  CountBlocks(state, n);
}

void ChainFloor(benchmark::State& state, int n) {
  std::vector<std::unique_ptr<FloorBlock>> blocks;
  for (int i = 0; i < n; ++i) blocks.push_back(std::make_unique<FloorTrivial>());
  std::vector<Array7> values(n + 1);
  values[0].fill(0.5);
  for (auto _ : state) {
    values[0][0] += 1e-9;
    benchmark::DoNotOptimize(values.data());
    for (int i = 0; i < n; ++i) blocks[i]->Calc(0.0, values[i], values[i + 1]);
    benchmark::DoNotOptimize(values.back()[0]);
  }
  CountBlocks(state, n);
}

void CacheHit(benchmark::State& state) {
  Chain chain(100);
  Context context = chain.diagram->MakeContext();
  chain.blocks.front()->in.Fix(context, Eigen::VectorXd::Constant(kWidth, 0.5));
  for (auto _ : state) benchmark::DoNotOptimize(chain.blocks.back()->out.Eval(context)[0]);
}

void TimeOnly(benchmark::State& state) {
  Chain chain(100);
  Context context = chain.diagram->MakeContext();
  chain.blocks.front()->in.Fix(context, Eigen::VectorXd::Constant(kWidth, 0.5));
  double t = 0.0;
  for (auto _ : state) {
    context.SetTime(t += 1e-3);
    benchmark::DoNotOptimize(chain.blocks.back()->out.Eval(context)[0]);
  }
}

struct Ticks {
  Ticks(int trivial_blocks, int idle_on_constant, int idle_downstream, bool integrate,
        const IntegratorOptions& options = {}) {
    DiagramBuilder builder;
    const auto& ramp = builder.Add<Ramp>("ramp");
    Output<Vector> last = ramp.out;
    for (int i = 0; i < trivial_blocks; ++i) {
      const auto& block = builder.Add<Trivial>("block" + std::to_string(i));
      builder.Connect(last, block.in);
      last = block.out;
    }
    limiter = &builder.Add<Limiter>("limiter");
    builder.Connect(last, limiter->in);
    result = limiter->out;
    if (integrate) {
      const auto& plant = builder.Add<Integrator7>("plant");
      builder.Connect(limiter->out, plant.in);
      result = plant.out;
    }
    for (int i = 0; i < idle_on_constant; ++i) {
      const auto& block = builder.Add<Trivial>("constant" + std::to_string(i));
      builder.ExportInput("fixed", block.in);
    }
    for (int i = 0; i < idle_downstream; ++i) {
      const auto& block = builder.Add<Trivial>("down" + std::to_string(i));
      builder.Connect(limiter->out, block.in);
    }
    diagram = builder.Build();
    simulator = std::make_unique<Simulator>(*diagram, options);
    if (idle_on_constant > 0) {
      diagram->GetInput<Vector>("fixed").Fix(simulator->context(), Eigen::VectorXd::Ones(kWidth));
    }
  }
  const Limiter* limiter;
  Output<Vector> result;
  std::unique_ptr<Diagram> diagram;
  std::unique_ptr<Simulator> simulator;
};

/// Advances a warmed-up simulator by a tick an iteration, starting over at 10.1 s, and checks what
/// the row must reach there.
void RunTicks(benchmark::State& state, const std::function<std::unique_ptr<Ticks>()>& make,
              double expected) {
  std::unique_ptr<Ticks> ticks = make();
  ticks->simulator->AdvanceTo(10.1);
  const double reached = ticks->result.Eval(ticks->simulator->context())[0];
  if (std::fabs(reached - expected) > 1e-9) state.SkipWithError("wrong result");
  ticks = make();
  ticks->simulator->AdvanceTo(0.1);
  std::int64_t tick = 100;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    ticks->simulator->AdvanceTo(static_cast<double>(++tick) / 1000.0);
  }
}

void LimiterFloor(benchmark::State& state, int trivial_blocks) {
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

void Servo(benchmark::State& state, IntegratorKind kind) {
  DiagramBuilder builder;
  const auto& ramp = builder.Add<Ramp>("ramp");
  const auto& limiter = builder.Add<Limiter>("limiter");
  const auto& servo = builder.Add<Servo14>("servo");
  builder.Connect(ramp.out, limiter.in);
  builder.Connect(limiter.out, servo.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram, {.integrator = kind});
  simulator.AdvanceTo(0.1);
  std::int64_t tick = 100;
  const AllocationCounter allocations(state);
  for (auto _ : state) simulator.AdvanceTo(static_cast<double>(++tick) / 1000.0);
}

void BuildChain(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Chain(100).diagram.get());
}
void MakeContext(benchmark::State& state) {
  Chain chain(100);
  for (auto _ : state) {
    Context context = chain.diagram->MakeContext();
    benchmark::DoNotOptimize(context.time());
  }
}
void CloneContext(benchmark::State& state) {
  Chain chain(100);
  const Context original = chain.diagram->MakeContext();
  for (auto _ : state) {
    Context copy(original);
    benchmark::DoNotOptimize(copy.time());
  }
}

void Register() {
  using benchmark::RegisterBenchmark;
  const auto ticks = [](const char* name, const std::function<std::unique_ptr<Ticks>()>& make,
                        double expected) {
    RegisterBenchmark(
        name, [make, expected](benchmark::State& state) { RunTicks(state, make, expected); });
  };
  RegisterBenchmark("engine/a7", [](auto& state) { ChainRow(state, 7); });
  RegisterBenchmark("engine/a7/floor", [](auto& state) { ChainFloor(state, 7); });
  RegisterBenchmark("engine/a100", [](auto& state) { ChainRow(state, 100); });
  RegisterBenchmark("engine/a100/floor", [](auto& state) { ChainFloor(state, 100); });
  RegisterBenchmark("engine/b", CacheHit);
  RegisterBenchmark("engine/t100", TimeOnly);
  ticks(
      "engine/c", [] { return std::make_unique<Ticks>(0, 0, 0, false); }, 0.10099);
  RegisterBenchmark("engine/c/floor", [](auto& state) { LimiterFloor(state, 0); });
  ticks(
      "engine/c7", [] { return std::make_unique<Ticks>(7, 0, 0, false); }, 0.107264222);
  RegisterBenchmark("engine/c7/floor", [](auto& state) { LimiterFloor(state, 7); });
  ticks(
      "engine/c-idle/constant", [] { return std::make_unique<Ticks>(0, 100, 0, false); }, 0.10099);
  ticks(
      "engine/c-idle/downstream", [] { return std::make_unique<Ticks>(0, 0, 100, false); },
      0.10099);
  ticks(
      "engine/d/fixed_dp5",
      [] {
        return std::make_unique<Ticks>(0, 0, 0, true,
                                       IntegratorOptions{.integrator = IntegratorKind::kFixedDp5});
      },
      0.5099995);
  ticks(
      "engine/d/erk_dp5", [] { return std::make_unique<Ticks>(0, 0, 0, true); }, 0.5099995);
  RegisterBenchmark("engine/d14/erk_dp5",
                    [](auto& state) { Servo(state, IntegratorKind::kErkDp5); });
  RegisterBenchmark("engine/d14/cvode_adams",
                    [](auto& state) { Servo(state, IntegratorKind::kCvodeAdams); });
  RegisterBenchmark("engine/d14/cvode_bdf",
                    [](auto& state) { Servo(state, IntegratorKind::kCvodeBdf); });
  RegisterBenchmark("engine/build", BuildChain);
  RegisterBenchmark("engine/context", MakeContext);
  RegisterBenchmark("engine/clone", CloneContext);
}

const bool kRegistered = (Register(), true);

}  // namespace
}  // namespace oca::bench
