// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/expander.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/robot/xml_file.h"

namespace oca::robot::xacro {
namespace {

using AttributeNames = std::initializer_list<const char*>;

const std::string& Required(const Node& node, const char* attribute) {
  const std::string* const text = node.Attribute(attribute);
  if (text == nullptr) throw Mistake(attribute, "nothing", "a text");
  return *text;
}

void CheckAttributes(const Node& node, AttributeNames known) {
  for (const auto& [name, value] : node.attributes) {
    const bool is_known = std::any_of(known.begin(), known.end(),
                                      [&name = name](const char* one) { return name == one; });
    if (!is_known) {
      throw Mistake("unknown attribute", fmt::format("'{}'", name),
                    fmt::format("one of {}", fmt::join(known, ", ")));
    }
  }
}

/// The boolean that xacro takes a condition for.
bool Truth(const PythonValue& value) {
  if (value.text() == nullptr) return value.truth();
  const PythonValue literal = LiteralOf(*value.text());
  if (literal.is_whole()) return literal.truth();
  throw Mistake("condition", Shown(value), "true, false, a number or an expression");
}

/// Of an element or attribute to write.
void CheckXmlName(std::string_view what, const std::string& name) {
  if (IsXmlName(name)) return;
  throw Mistake(what, Repr(PythonValue(name)), "a name of XML, such as 'link'");
}

}  // namespace

SourcePlace Expander::Here(const SourcePlace& place) const {
  return {place.file, place.line, place.call != nullptr ? place.call : call_};
}

std::string Expander::TextOf(const Node& node, const char* attribute, Scope& scope) const {
  return ToText(session_.Evaluate(Required(node, attribute), scope, node.place));
}

Node Expander::Expand(const NodePtr& root) {
  Scope scope(session_, nullptr);
  Node out{root->place, root->name, {}, {}, {}};
  Children(*root, scope, out);
  try {
    // After the rest, for files name the robot by an argument whose default comes below.
    Node own{root->place, root->name, {}, {}, {}};
    Attributes(*root, scope, own);
    for (auto& [name, value] : own.attributes) {
      if (out.Attribute(name) == nullptr) out.SetAttribute(name, std::move(value));
    }
    session_.CheckArguments();
  } catch (const Mistake& mistake) {
    throw models::ModelError(
        fmt::format("{}: <{}>: {}", root->place.ToString(), root->name, mistake.what()));
  }
  return out;
}

void Expander::Children(const Node& of, Scope& scope, Node& out) {
  for (const NodePtr& child : of.children) {
    if (child->name.empty()) {
      Text(*child, scope, out);
    } else {
      Element(child, scope, out);
    }
  }
}

void Expander::Text(const Node& node, Scope& scope, Node& out) {
  try {
    auto made = std::make_shared<Node>();
    made->place = Here(node.place);
    made->text = ToText(session_.Evaluate(node.text, scope, node.place));
    out.children.push_back(std::move(made));
  } catch (const Mistake& mistake) {
    throw models::ModelError(
        fmt::format("{}: text in <{}>: {}", Here(node.place).ToString(), out.name, mistake.what()));
  }
}

void Expander::Element(const NodePtr& shared, Scope& scope, Node& out) {
  static constexpr std::pair<std::string_view, Handler> kHandlers[] = {
      {"xacro:if", &Expander::Condition},
      {"xacro:unless", &Expander::Condition},
      {"xacro:insert_block", &Expander::InsertBlock},
      {"xacro:include", &Expander::Include},
      {"xacro:element", &Expander::NamedElement},
      {"xacro:attribute", &Expander::NamedAttribute},
      {"xacro:call", &Expander::DynamicCall},
  };
  const Node& node = *shared;
  try {
    const Budget::Level level(session_.budget());
    session_.budget().CountElement();
    if (!node.name.starts_with("xacro:")) return Plain(node, scope, out);
    if (node.name == "xacro:property") return DefineProperty(shared, scope);
    if (node.name == "xacro:macro") return DefineMacro(shared, scope);
    if (node.name == "xacro:arg") return Argument(node, scope);
    for (const auto& [name, handler] : kHandlers) {
      if (node.name == name) return (this->*handler)(node, scope, out);
    }
    CallMacro(node.name.substr(6), node, scope, out);
  } catch (const Mistake& mistake) {
    throw models::ModelError(
        fmt::format("{}: <{}>: {}", Here(node.place).ToString(), node.name, mistake.what()));
  }
}

void Expander::Plain(const Node& node, Scope& scope, Node& out) {
  auto made = std::make_shared<Node>();
  made->place = Here(node.place);
  made->name = node.name;
  Attributes(node, scope, *made);
  Children(node, scope, *made);
  out.children.push_back(std::move(made));
}

void Expander::Attributes(const Node& node, Scope& scope, Node& out) {
  for (const auto& [name, text] : node.attributes) {
    if (name.starts_with("xacro:") || name == "xmlns:xacro") continue;
    try {
      out.SetAttribute(name, ToText(session_.Evaluate(text, scope, node.place)));
    } catch (const Mistake& mistake) {
      throw Mistake(fmt::format("{}: {}", name, mistake.what()));
    }
  }
}

void Expander::DefineProperty(const NodePtr& shared, Scope& scope) {
  const Node& node = *shared;
  CheckAttributes(node, {"name", "value", "default", "remove", "scope", "lazy_eval"});
  const std::string name = TextOf(node, "name", scope);
  if (!IsName(name) || name.starts_with("__")) {
    throw Mistake("name", fmt::format("'{}'", name), "letters, digits and _, no digit or __ first");
  }
  const std::string *value = node.Attribute("value"), *fallback = node.Attribute("default");
  const auto flag = [&](const char* attribute, bool otherwise) {
    const std::string* const text = node.Attribute(attribute);
    return text == nullptr ? otherwise : Truth(session_.Evaluate(*text, scope, node.place));
  };
  const bool remove = flag("remove", false);
  if ((value != nullptr) + (fallback != nullptr) + (remove ? 1 : 0) > 1) {
    throw Mistake("attributes", "several of value, default and remove", "one of them");
  }
  if (remove) return scope.Remove(name);
  if (fallback != nullptr) {
    if (scope.Property(name) != nullptr) return;
    value = fallback;
  }
  const std::string* const wanted = node.Attribute("scope");
  Scope* target = &scope;
  if (wanted != nullptr && *wanted == "global") {
    target = &scope.root();
  } else if (wanted != nullptr && *wanted == "parent") {
    target = scope.outer();
    if (target == nullptr) {
      return session_.Warn(node.place, fmt::format("property '{}': scope=\"parent\" outside of a "
                                                   "macro: left out",
                                                   name));
    }
  } else if (wanted != nullptr && !wanted->empty() && *wanted != "local") {
    throw Mistake("scope", fmt::format("'{}'", *wanted), "parent or global");
  }
  if (value == nullptr) return target->SetBlock("**" + name, shared);
  session_.budget().Spend(value->size());
  if (target == &scope && flag("lazy_eval", true)) {
    return target->SetLazily(name, *value, Here(node.place));
  }
  target->Set(name, session_.Evaluate(*value, scope, node.place));
}

void Expander::DefineMacro(const NodePtr& node, Scope& scope) {
  CheckAttributes(*node, {"name", "params"});
  std::string name = Required(*node, "name");
  if (name.starts_with("xacro:")) name = name.substr(6);
  if (name.empty() || name == "call" || name.find('.') != std::string::npos) {
    throw Mistake("name", fmt::format("'{}'", name), "one without . that is not 'call'");
  }
  const std::string* const params = node->Attribute("params");
  if (params != nullptr) session_.budget().Spend(params->size());
  scope.SetMacro(name, std::make_shared<const Macro>(
                           Macro{node, ParseParameters(params == nullptr ? "" : *params)}));
}

void Expander::Argument(const Node& node, Scope& scope) {
  CheckAttributes(node, {"name", "default"});
  const std::string& name = Required(node, "name");
  session_.Declare(name, [&] {
    if (node.Attribute("default") == nullptr) {
      throw Mistake(fmt::format("argument '{}'", name), "neither a value nor a default",
                    "a value that is given");
    }
    return TextOf(node, "default", scope);
  });
}

void Expander::Condition(const Node& node, Scope& scope, Node& out) {
  CheckAttributes(node, {"value"});
  const bool holds = Truth(session_.Evaluate(Required(node, "value"), scope, node.place));
  if (holds == (node.name == "xacro:if")) Children(node, scope, out);
}

void Expander::InsertBlock(const Node& node, Scope& scope, Node& out) {
  CheckAttributes(node, {"name"});
  const std::string name = TextOf(node, "name", scope);
  if (const NodePtr content = scope.FindBlock("**" + name)) return Children(*content, scope, out);
  const NodePtr block = scope.FindBlock("*" + name);
  if (block == nullptr) {
    throw Mistake("block", fmt::format("'{}'", name),
                  "a parameter with * or a property without a value");
  }
  Element(block, scope, out);
}

void Expander::Include(const Node& node, Scope& scope, Node& out) {
  CheckAttributes(node, {"filename", "ns", "optional"});
  const std::string name = TextOf(node, "filename", scope);
  if (name.find_first_of("*?[") != std::string::npos) {
    throw Mistake("filename", fmt::format("'{}'", name), "one file");
  }
  const std::filesystem::path file = session_.PathOf(name, node.place);
  const std::string* const optional = node.Attribute("optional");
  std::error_code error;
  if (optional != nullptr && Truth(session_.Evaluate(*optional, scope, node.place)) &&
      !std::filesystem::exists(file, error)) {
    return;
  }
  Scope* inner = &scope;
  if (node.Attribute("ns") != nullptr) {
    const std::string space = TextOf(node, "ns", scope);
    if (!IsName(space)) throw Mistake("ns", fmt::format("'{}'", space), "a name");
    inner = &scope.AddNamespace(space);
  }
  NodePtr included;
  try {
    included = session_.Read(file);
  } catch (const models::ModelError& problem) {
    throw Mistake(problem.what());
  }
  Children(*included, *inner, out);
}

void Expander::NamedElement(const Node& node, Scope& scope, Node& out) {
  auto renamed = std::make_shared<Node>(node);
  renamed->name = TextOf(node, "xacro:name", scope);
  CheckXmlName("xacro:name", renamed->name);
  std::erase_if(renamed->attributes, [](const auto& one) { return one.first == "xacro:name"; });
  Element(renamed, scope, out);
}

void Expander::NamedAttribute(const Node& node, Scope& scope, Node& out) {
  CheckAttributes(node, {"name", "value"});
  const std::string name = TextOf(node, "name", scope);
  CheckXmlName("name", name);
  out.SetAttribute(name, TextOf(node, "value", scope));
}

void Expander::DynamicCall(const Node& node, Scope& scope, Node& out) {
  Node call = node;
  std::erase_if(call.attributes, [](const auto& one) { return one.first == "macro"; });
  CallMacro(TextOf(node, "macro", scope), call, scope, out);
}

}  // namespace oca::robot::xacro
