// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagrams/diagram_file.h"
#include "diagrams/document.h"
#include "framework/diagram.h"
#include "framework/period.h"
#include "systems/model_set.h"

namespace oca::diagrams {

/// A signal to record. `name` is `system.output`.
struct RecordedSignal {
  std::string name;
  OutputHandle output;
  Period period;
};

/// A bound from section `expect`. What it looks at is an element of a Vector output (`index`), or a
/// member of another output's JSON object (`member`).
struct Expectation {
  std::string name;
  OutputHandle output;
  int index{-1};
  std::string member;
  ExpectParams bound;
};

/// Everything a diagram file says, ready to run.
struct LoadedDiagram {
  struct Block {
    std::string name;
    std::string type;
  };

  std::string file;
  std::string name;
  std::string description;
  SimulatorParams simulator;
  IntegratorOptions integrator;
  systems::ModelSet models;
  std::vector<Block> systems;
  std::unique_ptr<Diagram> diagram;
  std::vector<RecordedSignal> record;
  std::vector<Expectation> expectations;
  /// Outputs of type MotionMetrics, with the names of their systems.
  std::vector<std::pair<std::string, OutputHandle>> metrics;
};

/// Reads, checks and builds a diagram file.
///
/// Files are looked up relative to the file that names them; `package://NAME/` in the file's
/// `packages`, then in OCA_PACKAGE_PATH, then among the models that come with OCA.
/// throws ConfigError with all problems of the file, a line each, `file:line:column: error: ...`.
LoadedDiagram LoadDiagram(const std::filesystem::path& file,
                          const std::vector<Override>& overrides = {});

}  // namespace oca::diagrams
