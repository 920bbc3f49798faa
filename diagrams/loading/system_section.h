// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/files/output_sections.h"
#include "oca/diagrams/loading/loaded_diagram.h"
#include "oca/diagrams/loading/part.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// Section `systems` of a diagram file: makes all of them, and adds those of the part to the
/// builder.
class SystemSection {
 public:
  /// From a tree whose ${...} are worked out; what is wrong is added to `problems`. Those outside
  /// of the part live as long as this.
  SystemSection(const Value& root, const Part& part, const files::Catalogue& catalogue,
                files::ModelSection& models, DiagramBuilder& builder, Problems& problems);

  /// Those that the file names, made or not.
  const std::vector<std::string>& names() const { return names_; }
  bool Names(const std::string& name) const;
  /// One that could be made, in the part or outside; nullptr if there is none.
  const System* Find(const std::string& name) const;
  /// Where the file names one that could be made; nullptr if there is none.
  const Location* LocationOf(const std::string& name) const;
  /// Those of the part.
  const std::vector<LoadedDiagram::Block>& blocks() const { return blocks_; }
  /// What they have to say (systems::Remarks), a line each, with its place.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// All outputs of the part.
  files::NamedOutputs Outputs() const;

 private:
  struct Made {
    const System* system;
    Location location;
  };

  const Value::Map& Entries() const;
  void Read(const Value::Entry& entry);
  /// The type that an entry names; nullptr if it names none.
  const Value* TypeOf(const Value::Entry& entry, const std::string& where);
  void Make(const Value::Entry& entry, const Value& type, const std::string& where);
  void KeepWarnings(const System& system, const std::string& where, const Location& location);

  const Value& root_;
  const Part& part_;
  const files::Catalogue& catalogue_;
  files::ModelSection& models_;
  DiagramBuilder& builder_;
  Problems& problems_;
  std::vector<std::string> names_;
  std::map<std::string, Made> made_;
  std::vector<std::unique_ptr<System>> outside_;  // of the part
  std::vector<LoadedDiagram::Block> blocks_;
  std::vector<std::string> warnings_;
};

}  // namespace oca::loading
