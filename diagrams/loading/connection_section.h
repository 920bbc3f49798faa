// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "oca/diagrams/loading/construction.h"
#include "oca/diagrams/loading/system_section.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// Whether the connections of a file take in what is for an input of this name: one leads from
/// `inputs.` to it, from the port of the file of this name, or from or to a pattern that can stand
/// for it.
bool TakesIn(const Value& root, const std::string& input);

/// Section `connections` of a diagram file: connects the systems of the part in the builder, and
/// exports what comes from outside of it, under the name of the output there.
///
/// `inputs.NAME -> system.input` and `system.output -> outputs.NAME` make the ports of the file.
/// `<x>` in a connection stands for any name: all connections are made for which both ports exist,
/// different letters being different names. One that is said again counts once.
class ConnectionSection {
 public:
  /// From a tree whose ${...} are worked out; what is wrong is added to `problems`.
  ConnectionSection(const Value& root, const Level& level, const SystemSection& systems,
                    Construction& construction, DiagramBuilder& builder, Problems& problems);

  /// The ports of the file.
  const std::map<std::string, OutputAt>& outputs() const { return outputs_; }
  const std::map<std::string, std::vector<InputAt>>& inputs() const { return inputs_; }

 private:
  void Read(const Value& item);
  void CheckShownInputs();
  std::string ReadPort(std::string_view text, const Location& location);
  void Connect(const std::string& from, const std::string& to, const Location& location);
  void ShowInput(const std::string& name, const std::string& to, const Location& location);
  void ShowOutput(const std::string& from, const std::string& name, const Location& location);
  void ConnectPorts(const OutputAt& from, const InputAt& to, const Location& location);
  void Import(const OutputAt& from, const InputAt& to, const Location& location);

  const Level& level_;
  const SystemSection& systems_;
  Construction& construction_;
  DiagramBuilder& builder_;
  Problems& problems_;
  std::unordered_set<std::string> made_;  ///< `from -> to`
  std::map<std::string, OutputAt> outputs_;
  std::map<std::string, std::vector<InputAt>> inputs_;
};

}  // namespace oca::loading
