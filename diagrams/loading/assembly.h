// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/diagrams/files/output_sections.h"
#include "oca/diagrams/loading/connection_section.h"
#include "oca/diagrams/loading/construction.h"
#include "oca/diagrams/loading/system_section.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// The systems of a diagram file and their wiring, on the way to a diagram.
class Assembly {
 public:
  /// Makes and connects the systems of a tree whose ${...} are worked out, and those of the files
  /// that it uses; what is wrong is added to `problems`. All arguments must outlive it.
  Assembly(const Value& root, const Level& level, const SystemSources& sources,
           Construction& construction, DiagramBuilder& builder, Problems& problems);

  const SystemSection& systems() const { return systems_; }
  SystemSection& systems() { return systems_; }
  const ConnectionSection& connections() const { return connections_; }
  /// The diagram as a whole, which starts where its states may be, of the file that is built; what
  /// is wrong is added to the problems, and it may be null then. If `movable`, the `offsets` of
  /// systems that hold obstacles are inputs of the diagram, where nothing drives them.
  std::unique_ptr<Diagram> Build(bool movable);
  /// The outputs of the systems that judge (systems::Judges), with the names of those.
  files::NamedOutputs Metrics();

 private:
  void ExportOffsets();

  const Value& root_;
  const Level& level_;
  Construction& construction_;
  DiagramBuilder& builder_;
  Problems& problems_;
  SystemSection systems_;
  ConnectionSection connections_;
};

}  // namespace oca::loading
