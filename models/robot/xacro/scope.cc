// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/scope.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/models/robot/xacro/session.h"

namespace oca::robot::xacro {
namespace {

constexpr std::string_view kSpaces = " \t\r\n";
constexpr std::size_t kMostParameters = 1000;
constexpr std::size_t kLongestTrail = 1000;  // bytes of a message that says how a property is used

/// The default that begins at `at`, up to a blank outside of single quotes.
std::string TakeDefault(const std::string& params, std::size_t& at) {
  const std::size_t from = at;
  bool quoted = false;
  while (at < params.size() && (quoted || kSpaces.find(params[at]) == kSpaces.npos)) {
    if (params[at] == '\'') quoted = !quoted;
    ++at;
  }
  if (quoted) throw Mistake("default of a parameter", params.substr(from), "a closing quote");
  return params.substr(from, at - from);
}

}  // namespace

bool IsName(std::string_view text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
    return letter(c) || (c >= '0' && c <= '9');
  });
}

std::vector<Parameter> ParseParameters(const std::string& params) {
  std::vector<Parameter> parameters;
  std::size_t at = params.find_first_not_of(kSpaces);
  while (at != std::string::npos) {
    const std::size_t end = std::min(params.find_first_of(" \t\r\n:=", at), params.size());
    Parameter parameter{params.substr(at, end - at)};
    const std::size_t stars = std::min(parameter.name.find_first_not_of('*'), std::size_t{2});
    if (!IsName(parameter.name.substr(std::min(stars, parameter.name.size())))) {
      throw Mistake("parameter of a macro", fmt::format("'{}'", parameter.name),
                    "a name, with * or ** before that of a block");
    }
    at = std::min(params.find_first_not_of(kSpaces, end), params.size());
    if (params.substr(at, 2) == ":=" || params.substr(at, 1) == "=") {
      const bool spaced = at > end;
      at += params[at] == ':' ? 2 : 1;
      if (spaced) at = std::min(params.find_first_not_of(kSpaces, at), params.size());
      parameter.forwards = params.substr(at, 1) == "^";
      if (parameter.forwards) at += params.substr(at, 2) == "^|" ? 2 : 1;
      std::string fallback = TakeDefault(params, at);
      if (!fallback.empty()) parameter.fallback = std::move(fallback);
    } else if (params.substr(at, 1) == ":") {
      throw Mistake("parameter of a macro", params.substr(at, 20), "NAME or NAME:=DEFAULT");
    }
    parameters.push_back(std::move(parameter));
    if (parameters.size() > kMostParameters) {
      throw Mistake("parameters of a macro", fmt::format("more than {}", kMostParameters), "fewer");
    }
    at = params.find_first_not_of(kSpaces, at);
  }
  return parameters;
}

const PythonValue* Scope::Property(const std::string& name) {
  for (Scope* at = this; at != nullptr; at = at->outer_) {
    const auto found = at->properties_.find(name);
    if (found == at->properties_.end()) continue;
    if (found->second.lazy) at->Resolve(name, found->second);
    return &found->second.value;
  }
  return nullptr;
}

void Scope::Resolve(const std::string& name, Entry& entry) {
  if (entry.open) {
    throw Mistake(fmt::format("property '{}'", name), "a value that uses itself",
                  "one made of others");
  }
  entry.open = true;
  try {
    PythonValue value = session_.Evaluate(entry.text, *this, entry.place);
    entry.value = value.text() != nullptr ? LiteralOf(*value.text()) : std::move(value);
    entry.lazy = entry.open = false;
  } catch (const Mistake& mistake) {
    entry.open = false;
    const std::string_view what = mistake.what();
    if (what.size() > kLongestTrail) throw;
    throw Mistake(fmt::format("{} (of property '{}', {})", what, name, entry.place.ToString()));
  }
}

PythonValue Scope::CallXacro(const std::string& name, const Arguments& arguments) {
  return session_.CallXacro(name, arguments);
}

std::vector<std::string> Scope::PropertyNames() const {
  std::vector<std::string> names;
  for (const Scope* at = this; at != nullptr; at = at->outer_) {
    for (const auto& entry : at->properties_) names.push_back(entry.first);
    if (names.size() > 2000) break;
  }
  std::sort(names.begin(), names.end());
  return names;
}

void Scope::Set(const std::string& name, PythonValue value) {
  if (value.text() != nullptr) value = LiteralOf(*value.text());
  properties_[name] = {std::move(value), {}, {}, false, false};
}

void Scope::SetLazily(const std::string& name, const std::string& text, const SourcePlace& place) {
  PythonValue literal = LiteralOf(text);
  const bool lazy = literal.text() != nullptr;
  properties_[name] = lazy ? Entry{{}, *literal.text(), place, true, false}
                           : Entry{std::move(literal), {}, {}, false, false};
}

void Scope::Remove(const std::string& name) { properties_.erase(name); }

NodePtr Scope::FindBlock(const std::string& name) const {
  for (const Scope* at = this; at != nullptr; at = at->outer_) {
    const auto found = at->blocks_.find(name);
    if (found != at->blocks_.end()) return found->second;
  }
  return nullptr;
}

void Scope::SetMacro(const std::string& name, std::shared_ptr<const Macro> macro) {
  macros_[name] = std::move(macro);
}

std::shared_ptr<const Macro> Scope::FindMacro(const std::string& name, Scope*& home) {
  home = nullptr;
  const std::size_t dot = name.find('.');
  if (dot != std::string::npos) {
    Scope* const space = FindNamespace(name.substr(0, dot));
    if (space == nullptr) return nullptr;
    auto macro = space->FindMacro(name.substr(dot + 1), home);
    if (home == nullptr) home = space;
    return macro;
  }
  for (Scope* at = this; at != nullptr; at = at->outer_) {
    const auto found = at->macros_.find(name);
    if (found != at->macros_.end()) return found->second;
  }
  return nullptr;
}

std::vector<std::string> Scope::MacroNames() const {
  std::vector<std::string> names;
  for (const Scope* at = this; at != nullptr; at = at->outer_) {
    for (const auto& entry : at->macros_) names.push_back(entry.first);
    for (const auto& [space, scope] : at->namespaces_) {
      for (const auto& entry : scope->macros_) names.push_back(space + "." + entry.first);
    }
    if (names.size() > 2000) break;
  }
  std::sort(names.begin(), names.end());
  return names;
}

Scope* Scope::FindNamespace(const std::string& name) {
  for (Scope* at = this; at != nullptr; at = at->outer_) {
    const auto found = at->namespaces_.find(name);
    if (found != at->namespaces_.end()) return found->second.get();
  }
  return nullptr;
}

Scope& Scope::AddNamespace(const std::string& name) {
  std::unique_ptr<Scope>& space = namespaces_[name];
  if (space == nullptr) space = std::make_unique<Scope>(session_, this);
  return *space;
}

}  // namespace oca::robot::xacro
