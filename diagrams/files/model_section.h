// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/framework/dataflow/value.h"
#include "oca/systems/signals/model_set.h"

namespace oca::files {

/// Sections `packages` and `models` of a diagram file, and the paths that depend on them.
class ModelSection {
 public:
  /// What a file that another one uses is given of that.
  struct Given {
    const ModelSection& outer;
    const Value* models{nullptr};  ///< a map from names here to names there; nullptr: none
    std::string path;              ///< of the use in the diagram as a whole: `left`
    /// Whether its connections take in the links of a model there, by the name there.
    std::function<bool(const std::string&)> lets_in;
  };

  /// Loads every model; what is wrong is added to `problems`.
  ModelSection(const Value& root, Problems& problems);
  /// Of a file that another one uses. Models that it is given stand for its own of these names,
  /// whose limits of acceleration and jerk are taken where the given ones have none; its others
  /// have full names below `path`. Packages that it does not name are those of the other file.
  ModelSection(const Value& root, const Given& given, Problems& problems);

  const systems::ModelSet& models() const { return models_; }
  /// Whether a model could not be loaded; its users would only repeat the problem.
  bool failed() const { return failed_; }
  /// What to know of the models that did load.
  const std::vector<Diagnostic>& warnings() const { return warnings_; }
  /// `value` with the texts of all keys named `file` made paths from where the program runs; they
  /// are written relative to the file they stand in, or as package://NAME/PATH.
  Value ResolveFiles(const Value& value, Problems& problems) const;
  /// A text that tells what ResolveFiles makes of an entry of the file, its parameters worked out,
  /// from what is made of any other that is still there.
  std::string FormOf(const Value& entry) const;

 private:
  struct Read;
  /// An entry of `models`, its files being paths.
  struct Source {
    std::string where;
    ModelParams params;
    PackageMap packages;
  };

  Value ResolveName(const Value& name, Problems& problems) const;
  void ReadPackages(const Value& root);
  void ReadModel(const Value::Entry& entry, const std::string& full_name);
  void ReadEntry(const std::string& where, Read& read) const;
  void Take(const Value::Entry& given, const Value* own, const ModelSection& outer);
  std::filesystem::path Resolve(const std::string& name, const Location& location) const;

  Problems& problems_;
  PackageMap packages_;
  std::map<std::string, Source> sources_;  // by name, of those that did load
  systems::ModelSet models_;
  std::vector<Diagnostic> warnings_;
  bool failed_{false};
};

}  // namespace oca::files
