// SPDX-License-Identifier: BSD-3-Clause
// Loads and runs the diagram named on the command line; succeeds if it keeps its expectations.
#include <cstdio>
#include <exception>

#include "diagrams/run.h"

int main(int argc, char** argv) {
  try {
    const auto loaded = oca::diagrams::LoadDiagram(argc > 1 ? argv[1] : "");
    return oca::diagrams::Run(loaded, {}).ExpectationsMet() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
