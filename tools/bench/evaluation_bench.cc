// SPDX-License-Identifier: BSD-3-Clause
//
// What it costs to make diagrams and Contexts and to evaluate outputs, without a simulator. Each
// row `engine/ROW` stands beside its floor `engine/ROW/floor`, see engine_floors.h.

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "tools/bench/allocation_counter.h"
#include "tools/bench/engine_chain.h"
#include "tools/bench/engine_floors.h"

namespace oca::bench {
namespace {

void CountBlocks(benchmark::State& state, int blocks) {
  // Inverted, a rate is a time in seconds; the console adds their unit.
  state.counters["per_block"] = benchmark::Counter(
      static_cast<double>(blocks),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void WriteAndEvaluate(benchmark::State& state, const Diagram& diagram, int n) {
  Context context = diagram.MakeContext();
  const auto in = diagram.GetInput<Vector>("in");
  const auto out = diagram.GetOutput<Vector>("out");
  Eigen::VectorXd u = Eigen::VectorXd::Constant(kWidth, 0.5);
  {
    const AllocationCounter allocations(state);
    for (auto _ : state) {
      u[0] += 1e-9;
      in.Fix(context, u);
      benchmark::DoNotOptimize(out.Eval(context)[0]);
    }
  }
  CountBlocks(state, n);
}

void Chain(benchmark::State& state, int n) { WriteAndEvaluate(state, *MakeChain(n), n); }

void Nested(benchmark::State& state) { WriteAndEvaluate(state, *MakeNestedChain(100, 3), 100); }

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

void CacheHit(benchmark::State& state, int n) {
  const auto diagram = MakeChain(n);
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(context, Eigen::VectorXd::Constant(kWidth, 0.5));
  const auto out = diagram->GetOutput<Vector>("out");
  const AllocationCounter allocations(state);
  for (auto _ : state) benchmark::DoNotOptimize(out.Eval(context)[0]);
}

void TimeOnly(benchmark::State& state) {
  const auto diagram = MakeChain(100);
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(context, Eigen::VectorXd::Constant(kWidth, 0.5));
  const auto out = diagram->GetOutput<Vector>("out");
  double t = 0.0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    context.SetTime(t += 1e-3);
    benchmark::DoNotOptimize(out.Eval(context)[0]);
  }
}

void BuildChain(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(MakeChain(100).get());
}

void MakeContext(benchmark::State& state) {
  const auto diagram = MakeChain(100);
  for (auto _ : state) {
    Context context = diagram->MakeContext();
    benchmark::DoNotOptimize(context.time());
  }
}

void CloneContext(benchmark::State& state) {
  const auto diagram = MakeChain(100);
  const Context original = diagram->MakeContext();
  for (auto _ : state) {
    Context copy(original);  // NOLINT(performance-unnecessary-copy-initialization): it is timed
    benchmark::DoNotOptimize(copy.time());
  }
}

BENCHMARK_CAPTURE(Chain, a7, 7)->Name("engine/a7");
BENCHMARK_CAPTURE(ChainFloor, a7, 7)->Name("engine/a7/floor");
BENCHMARK_CAPTURE(Chain, a100, 100)->Name("engine/a100");
BENCHMARK_CAPTURE(ChainFloor, a100, 100)->Name("engine/a100/floor");
BENCHMARK(Nested)->Name("engine/nested100");
BENCHMARK_CAPTURE(CacheHit, b7, 7)->Name("engine/b7");
BENCHMARK_CAPTURE(CacheHit, b100, 100)->Name("engine/b100");
BENCHMARK(TimeOnly)->Name("engine/t100");
BENCHMARK(BuildChain)->Name("engine/build");
BENCHMARK(MakeContext)->Name("engine/context");
BENCHMARK(CloneContext)->Name("engine/clone");

}  // namespace
}  // namespace oca::bench
