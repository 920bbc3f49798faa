// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "oca/models/robot/xacro/evaluator.h"
#include "oca/models/robot/xacro/node.h"
#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

class Session;

/// A parameter of a macro.
struct Parameter {
  std::string name;  ///< with the * or ** of a block
  bool forwards{false};
  std::optional<std::string> fallback{};  ///< a text to be worked out at the call
};

struct Macro {
  NodePtr body;
  std::vector<Parameter> parameters;
};

/// `params` of a macro: `a b:=1 c:='x y' d:=^ e:=^|2 *block **content`; `=` is `:=`.
/// throws Mistake if a name is no name
std::vector<Parameter> ParseParameters(const std::string& params);

/// Whether a property or parameter may have that name.
bool IsName(std::string_view text);

/// The properties, blocks and macros of a file or of a call. What it lacks it looks up in the scope
/// around it, which is that of the caller, as in xacro.
class Scope final : public Surroundings {
 public:
  Scope(Session& session, Scope* outer) : session_(session), outer_(outer) {}

  const PythonValue* Property(const std::string& name) override;
  Surroundings* Namespace(const std::string& name) override { return FindNamespace(name); }
  PythonValue CallXacro(const std::string& name, const Arguments& arguments) override;
  std::vector<std::string> PropertyNames() const override;

  /// A value; of a text what LiteralOf makes of it.
  void Set(const std::string& name, PythonValue value);
  /// A text that is worked out when it is first asked for, here.
  void SetLazily(const std::string& name, const std::string& text, const SourcePlace& place);
  void Remove(const std::string& name);

  /// By its name with stars.
  void SetBlock(const std::string& name, NodePtr block) { blocks_[name] = std::move(block); }
  NodePtr FindBlock(const std::string& name) const;

  void SetMacro(const std::string& name, std::shared_ptr<const Macro> macro);
  /// By its name, with namespaces before it; `home` gets the scope that its calls lie in, nullptr
  /// if that is the caller's.
  std::shared_ptr<const Macro> FindMacro(const std::string& name, Scope*& home);
  std::vector<std::string> MacroNames() const;

  Scope& AddNamespace(const std::string& name);

  Scope* outer() const { return outer_; }
  Scope& root() { return outer_ == nullptr ? *this : outer_->root(); }

 private:
  struct Entry {
    PythonValue value{};
    std::string text{};
    SourcePlace place{};
    bool lazy{false};
    bool open{false};  ///< being worked out
  };
  Scope* FindNamespace(const std::string& name);
  void Resolve(const std::string& name, Entry& entry);

  Session& session_;
  Scope* const outer_;
  std::unordered_map<std::string, Entry> properties_;
  std::unordered_map<std::string, NodePtr> blocks_;
  std::unordered_map<std::string, std::shared_ptr<const Macro>> macros_;
  std::unordered_map<std::string, std::unique_ptr<Scope>> namespaces_;
};

}  // namespace oca::robot::xacro
