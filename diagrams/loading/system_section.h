// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/files/output_sections.h"
#include "oca/diagrams/files/override.h"
#include "oca/diagrams/loading/construction.h"
#include "oca/diagrams/loading/loaded_diagram.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

class UsedFile;

/// What the systems of a file are made from, beside the file.
struct SystemSources {
  files::ModelSection& models;
  /// Of the files that it uses, by the names of the systems that they are.
  const std::map<std::string, std::vector<files::Override>>& inner_overrides;
  /// Sections `systems` of the files that use this one.
  Value::Map outer_systems{};
};

/// Section `systems` of a diagram file: makes all of them, and adds those of the part to the
/// builder. Files that it uses are read, made and added on the way.
class SystemSection {
 public:
  /// From a tree whose ${...} are worked out; what is wrong is added to `problems`. Those outside
  /// of the part live as long as this.
  SystemSection(const Value& root, const Level& level, const SystemSources& sources,
                Construction& construction, DiagramBuilder& builder, Problems& problems);
  ~SystemSection();

  /// Those that the file names, made or not, and those of files that it uses: `left`, `left.plant`.
  const std::vector<std::string>& names() const { return names_; }
  bool Names(const std::string& name) const;
  /// Whether all that the file names could be made; what could not has been reported.
  bool complete() const { return made_.size() == Entries().size(); }
  /// Those of the part, in order; of files that it uses too, with their paths in this file.
  struct Built {
    std::string name;
    const System* system;
  };
  const std::vector<Built>& built() const { return built_; }
  /// The same, as they came to be; of this file and, through blocks(), of those that it uses.
  std::vector<LoadedDiagram::Block> TakeBlocks() { return std::move(blocks_); }
  const std::vector<std::unique_ptr<UsedFile>>& used_files() const { return used_; }
  /// All outputs of the part, `system.output`.
  files::NamedOutputs Outputs() const;
  /// Those that files which it uses give a name, `left.position`.
  files::NamedOutputs NamedByUsedFiles() const;

  /// A port by `system.port`; `system` may be a file that this one uses, all outputs of which are
  /// to be had by their paths in it. None if the system could not be made, which has been reported.
  /// throw WiringError if there is no such port.
  std::optional<OutputAt> FindOutput(const std::string& path) const;
  std::optional<std::vector<InputAt>> FindInputs(const std::string& path) const;
  /// Of a diagram whose sizes do not fit: adds a problem for each system that says another number
  /// of joints than its robot has, where it says so. Returns whether there is one.
  bool TellWrongCounts(Problems& problems) const;
  /// All that systems and used files have, as `system.port`.
  std::vector<std::string> OutputNames() const;
  std::vector<std::string> InputNames() const;

 private:
  struct Made {  // what could be made and is in its builder, or outside of the part
    const System* system{nullptr};  // or
    const UsedFile* file{nullptr};
    bool built{false};  // a system of the part
  };

  struct ReadEntry;

  const Value::Map& Entries() const;
  void Read(const Value::Entry& entry);
  /// The type that an entry names; nullptr if it names none.
  const Value* TypeOf(const Value::Entry& entry, const std::string& where);
  ReadEntry ReadParams(const Value& entry, const files::CatalogueRow& row,
                       const std::string& where) const;
  void Make(const Value::Entry& entry, const Value& type, const std::string& where);
  void Use(const Value::Entry& entry);
  /// The robot that an entry names, or the only one; nullptr if there is not one.
  std::shared_ptr<const robot::RobotModel> ModelOf(const Value& entry) const;
  void KeepWarnings(const System& system, const std::string& where, const Location& location);
  /// What the first name of a path leads to.
  struct Followed {
    std::string name;
    const Made* made;  ///< nullptr: it could not be made
    std::string rest;  ///< of the path
  };
  Followed Follow(const std::string& path) const;

  const Value& root_;
  const Level& level_;
  const SystemSources& sources_;
  const std::shared_ptr<const systems::ModelSet> models_;
  Construction& construction_;
  DiagramBuilder& builder_;
  Problems& problems_;
  std::vector<std::string> names_;
  std::map<std::string, Made> made_;
  std::vector<std::unique_ptr<System>> outside_;  // of the part
  std::vector<std::unique_ptr<UsedFile>> used_;
  std::vector<Built> built_;
  std::vector<LoadedDiagram::Block> blocks_;
};

}  // namespace oca::loading
