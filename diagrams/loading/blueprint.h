// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/document.h"
#include "oca/diagrams/loading/loaded_diagram.h"

namespace oca::models {
class FileCache;
}

namespace oca::loading {

class EarlierResolutions;

/// Which diagram is to be built of a file, beside its parameters.
struct BuildOptions {
  /// The named systems alone, by path, and all in a used file that is named, for a program that
  /// takes the place of the others, as a robot's control loop does with the plant; the whole file
  /// is checked all the same. Every port keeps its path: where a system outside drives one inside,
  /// the diagram has an input with the path of that output, `plant.position`. What the file records
  /// and expects is left out. Without it, all systems.
  std::optional<std::vector<std::string>> part{};
  /// Obstacles can be moved: each system that holds obstacles (HoldsObstacles) whose `offsets`
  /// nothing drives has them exported as `NAME.offsets`, which must be fixed before a run.
  bool movable{false};
};

/// A diagram file that is read once and built many times, from any number of threads:
///
///     const Blueprint blueprint("diagrams/static_test.yaml");
///     for (int seed = 0; seed < 1000; ++seed) {
///       const auto loaded = blueprint.Build({{"simulator.seed", std::to_string(seed)}});
///       ...
///     }
///
/// Making one reads nothing: a file is read by the first Build that needs it. What is wrong with it
/// each Build says anew, by a ConfigError: whoever builds many stops at the first. What was read
/// the Blueprint holds from then on as it was read, whatever becomes of it on disk, and the Builds
/// that follow share what was made of it, all of it immutable: the text of diagram files, robots,
/// hulls and other convex parts of meshes, clouds, maps, tables of points. So a Build reads only
/// what its overrides bring in: another file, or a mesh at another scale. An entry of the file
/// whose expressions use no parameter that has changed since the last Build is not looked into
/// again. A robot is made again, of what was read, if its entry under `models` is another; if only
/// its base_pose is, it is placed again.
///
/// Copies share what was read. What a Build gives, and what it refuses, is what LoadDiagram would:
/// problems with their places, warnings, files, drawn scenario and every number.
class Blueprint {
 public:
  /// `catalogue` has the types of its systems.
  explicit Blueprint(std::filesystem::path file,
                     files::Catalogue catalogue = files::Catalogue::Standard());

  const std::filesystem::path& file() const { return file_; }

  /// The diagram with these parameters.
  /// throws ConfigError with all problems of the file, a line each, `file:line:column: error: ...`,
  /// and if there is no system of a name in `part`, or no name
  LoadedDiagram Build(const std::vector<files::Override>& overrides = {},
                      const BuildOptions& options = {}) const;

 private:
  std::filesystem::path file_;
  files::Catalogue catalogue_;
  std::shared_ptr<models::FileCache> read_;
  std::shared_ptr<EarlierResolutions> earlier_;
};

}  // namespace oca::loading
