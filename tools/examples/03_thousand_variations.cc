// SPDX-License-Identifier: BSD-3-Clause
// Many variations of a file, a thread a core:  03_thousand_variations [FILE [RUNS]]
// YAML, URDF and meshes are read once. Each run has a diagram and a Context of its own; what they
// share never changes. A file that is wrong is so for all: the first error ends it.
// `simulator sweep` does the same with statistics, shards and results on disk.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/diagrams/runs/run.h"

int main(int argc, char** argv) {
  const oca::loading::Blueprint file(argc > 1 ? argv[1] : "diagrams/scenarios/random_static.yaml");
  const int runs = argc > 2 ? std::atoi(argv[2]) : 1000;
  std::atomic<int> next{0}, met{0}, unmet{0}, failed{0};
  const auto work = [&] {
    for (int seed = next++; seed < runs; seed = next++) {
      try {
        const auto loaded = file.Build({{"simulator.seed", std::to_string(seed)}});
        const auto result = oca::runs::Run(loaded, {});
        ++(result.failure ? failed : result.ExpectationsMet() ? met : unmet);
      } catch (const std::exception& error) {
        if (next.exchange(runs) < runs) std::fprintf(stderr, "seed %d: %s\n", seed, error.what());
        ++failed;
      }
    }
  };
  std::vector<std::jthread> threads(std::thread::hardware_concurrency());
  for (std::jthread& thread : threads) thread = std::jthread(work);
  threads.clear();  // waits for them
  std::printf("%d runs: %d as expected, %d not, %d failed\n", met + unmet + failed, met.load(),
              unmet.load(), failed.load());
  return failed == 0 ? 0 : 2;
}
