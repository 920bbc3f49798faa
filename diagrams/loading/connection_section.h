// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

#include "oca/diagrams/loading/part.h"
#include "oca/diagrams/loading/system_section.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// Section `connections` of a diagram file: connects the systems of the part in the builder, and
/// exports what comes from outside, under the name of the output there.
class ConnectionSection {
 public:
  /// From a tree whose ${...} are worked out; what is wrong is added to `problems`.
  ConnectionSection(const Value& root, const Part& part, const SystemSection& systems,
                    DiagramBuilder& builder, Problems& problems);

  /// Whether a connection leads to an input of the part, `system.port`.
  bool Drives(const std::string& input) const { return locations_.contains(input); }
  /// Where the file makes the connection that a problem of the wiring is about; nullptr if it is
  /// about none.
  const Location* LocationOf(const std::string& problem) const;

 private:
  struct PortName {
    std::string system;
    std::string port;
  };

  void Read(const Value& item);
  std::optional<PortName> SplitPort(std::string text, const Location& location);
  void Connect(const PortName& from, const PortName& to, const Location& location);
  template <class Find>
  bool Locate(const PortName& name, const Location& location, const Find& find);
  void Import(const PortName& from, const OutputHandle& output, const InputHandle& input,
              const Location& location);

  const Part& part_;
  const SystemSection& systems_;
  DiagramBuilder& builder_;
  Problems& problems_;
  std::map<std::string, std::string> imports_;  // exported inputs and the outputs they stand for
  std::map<std::string, Location> locations_;   // by input
};

}  // namespace oca::loading
