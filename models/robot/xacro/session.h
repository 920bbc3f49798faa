// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "oca/models/robot/xacro.h"
#include "oca/models/robot/xacro/budget.h"
#include "oca/models/robot/xacro/evaluator.h"
#include "oca/models/robot/xacro/node.h"
#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

class Scope;

/// What all of one expansion shares: arguments, files, and what it may take.
class Session {
 public:
  explicit Session(const XacroOptions& options);

  Budget& budget() { return budget_; }

  /// What a text means with its ${...} and $(...) worked out: the value itself if it is but one of
  /// these, else a text. throws Mistake
  PythonValue Evaluate(const std::string& text, Scope& scope, const SourcePlace& place);

  /// xacro.NAME(...), called from where Evaluate is at. throws Mistake
  PythonValue CallXacro(const std::string& name, const Arguments& arguments);

  /// Gives an argument its default, unless it was given; `fallback` works it out.
  template <class Fallback>
  void Declare(const std::string& name, const Fallback& fallback) {
    declared_.insert(name);
    if (!arguments_.contains(name)) arguments_[name] = fallback();
  }
  /// Refuses arguments that were given and no file has asked for. throws Mistake
  void CheckArguments() const;

  /// A path from the folder of the file that `place` is in.
  std::filesystem::path PathOf(const std::string& name, const SourcePlace& place) const;
  /// The root element of a file. throws ModelError; Mistake beyond the budget
  NodePtr Read(const std::filesystem::path& file);

  /// Tells what a file has to say.
  void Warn(const SourcePlace& place, const std::string& text) const;

 private:
  PythonValue EvaluateExpression(const std::string& text, Scope& scope, const SourcePlace& place);
  std::string Substitute(const std::string& text, Scope& scope, const SourcePlace& place);
  std::string PackageFolder(const std::string& package) const;
  const std::string& ArgumentNamed(const std::string& name);
  PythonValue LoadYaml(const std::string& name);

  const XacroOptions& options_;
  Budget budget_;
  std::map<std::string, std::string> arguments_;
  std::set<std::string> declared_;
  std::map<std::filesystem::path, NodePtr> files_;
  std::map<std::filesystem::path, PythonValue> yaml_;
  const SourcePlace* at_{nullptr};  // of the expression that is being worked out
};

}  // namespace oca::robot::xacro
