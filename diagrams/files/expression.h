// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

class ArithmeticError;

/// Replaces `${...}` in every text of a tree.
///
/// A text that is wholly `${name}` takes the parameter's type and value; `${arithmetic}` becomes a
/// number, with comparisons and `&&`, `||`, `!` a boolean; `${c ? a : b}` the chosen branch, which
/// may be 'text'; `${name == 'text'}` and `!=` compare a text. Inside a longer text the value is
/// written out. Parameters may use one another. Besides the parameters there are `pi` and `deg`
/// (pi/180).
class Expressions {
 public:
  /// `parameters` as written, with their own expressions still in them.
  Expressions(const Value& parameters, Problems& problems);

  /// `value` with all expressions replaced; what fails is added to the problems.
  Value Resolve(const Value& value);
  /// Says that the parameter was used where no expression shows it.
  void MarkUsed(const std::string& name) { used_.insert(name); }
  /// Parameters that the tree or other parameters use. Complete once everything is resolved.
  const std::set<std::string>& used() const { return used_; }
  /// A warning for each parameter that is not used, with its place and the nearest one that is. One
  /// that is `known` elsewhere, where other parts are chosen, is no mistake, unless an override
  /// gives it: that has no effect.
  std::vector<Diagnostic> Unused(const std::set<std::string>& known = {}) const;

 private:
  Value ResolveText(const std::string& text, const Location& location);
  Value Evaluate(const std::string& expression, const Location& location, int depth);
  /// `name == 'text'` or `!=`, either way round; nothing if the expression is no such thing.
  std::optional<Value> Comparison(const std::string& expression, const Location& location,
                                  int depth);
  Value Arithmetic(const std::string& expression, const Location& location);
  /// What a parameter is to blame for is told once, however many systems use it.
  void SayOnce(const Location& location, const std::string& what);
  void SayMistake(const std::string& expression, const ArithmeticError& error,
                  const Location& location);
  void SayNotFinite(const std::string& expression, const std::set<std::string>& names,
                    const Location& location);
  const Value* Parameter(const std::string& name, const Location& location);
  /// The parameter's value where an expression uses it; counts what copies of it add up to.
  const Value* Use(const std::string& name, const Location& location);

  std::map<std::string, const Value*> written_;  ///< to be followed in the constructor only
  std::map<std::string, Value> resolved_;
  std::map<std::string, bool> open_;  ///< parameters being resolved, to find circles
  int chain_{0};                      ///< how many are open
  std::set<std::string> used_;
  struct Place {
    Location key;
    Location value;  ///< elsewhere than the key if an override gives it
  };
  std::map<std::string, Place> places_;
  std::set<std::string> said_;
  std::size_t copied_{0};  ///< size of all values that expressions were replaced by
  Problems& problems_;
};

}  // namespace oca::files
