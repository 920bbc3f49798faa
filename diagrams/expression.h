// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "framework/value.h"

namespace oca::diagrams {

/// Replaces `${...}` in every text of a tree.
///
/// A text that is wholly `${name}` takes the parameter's type and value; `${arithmetic}` becomes a
/// number, with comparisons and `&&`, `||`, `!` a boolean; `${c ? a : b}` the chosen branch, which
/// may be 'text'. Inside a longer text the value is written out. Parameters may use one another.
/// Besides the parameters there are `pi` and `deg` (pi/180).
class Expressions {
 public:
  /// `parameters` as written, with their own expressions still in them.
  Expressions(const Value& parameters, Problems& problems);

  /// `value` with all expressions replaced; what fails is added to the problems.
  Value Resolve(const Value& value);
  /// All parameters, resolved.
  const std::map<std::string, Value>& parameters() const { return resolved_; }

 private:
  Value ResolveText(const std::string& text, const Location& location);
  Value Evaluate(const std::string& expression, const Location& location, int depth);
  Value Arithmetic(const std::string& expression, const Location& location);
  const Value* Parameter(const std::string& name, const Location& location);

  std::map<std::string, const Value*> written_;
  std::map<std::string, Value> resolved_;
  std::map<std::string, bool> open_;  ///< parameters being resolved, to find circles
  int chain_{0};                      ///< how many are open
  Problems& problems_;
};

}  // namespace oca::diagrams
