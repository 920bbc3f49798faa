// SPDX-License-Identifier: BSD-3-Clause
// What it saves to read a file once:  11_read_once [FILE [TIMES]]
// Loads the file, and builds it from one Blueprint, TIMES times each with another parameter.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

using Overrides = std::vector<oca::files::Override>;

/// ms of processor time a diagram, of `times` that `make` makes: whatever else the machine does.
template <class Make>
double Milliseconds(int times, const Make& make) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < times; ++i) {
    // Meshes instead of capsules, and every time the obstacle at another height.
    const std::string height = std::to_string(0.9 + 1e-4 * i);
    make(Overrides{{"parameters.arm_meshes", "true"}, {"parameters.test_obstacle_height", height}});
  }
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / times;
}

int main(int argc, char** argv) try {
  const std::string file = argc > 1 ? argv[1] : "diagrams/static_test.yaml";
  const int times = argc > 2 ? std::atoi(argv[2]) : 1000;
  const double load = Milliseconds(
      times, [&](const Overrides& overrides) { oca::loading::LoadDiagram(file, overrides); });
  const oca::loading::Blueprint blueprint(file);
  const double build =
      Milliseconds(times, [&](const Overrides& overrides) { blueprint.Build(overrides); });
  std::printf("%d loads: %.3f ms each; %d builds: %.3f ms each, 1/%.1f\n", times, load, times,
              build, load / build);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
