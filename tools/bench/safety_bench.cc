// SPDX-License-Identifier: BSD-3-Clause
//
// Rows safety/qp/VARIABLES/ROWS/GUESS: one solve of a safety filter's problem, over a sequence that
// changes from tick to tick like that of a moving arm; GUESS 1 starts from the last active rows.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "oca/models/qp/projection_solver.h"
#include "tools/bench/allocation_counter.h"

namespace oca::bench {
namespace {

/// Problem number `tick`: smooth in time, with a few rows active at each.
void FillProblem(double tick, qp::ProjectionQp& qp) {
  const int n = qp.num_variables();
  for (int j = 0; j < n; ++j) {
    qp.wish[j] = 0.6 * std::sin(0.010 * tick + j);
    qp.lower[j] = -0.9 - 0.2 * std::sin(0.003 * tick + 2 * j);
    qp.upper[j] = 0.9 + 0.2 * std::cos(0.004 * tick + 3 * j);
  }
  for (int i = 0; i < qp.num_rows; ++i) {
    for (int j = 0; j < n; ++j) qp.rows(i, j) = std::sin(1.7 * i + 2.3 * j * i + 0.005 * tick + j);
    qp.bounds[i] = -0.9 - 0.6 * std::sin(0.9 * i + 0.007 * tick);
    qp.penalties[i] = 1e4;
  }
}

void SolveQp(benchmark::State& state) {
  constexpr int kProblems = 500;
  const int n = static_cast<int>(state.range(0));
  const int m = static_cast<int>(state.range(1));
  std::vector<qp::ProjectionQp> problems(kProblems, qp::ProjectionQp(n, m));
  for (int k = 0; k < kProblems; ++k) {
    problems[k].num_rows = m;
    FillProblem(k, problems[k]);
  }
  qp::ProjectionSolver solver(n, m);
  qp::QpSolution solution(problems[0]);
  std::vector<double> times;
  times.reserve(10'000'000);
  double iterations = 0.0;
  double active = 0.0;
  std::size_t k = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    k = k + 1 == problems.size() ? 0 : k + 1;
    if (state.range(2) == 0) solution.active.clear();
    const auto start = std::chrono::steady_clock::now();
    solver.Solve(problems[k], solution);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (times.size() < times.capacity()) times.push_back(time.count());
    iterations += solution.iterations;
    active += static_cast<double>(solution.active.size());
  }
  std::sort(times.begin(), times.end());
  state.counters["p50_us"] = 1e6 * times[times.size() / 2];
  state.counters["p99_us"] = 1e6 * times[times.size() * 99 / 100];
  state.counters["max_us"] = 1e6 * times.back();
  const auto count = static_cast<double>(state.iterations());
  state.counters["iterations"] = iterations / count;
  state.counters["active"] = active / count;
}
BENCHMARK(SolveQp)
    ->Name("safety/qp")
    ->Args({7, 50, 0})
    ->Args({7, 50, 1})
    ->Args({7, 400, 0})
    ->Args({7, 400, 1})
    ->Args({20, 500, 1});

}  // namespace
}  // namespace oca::bench
