// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/port_access.h"
#include "tools/bench/engine_blocks.h"

namespace oca::bench {

/// A chain of `n` trivial blocks, its input exported as `in`, its last output as `out`.
inline std::unique_ptr<Diagram> MakeChain(int n) {
  DiagramBuilder builder;
  const Trivial* last = nullptr;
  for (int i = 0; i < n; ++i) {
    const auto& block = builder.Add<Trivial>("block" + std::to_string(i));
    if (last == nullptr) {
      builder.ExportInput("in", block.in);
    } else {
      builder.Connect(last->out, block.in);
    }
    last = &block;
  }
  builder.ExportOutput("out", last->out);
  return builder.Build();
}

/// The same, halved `depth` times into diagrams inside diagrams.
inline std::unique_ptr<Diagram> MakeNestedChain(int n, int depth) {
  if (depth == 0) return MakeChain(n);
  DiagramBuilder builder;
  const System& first = builder.AddSystem("first", MakeNestedChain(n / 2, depth - 1));
  const System& second = builder.AddSystem("second", MakeNestedChain(n - n / 2, depth - 1));
  builder.ConnectPorts(first.FindOutput("out"), second.FindInput("in"));
  builder.ExportInput("in", first.FindInput("in"));
  builder.ExportOutput("out", second.FindOutput("out"));
  return builder.Build();
}

}  // namespace oca::bench
