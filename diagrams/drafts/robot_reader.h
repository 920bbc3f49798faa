// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "oca/diagrams/drafts/draft.h"
#include "oca/models/robot/urdf.h"

namespace oca::drafts::internal {

/// Loads the robot of a draft, in several ways. Packages that its description names are looked for
/// where OCA knows them, then above and beside its file.
class RobotReader {
 public:
  explicit RobotReader(const DraftOptions& options) : options_(options) {}

  /// `tell`: with the warnings.
  robot::RobotModel Read(robot::LoadOptions how, bool tell);
  /// Where a package is; empty: nowhere.
  std::filesystem::path FindPackage(const std::string& package);
  /// The packages that OCA does not know, as far as they were asked for.
  const std::map<std::string, std::filesystem::path>& packages() const { return packages_; }

 private:
  const DraftOptions& options_;
  std::map<std::string, std::filesystem::path> packages_;
};

/// throws ConfigError if parts/ has no method of avoidance of the name that `options` has
void CheckAvoidance(const DraftOptions& options);
/// throws ConfigError if a file is there already
void CheckAbsent(const std::filesystem::path& file);

}  // namespace oca::drafts::internal
