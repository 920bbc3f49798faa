// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/models/robot/xacro/node.h"
#include "oca/models/robot/xacro/scope.h"
#include "oca/models/robot/xacro/session.h"

namespace oca::robot::xacro {

/// Works through elements in their order, as xacro does: what a property or macro is, is known from
/// its definition on.
class Expander {
 public:
  explicit Expander(Session& session) : session_(session) {}

  /// The tree that a file's root element stands for. throws ModelError with the place
  Node Expand(const NodePtr& root);

 private:
  using Handler = void (Expander::*)(const Node& node, Scope& scope, Node& out);
  using CallPtr = std::shared_ptr<const Call>;

  void Children(const Node& of, Scope& scope, Node& out);
  void Element(const NodePtr& node, Scope& scope, Node& out);
  void Text(const Node& node, Scope& scope, Node& out);
  void Plain(const Node& node, Scope& scope, Node& out);
  void Attributes(const Node& node, Scope& scope, Node& out);

  void DefineProperty(const NodePtr& node, Scope& scope);
  void DefineMacro(const NodePtr& node, Scope& scope);
  void Argument(const Node& node, Scope& scope);
  void Condition(const Node& node, Scope& scope, Node& out);
  void InsertBlock(const Node& node, Scope& scope, Node& out);
  void Include(const Node& node, Scope& scope, Node& out);
  void NamedElement(const Node& node, Scope& scope, Node& out);
  void NamedAttribute(const Node& node, Scope& scope, Node& out);
  void DynamicCall(const Node& node, Scope& scope, Node& out);
  void CallMacro(const std::string& name, const Node& node, Scope& scope, Node& out);
  void Pass(const Macro& macro, const Node& node, Scope& scope, Scope& inner);
  void PassBlocks(const Macro& macro, const Node& node, Scope& scope, Scope& inner);

  SourcePlace Here(const SourcePlace& place) const;
  std::string TextOf(const Node& node, const char* attribute, Scope& scope) const;

  Session& session_;
  CallPtr call_;  // the innermost that is being expanded
};

}  // namespace oca::robot::xacro
