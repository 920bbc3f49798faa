// SPDX-License-Identifier: BSD-3-Clause
// The half of Expander that calls macros.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "oca/models/nearest_name.h"
#include "oca/models/robot/xacro/expander.h"

namespace oca::robot::xacro {

void Expander::CallMacro(const std::string& name, const Node& node, Scope& scope, Node& out) {
  Scope* home = nullptr;
  const std::shared_ptr<const Macro> macro = scope.FindMacro(name, home);
  if (macro == nullptr) {
    const std::string nearest = models::NearestName(name, scope.MacroNames());
    throw Mistake("unknown macro", fmt::format("'{}'", name),
                  nearest.empty()
                      ? "one that is defined before"
                      : fmt::format("one that is defined before, such as '{}'", nearest));
  }
  Scope inner(session_, home != nullptr ? home : &scope);
  Pass(*macro, node, scope, inner);
  PassBlocks(*macro, node, scope, inner);
  const CallPtr outer = std::exchange(call_, std::make_shared<const Call>(Call{Here(node.place)}));
  try {
    Children(*macro->body, inner, out);
  } catch (...) {
    call_ = outer;
    throw;
  }
  call_ = outer;
}

/// Attributes, then defaults, of parameters that are no blocks.
void Expander::Pass(const Macro& macro, const Node& node, Scope& scope, Scope& inner) {
  for (const auto& [name, text] : node.attributes) {
    const bool known =
        std::any_of(macro.parameters.begin(), macro.parameters.end(),
                    [&name = name](const Parameter& one) { return one.name == name; });
    if (!known) {
      std::vector<std::string> names;
      for (const Parameter& one : macro.parameters) names.push_back(one.name);
      throw Mistake("unknown parameter", fmt::format("'{}'", name),
                    names.empty() ? "none" : fmt::format("one of {}", fmt::join(names, ", ")));
    }
    try {
      inner.Set(name, session_.Evaluate(text, scope, node.place));
    } catch (const Mistake& mistake) {
      throw Mistake(fmt::format("{}: {}", name, mistake.what()));
    }
  }
  std::vector<std::string> missing;
  for (const Parameter& one : macro.parameters) {
    if (one.name.starts_with('*') || node.Attribute(one.name) != nullptr) continue;
    const PythonValue* const forwarded = one.forwards ? scope.Property(one.name) : nullptr;
    if (forwarded != nullptr) {
      inner.Set(one.name, *forwarded);
    } else if (one.fallback) {
      inner.Set(one.name, session_.Evaluate(*one.fallback, scope, macro.body->place));
    } else {
      missing.push_back(one.name);
    }
  }
  if (!missing.empty()) {
    throw Mistake("parameters", fmt::format("nothing for {}", fmt::join(missing, ", ")),
                  "a value for each");
  }
}

/// The elements in the call, which are expanded where it stands, in the order of the parameters.
void Expander::PassBlocks(const Macro& macro, const Node& node, Scope& scope, Scope& inner) {
  Node given{node.place, node.name, {}, {}, {}};
  Children(node, scope, given);
  std::erase_if(given.children, [](const NodePtr& child) { return child->name.empty(); });
  std::size_t used = 0;
  for (const Parameter& one : macro.parameters) {
    if (!one.name.starts_with('*')) continue;
    if (used >= given.children.size()) {
      throw Mistake("blocks", fmt::format("{}", given.children.size()),
                    fmt::format("one for {}", one.name));
    }
    inner.SetBlock(one.name, given.children[used++]);
  }
  if (used < given.children.size()) {
    throw Mistake("blocks", fmt::format("<{}> too many", given.children[used]->name),
                  fmt::format("{}", used));
  }
}

}  // namespace oca::robot::xacro
