// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/loading/loaded_diagram.h"
#include "oca/diagrams/record/mcap_reader.h"
#include "oca/framework/dataflow/value.h"
#include "oca/models/robot/urdf.h"

namespace oca::record {

/// throws ConfigError if it cannot be read
std::string ReadBytes(const std::filesystem::path& file);

/// Whether a relative path stays in the folder that it starts from.
bool Inside(const std::filesystem::path& name);

/// Collects the files that trees of a diagram name, as attachments of its record.
class FileCollector {
 public:
  explicit FileCollector(const loading::LoadedDiagram& loaded);

  /// Looks up packages as the file says, too.
  void AddPackagesOf(const Value& resolved);
  const files::PackageMap& packages() const { return packages_; }
  void SetPackages(files::PackageMap packages) { packages_ = std::move(packages); }

  /// The document with files named as they are attached; `resolved` is the same tree, `${...}`
  /// worked out, of which parameters are left out.
  Value Rewrite(const Value& document, const Value* resolved);
  /// What has been attached.
  std::vector<Attachment> Take();
  /// `packages` of the rewritten document.
  Value Packages() const;

 private:
  std::string Attach(const std::string& key, const Value& name, const Value& entry);
  bool Opened(const std::filesystem::path& path) const;
  std::pair<std::filesystem::path, std::string> NamesOf(const std::string& name,
                                                        const std::filesystem::path& path) const;
  std::filesystem::path PlaceOf(const std::filesystem::path& path) const;
  void AttachMeshes(const std::filesystem::path& urdf, const std::filesystem::path& path);
  std::string AttachMesh(const std::string& name, const std::filesystem::path& urdf,
                         const std::filesystem::path& path);
  void AttachXacro(const std::string& name, const std::filesystem::path& path, const Value& entry);
  void AttachAt(const std::filesystem::path& as, const std::filesystem::path& path);
  robot::LoadOptions OptionsOfRobot() const;

  const std::filesystem::path base_;
  const std::set<std::filesystem::path> opened_;
  files::PackageMap packages_;
  std::map<std::string, std::string> files_;  ///< by name of the attachment
};

}  // namespace oca::record
