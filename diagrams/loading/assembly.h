// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/files/output_sections.h"
#include "oca/diagrams/loading/connection_section.h"
#include "oca/diagrams/loading/part.h"
#include "oca/diagrams/loading/system_section.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// The systems of a diagram file and their wiring, on the way to a diagram.
class Assembly {
 public:
  /// Makes and connects the systems of a tree whose ${...} are worked out; what is wrong is added to
  /// `problems`. All arguments must outlive it.
  Assembly(const Value& root, const Part& part, const files::Catalogue& catalogue,
           files::ModelSection& models, Problems& problems);

  const SystemSection& systems() const { return systems_; }
  /// The diagram, which starts where its states may be; what is wrong is added to the problems, and
  /// it may be null then. If `movable`, the `offsets` of systems that hold obstacles are inputs of
  /// the diagram, where nothing drives them.
  std::unique_ptr<Diagram> Build(bool movable);
  /// The outputs of the systems that judge (systems::Judges), with the names of those.
  files::NamedOutputs Metrics();

 private:
  void ExportOutputs();
  void ExportOffsets();
  /// Where in the file a wiring problem lies: its connection, else its system.
  Location Place(const std::string& problem) const;

  const Value& root_;
  const Part& part_;
  Problems& problems_;
  DiagramBuilder builder_;
  SystemSection systems_;
  ConnectionSection connections_;
};

}  // namespace oca::loading
