// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/connection_pattern.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <string_view>

namespace oca::loading {
namespace {

using Names = std::map<std::string, std::string>;  // what each place stands for

bool IsNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Length of the place that a pattern begins with, `<x>`; 0 if it begins with none.
std::size_t PlaceAt(std::string_view pattern) {
  if (pattern.empty() || pattern.front() != '<') return 0;
  const std::size_t close = pattern.find('>');
  return close == std::string_view::npos || close == 1 ? 0 : close + 1;
}

/// What a pattern begins with before its next place.
std::string_view LiteralOf(std::string_view pattern) {
  if (PlaceAt(pattern) > 0) return {};
  return pattern.substr(0, pattern.find('<', 1));
}

/// Calls found() with each way in which names make the pattern the text.
void Match(std::string_view pattern, std::string_view text, Names& names,
           const std::function<void()>& found) {
  const std::size_t place = PlaceAt(pattern);
  if (place == 0) {
    const std::string_view literal = LiteralOf(pattern);
    if (pattern.empty()) {
      if (text.empty()) found();
    } else if (text.starts_with(literal)) {
      Match(pattern.substr(literal.size()), text.substr(literal.size()), names, found);
    }
    return;
  }
  const std::string key(pattern.substr(0, place));
  const std::string_view rest = pattern.substr(place);
  if (const auto known = names.find(key); known != names.end()) {
    if (text.starts_with(known->second)) {
      Match(rest, text.substr(known->second.size()), names, found);
    }
    return;
  }
  for (std::size_t end = 1; end <= text.size() && IsNameCharacter(text[end - 1]); ++end) {
    if (!text.substr(end).starts_with(LiteralOf(rest))) continue;
    const std::string name(text.substr(0, end));
    const bool taken = std::any_of(names.begin(), names.end(),
                                   [&](const auto& other) { return other.second == name; });
    if (taken) continue;
    names[key] = name;
    Match(rest, text.substr(end), names, found);
    names.erase(key);
  }
}

std::string Filled(std::string_view pattern, const Names& names) {
  std::string text;
  while (!pattern.empty()) {
    const std::size_t place = PlaceAt(pattern);
    const auto known = names.find(std::string(pattern.substr(0, place)));
    if (place > 0 && known != names.end()) {
      text += known->second;
      pattern.remove_prefix(place);
    } else {
      text += pattern.front();
      pattern.remove_prefix(1);
    }
  }
  return text;
}

}  // namespace

bool IsPattern(const std::string& port) {
  for (std::size_t i = port.find('<'); i < port.size(); i = port.find('<', i + 1)) {
    if (PlaceAt(std::string_view(port).substr(i)) > 0) return true;
  }
  return false;
}

bool IsAmbiguous(const std::string& port) {
  if (port.find('<') == std::string::npos) return false;  // as most
  bool separated = true;
  for (std::string_view rest = port; !rest.empty();) {
    const std::size_t place = PlaceAt(rest);
    if (place > 0 && !separated) return true;
    separated = place == 0 && (separated || !IsNameCharacter(rest.front()));
    rest.remove_prefix(std::max<std::size_t>(place, 1));
  }
  return false;
}

std::vector<std::pair<std::string, std::string>> MatchConnections(
    const std::string& from, const std::string& to, const std::vector<std::string>& outputs,
    const std::vector<std::string>& inputs) {
  std::vector<std::pair<std::string, std::string>> found;
  Names names;
  const auto keep = [&] { found.emplace_back(Filled(from, names), Filled(to, names)); };
  const auto match_inputs = [&] {
    if (to.starts_with(kOutputs)) return keep();
    for (const std::string& input : inputs) Match(to, input, names, keep);
  };
  if (from.starts_with(kInputs)) {
    match_inputs();
  } else {
    for (const std::string& output : outputs) Match(from, output, names, match_inputs);
  }
  std::erase_if(found,
                [](const auto& one) { return IsPattern(one.first) || IsPattern(one.second); });
  return found;
}

}  // namespace oca::loading
