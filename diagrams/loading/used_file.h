// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/loading/construction.h"
#include "oca/diagrams/loading/resolved_document.h"
#include "oca/diagrams/loading/system_section.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

class Assembly;

/// A diagram file that another one uses: a system of type Diagram.
class UsedFile {
 public:
  /// Reads the file that the entry names and makes its systems. What is wrong with the entry is
  /// added to `problems`, what is wrong in the file to those of the construction.
  UsedFile(const Value::Entry& entry, const Level& outer, const SystemSources& sources,
           Construction& construction, Problems& problems);
  ~UsedFile();

  /// Whether there is an assembly: the file could be read.
  bool read() const { return assembly_ != nullptr; }
  /// Whether something is wrong in the file, or in one that it uses, so that its ports may be
  /// missing; it has been reported.
  bool failed() const { return failed_; }
  const std::string& name() const { return name_; }
  const Level& level() const { return level_; }
  std::string file() const { return file_.string(); }
  const Value& given() const { return given_; }  ///< parameters, a map
  /// Those for it, and for files that it uses, with their paths in it.
  const std::vector<files::Override>& overrides() const { return overrides_; }
  const ResolvedDocument& document() const { return document_; }
  const systems::ModelSet& models() const { return models_->models(); }
  Assembly& assembly() const { return *assembly_; }
  /// The ports that it shows.
  const std::map<std::string, OutputAt>& outputs() const;
  const std::map<std::string, std::vector<InputAt>>& inputs() const;
  /// The systems of the part, their connections and the ports that it shows.
  std::unique_ptr<Diagram> Build();
  /// Tells what has been found in it since, once with what other uses have in common with it.
  void Tell(Problems& found);

 private:
  struct Entry {
    std::string file;
    Value parameters, models;  // maps
  };

  std::optional<Entry> ReadEntry(const Value::Entry& entry, const SystemSources& sources,
                                 Problems& problems) const;
  Value ReadModels(const Value& given, const files::ModelSection& there, Problems& problems) const;
  bool MayBeRead(const Value::Entry& entry, Problems& problems) const;
  void Read(const Value::Entry& entry, const Entry& given, Problems& problems);
  void RefuseOverridesOfTheRun();
  void WarnOfUnusedModels(const Value& models);

  const std::string name_;
  const std::string outer_;  // path of the file that uses it
  Construction& construction_;
  Level level_;
  std::filesystem::path file_;
  Value given_;
  std::vector<files::Override> overrides_;
  ResolvedDocument document_;
  Problems own_;
  bool failed_{false};
  std::unique_ptr<files::ModelSection> models_;
  std::unique_ptr<SystemSources> sources_;
  DiagramBuilder builder_;
  std::unique_ptr<Assembly> assembly_;
};

}  // namespace oca::loading
