// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/document.h"
#include "oca/diagrams/files/output_sections.h"
#include "oca/diagrams/sampling/scenario.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/systems/signals/model_set.h"

namespace oca::loading {

/// Everything a diagram file says, ready to run.
struct LoadedDiagram {
  struct Block {
    std::string name;
    std::string type;
    Value params;  ///< as given, with ${...} worked out and paths of files resolved
    files::Catalogue::Row row;
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
  systems::ModelSet models;
  std::vector<Block> systems;
  std::unique_ptr<Diagram> diagram;
  std::vector<files::RecordedSignal> record;
  Period scene_period{1, 60};  ///< of the scene in a record
  std::vector<files::Expectation> expectations;
  /// Outputs of the systems that judge (systems::Judges), with the names of those.
  files::NamedOutputs metrics;

  /// The block that a system of the diagram is.
  const Block& BlockOf(const System& system) const;
};

/// Reads, checks and builds a diagram file.
///
/// Files are looked up relative to the file that names them; `package://NAME/` in the file's
/// `packages`, then in OCA_PACKAGE_PATH, then among the models that come with OCA.
/// `catalogue` has the types of its systems.
/// throws ConfigError with all problems of the file, a line each, `file:line:column: error: ...`.
LoadedDiagram LoadDiagram(const std::filesystem::path& file,
                          const std::vector<files::Override>& overrides = {},
                          const files::Catalogue& catalogue = files::Catalogue::Standard());

/// As LoadDiagram; obstacles can be moved: each system that holds obstacles (HoldsObstacles) whose
/// `offsets` nothing drives has them exported as `NAME_offsets`, which must be fixed before a run.
LoadedDiagram LoadMovable(const std::filesystem::path& file,
                          const std::vector<files::Override>& overrides = {},
                          const files::Catalogue& catalogue = files::Catalogue::Standard());

/// The name under which a part exports a port: `plant_position` for `plant.position`.
std::string ExportedName(std::string port);

/// The systems that stand for nothing outside (systems::Boundary), by path: the part that a robot's
/// own loop runs.
std::vector<std::string> InsideOf(const Diagram& whole);

/// The named systems of a diagram file alone, for a program that takes the place of the others, as
/// a robot's control loop does with the plant; the whole file is checked all the same.
///
/// Where a system outside drives one inside, the diagram exports an input with the name of that
/// output, `plant.position` as `plant_position`; every output inside is exported in the same way.
/// What the file records and expects is left out.
/// throws ConfigError as LoadDiagram does, and if there is no system of a name.
LoadedDiagram LoadPart(const std::filesystem::path& file, const std::vector<std::string>& systems,
                       const std::vector<files::Override>& overrides = {},
                       const files::Catalogue& catalogue = files::Catalogue::Standard());

}  // namespace oca::loading
