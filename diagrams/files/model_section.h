// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/files/package_paths.h"
#include "oca/framework/dataflow/value.h"
#include "oca/systems/signals/model_set.h"

namespace oca::files {

/// Sections `packages` and `models` of a diagram file, and the paths that depend on them.
class ModelSection {
 public:
  /// Loads every model; what is wrong is added to `problems`.
  ModelSection(const Value& root, Problems& problems);

  const systems::ModelSet& models() const { return models_; }
  /// Whether a model could not be loaded; its users would only repeat the problem.
  bool failed() const { return failed_; }
  /// What to know of the models that did load, a line each, with its place.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// `value` with the texts of all keys named `file` made paths from where the program runs; they
  /// are written relative to the file they stand in, or as package://NAME/PATH.
  Value ResolveFiles(const Value& value);

 private:
  Value ResolveName(const Value& name);
  void ReadPackages(const Value& root);
  void ReadModel(const Value::Entry& entry);
  std::filesystem::path Resolve(const std::string& name, const Location& location) const;

  Problems& problems_;
  PackageMap packages_;
  systems::ModelSet models_;
  std::vector<std::string> warnings_;
  bool failed_{false};
};

}  // namespace oca::files
