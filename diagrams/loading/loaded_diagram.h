// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/document.h"
#include "oca/diagrams/files/output_sections.h"
#include "oca/diagrams/files/run_params.h"
#include "oca/diagrams/sampling/scenario.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/systems/signals/model_set.h"

namespace oca::loading {

/// Everything a diagram file says, ready to run.
struct LoadedDiagram {
  struct Block {
    std::string name;  ///< its path: `left.plant` of a file that is used as `left`
    std::string type;
    Value params;  ///< as given, with ${...} worked out and paths of files resolved
    files::Catalogue::Row row;
    /// By the names in its file.
    std::shared_ptr<const systems::ModelSet> models;
  };
  /// A diagram file that another one uses: a system of type Diagram.
  struct InnerFile {
    std::string path;  ///< of the system
    std::string file;
    Value document, resolved;  ///< as below
    Value::Map given;          ///< parameters, worked out
  };

  std::string file;
  std::vector<std::filesystem::path> sources;     ///< diagram files that were read, first its own
  std::vector<std::filesystem::path> candidates;  ///< as DocumentSources has them
  std::vector<std::filesystem::path> opened;      ///< all files that it was made from
  std::vector<files::Override> overrides;         ///< that it was loaded with
  Value document;                     ///< includes merged, scenario drawn, overrides applied
  sampling::Scenario scenario;        ///< what was drawn
  Value resolved;                     ///< the same without parameters, ${...} worked out
  std::vector<std::string> warnings;  ///< a line each, with its place
  std::string name;
  std::string description;
  files::SimulatorParams simulator;
  systems::ModelSet models;  ///< by full names
  std::vector<Block> systems;
  std::vector<InnerFile> used_files;  ///< each before those that it uses itself
  std::unique_ptr<Diagram> diagram;
  std::vector<files::RecordedSignal> record;
  Period scene_period{1, 60};  ///< of the scene in a record
  std::vector<files::Expectation> expectations;
  /// Outputs of the systems that judge (systems::Judges), with the names of those.
  files::NamedOutputs metrics;

  /// The block that a system of the diagram is.
  const Block& BlockOf(const System& system) const;
};

/// Where overrides find a system, by its path: `systems.plant`, `left.systems.plant`.
std::string OverridePath(const std::string& path);

/// The systems that stand for nothing outside (systems::Boundary), by path: the part that a robot's
/// own loop runs.
std::vector<std::string> InsideOf(const Diagram& whole);

}  // namespace oca::loading
