// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

struct ArithmeticError;

/// What the expressions of a file came to. Who resolves the file again, with other parameters,
/// takes over what has not changed and uses no parameter that has, and shares lists and maps of it.
struct Resolution {
  /// A parameter, or a list or map with expressions in it.
  struct Part {
    std::string name{};  ///< of a parameter
    Value written{};
    Value resolved{};
    std::vector<std::size_t> used{};  ///< parameters that its own expressions name, by position
    std::size_t copied{0};            ///< size of all values that these were replaced by
    std::vector<std::shared_ptr<const Part>> inner{};  ///< lists and maps in it
  };
  using PartPtr = std::shared_ptr<const Part>;
  std::vector<PartPtr> parameters{};                          ///< in the order of their names
  std::unordered_map<const void*, PartPtr> lists_and_maps{};  ///< by what is `written`
};

/// Replaces `${...}` in every text of a tree.
///
/// A text that is wholly `${name}` takes the parameter's type and value; `${arithmetic}` becomes a
/// number, with comparisons and `&&`, `||`, `!` a boolean; `${c ? a : b}` the chosen branch, which
/// may be 'text'; `${name == 'text'}` and `!=` compare a text. Inside a longer text the value is
/// written out. Parameters may use one another. Besides the parameters there are `pi` and `deg`
/// (pi/180).
class Expressions {
 public:
  /// `parameters` as written, with their own expressions still in them; `earlier`, if given, is of
  /// the same file.
  Expressions(const Value& parameters, Problems& problems,
              std::shared_ptr<const Resolution> earlier = nullptr);

  /// `value` with all expressions replaced; what fails is added to the problems.
  Value Resolve(const Value& value);
  /// What there is to take over from this, if there were no problems.
  Resolution TakeResolution();
  /// Says that the parameter was used where no expression shows it.
  void MarkUsed(const std::string& name);
  /// Names that the tree or parameters use. Complete once everything is resolved.
  std::set<std::string> used() const;
  /// A warning for each parameter that is not used, with its place and the nearest one that is. One
  /// that is `known` elsewhere, where other parts are chosen, is no mistake, unless an override
  /// gives it: that has no effect.
  std::vector<Diagnostic> Unused(const std::set<std::string>& known = {}) const;

 private:
  struct Parameter {
    const Value::Entry* entry;
    Resolution::PartPtr part{};     ///< once it is resolved
    Resolution::PartPtr earlier{};  ///< if nothing about it has changed
    bool open{false};               ///< being resolved, to find circles
    bool used{false};
  };

  void FindUnchanged();
  bool IsUnchanged(const Resolution::Part& part) const;
  /// Takes a part over, which counts as if it were worked out again; false if that has to be.
  bool TakeOver(const Resolution::PartPtr& part);
  /// For those who take over from this.
  void Keep(const Resolution::PartPtr& part);
  /// Says that what is being worked out has this part in it.
  void Include(const Resolution::PartPtr& part);
  void CountUse(std::size_t parameter, std::size_t copied);
  Value ResolveItems(const Value& value);
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
  Parameter* Find(const std::string& name);  ///< nullptr if there is none
  std::vector<std::string> Names() const;
  const Value* ValueOf(Parameter& parameter, const Location& location);
  /// The parameter's value where an expression uses it; counts what copies of it add up to.
  const Value* Use(const std::string& name, const Location& location);

  const Value written_;
  std::shared_ptr<const Resolution> earlier_;
  std::vector<Parameter> parameters_;   ///< in the order of their names
  std::set<std::string> unknown_;       ///< names that are used and are none of them
  int chain_{0};                        ///< how many are open
  Resolution::Part* current_{nullptr};  ///< what is being worked out
  std::unordered_map<const void*, Resolution::PartPtr> lists_and_maps_;
  std::set<std::string> said_;
  std::size_t copied_{0};  ///< size of all values that expressions were replaced by
  Problems& problems_;
};

}  // namespace oca::files
