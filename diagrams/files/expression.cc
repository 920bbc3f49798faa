// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "oca/diagrams/files/arithmetic.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::files {
namespace {

constexpr std::size_t kLargestCopies = 100000;
constexpr int kDeepestTerm = 32;
constexpr std::size_t kLongest = 1000;
constexpr int kLongestChain = 100;

std::string Trim(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool IsQuoted(const std::string& text) {
  return text.size() >= 2 && text.front() == '\'' && text.find('\'', 1) == text.size() - 1;
}

/// Position of `c` outside of parentheses, quotes and nested ternaries; npos if there is none.
std::size_t FindTop(const std::string& text, char c, std::size_t from = 0) {
  int depth = 0, ternaries = 0;
  bool quoted = false;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted;
    if (quoted) continue;
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (depth != 0) continue;
    if (text[i] == c && ternaries == 0) return i;
    if (text[i] == '?') ++ternaries;
    if (text[i] == ':') --ternaries;
  }
  return std::string::npos;
}

/// `(...)` whose first parenthesis closes at its end.
bool IsParenthesised(const std::string& text) {
  if (text.size() < 2 || text.front() != '(' || text.back() != ')') return false;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted;
    if (quoted) continue;
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return false;
  }
  return true;
}

bool IsLogical(const std::string& expression) {
  int depth = 0;
  for (std::size_t i = 0; i < expression.size(); ++i) {
    if (expression[i] == '(') ++depth;
    if (expression[i] == ')') --depth;
    if (depth == 0 && std::string_view("<>=!&|").find(expression[i]) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

/// Values in a tree; a text counts for every 16 characters.
std::size_t SizeOf(const Value& value) {
  std::size_t size = 1;
  if (value.string() != nullptr) size += value.string()->size() / 16;
  if (value.list() != nullptr) {
    for (const Value& item : *value.list()) size += SizeOf(item);
  }
  if (value.map() != nullptr) {
    for (const Value::Entry& entry : *value.map()) size += SizeOf(entry.value);
  }
  return size;
}

std::string Text(const Value& value) {
  if (value.string() != nullptr) return *value.string();
  double number = 0.0;
  if (value.number(number)) return fmt::format("{}", number);
  return value.Show();
}

bool HasExpression(const Value& value) {
  return value.string() != nullptr && value.string()->find("${") != std::string::npos;
}

/// Whether what an expression may stand in came out as it was.
bool Unchanged(const Value& value, const Value& resolved) {
  if (value.list() != nullptr || value.map() != nullptr) return resolved.Shares(value);
  return !HasExpression(value);
}

}  // namespace

Expressions::Expressions(const Value& parameters, Problems& problems) : problems_(problems) {
  if (parameters.map() == nullptr) return;
  for (const Value::Entry& entry : *parameters.map()) {
    if (!IsName(entry.key) || IsReserved(entry.key)) {
      problems_.Add(entry.location, fmt::format("parameters.{}: not a free name; expected letters, "
                                                "digits and underscores, not pi, deg or a function",
                                                entry.key));
      continue;
    }
    written_[entry.key] = &entry.value;
    places_[entry.key] = {entry.location, entry.value.location()};
  }
  for (const auto& [name, value] : written_) Parameter(name, value->location());
}

const Value* Expressions::Parameter(const std::string& name, const Location& location) {
  if (const auto found = resolved_.find(name); found != resolved_.end()) return &found->second;
  const auto written = written_.find(name);
  if (written == written_.end()) {
    std::vector<std::string> names{"pi", "deg"};
    for (const auto& entry : written_) names.push_back(entry.first);
    problems_.Add(location,
                  fmt::format("${{...}}: unknown parameter '{}'{}", name, DidYouMean(name, names)));
    return nullptr;
  }
  if (std::exchange(open_[name], true)) {
    problems_.Add(location, fmt::format("parameters.{}: defined by itself", name));
    return nullptr;
  }
  if (++chain_ > kLongestChain) {
    problems_.Add(location, fmt::format("parameters.{}: defined through more than {} others", name,
                                        kLongestChain));
  }
  Value value = chain_ > kLongestChain ? Value({}, location) : Resolve(*written->second);
  --chain_;
  open_[name] = false;
  return &resolved_.insert_or_assign(name, std::move(value)).first->second;
}

const Value* Expressions::Use(const std::string& name, const Location& location) {
  used_.insert(name);
  const Value* const value = Parameter(name, location);
  if (value == nullptr || copied_ > kLargestCopies) return nullptr;
  copied_ += SizeOf(*value);
  if (copied_ <= kLargestCopies) return value;
  problems_.Add(location, fmt::format("${{{}}}: parameters that use parameters add up to more than "
                                      "{} values",
                                      name, kLargestCopies));
  return nullptr;
}

std::vector<Diagnostic> Expressions::Unused(const std::set<std::string>& known) const {
  std::vector<Diagnostic> warnings;
  std::vector<std::string> used(used_.begin(), used_.end());
  used.insert(used.end(), known.begin(), known.end());
  for (const auto& [name, place] : places_) {
    if (used_.contains(name)) continue;
    Location at = place.key;
    std::string what =
        fmt::format("parameters.{}: nothing uses it{}", name, DidYouMean(name, used));
    if (known.contains(name)) {
      const auto& source = place.value.file;
      if (!source || !source->starts_with("-s ")) continue;
      at = {source, 0, 0};
      what = "nothing uses it with the parts that are chosen";
    }
    warnings.push_back({at, what, Diagnostic::Kind::kWarning});
  }
  return warnings;
}

Value Expressions::Resolve(const Value& value) {
  Value resolved = value;  // shared, until something in it is an expression
  if (const Value::List* const list = value.list()) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      Value item = Resolve((*list)[i]);
      if (!Unchanged((*list)[i], item)) (*resolved.list())[i] = std::move(item);
    }
  } else if (const Value::Map* const map = value.map()) {
    for (std::size_t i = 0; i < map->size(); ++i) {
      Value item = Resolve((*map)[i].value);
      if (!Unchanged((*map)[i].value, item)) (*resolved.map())[i].value = std::move(item);
    }
  } else if (HasExpression(value)) {
    return ResolveText(*value.string(), value.location());
  }
  return resolved;
}

Value Expressions::ResolveText(const std::string& text, const Location& location) {
  std::string result;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = text.find("${", at);
    if (open == std::string::npos) break;
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) {
      problems_.Add(location,
                    fmt::format("got '{}'; expected a closing }}", text.substr(open, 40)));
      return Value({}, location);
    }
    Value value = Evaluate(Trim(text.substr(open + 2, close - open - 2)), location, 0);
    if (open == 0 && close + 1 == text.size()) return value;
    if (value.list() != nullptr || value.map() != nullptr) {
      problems_.Add(location, "a list or map inside a text; expected a number or text");
    }
    result += text.substr(at, open - at) + Text(value);
    at = close + 1;
  }
  return Value(result + text.substr(at), location);
}

Value Expressions::Evaluate(const std::string& expression, const Location& location, int depth) {
  if (depth > kDeepestTerm || expression.size() > kLongest) {
    problems_.Add(location, "${...}: too long or nested too deep");
    return Value({}, location);
  }
  if (IsParenthesised(expression)) {
    return Evaluate(Trim(expression.substr(1, expression.size() - 2)), location, depth + 1);
  }
  if (const std::size_t question = FindTop(expression, '?'); question != std::string::npos) {
    const std::size_t colon = FindTop(expression, ':', question + 1);
    if (colon == std::string::npos) {
      problems_.Add(location, fmt::format("${{{}}}: '?' without ':'", expression));
      return Value({}, location);
    }
    const Value condition = Evaluate(Trim(expression.substr(0, question)), location, depth + 1);
    double number = 0.0;
    const bool* const boolean = condition.boolean();
    if (boolean == nullptr && !condition.number(number)) {
      if (!condition.null()) {
        problems_.Add(location, fmt::format("${{{}}}: got {}; expected a condition", expression,
                                            condition.Show()));
      }
      return Value({}, location);
    }
    const bool yes = boolean != nullptr ? *boolean : number != 0.0;
    return Evaluate(Trim(yes ? expression.substr(question + 1, colon - question - 1)
                             : expression.substr(colon + 1)),
                    location, depth + 1);
  }
  if (IsQuoted(expression)) {
    return Value(expression.substr(1, expression.size() - 2), location);
  }
  if (expression == "true" || expression == "false") return Value(expression == "true", location);
  if (IsName(expression) && expression != "pi" && expression != "deg") {
    const Value* const value = Use(expression, location);
    return value == nullptr ? Value({}, location) : value->At(location);
  }
  if (const auto compared = Comparison(expression, location, depth)) return *compared;
  return Arithmetic(expression, location);
}

std::optional<Value> Expressions::Comparison(const std::string& expression,
                                             const Location& location, int depth) {
  for (const char* const sign : {"==", "!="}) {
    const std::size_t at = FindTop(expression, sign[0]);
    if (at == std::string::npos || expression.compare(at, 2, sign) != 0) continue;
    const std::string left = Trim(expression.substr(0, at));
    const std::string right = Trim(expression.substr(at + 2));
    if (!IsQuoted(left) && !IsQuoted(right)) continue;
    const Value a = Evaluate(left, location, depth + 1);
    const Value b = Evaluate(right, location, depth + 1);
    if (a.null() || b.null()) return Value({}, location);
    if (a.string() != nullptr && b.string() != nullptr) {
      return Value((*a.string() == *b.string()) == (sign[0] == '='), location);
    }
    problems_.Add(location, fmt::format("${{{}}}: got {}; expected a text", expression,
                                        (a.string() == nullptr ? a : b).Show()));
    return Value({}, location);
  }
  return std::nullopt;
}

void Expressions::SayOnce(const Location& location, const std::string& what) {
  if (said_.insert(what).second) problems_.Add(location, what);
}

void Expressions::SayNotFinite(const std::string& expression, const std::set<std::string>& names,
                               const Location& location) {
  std::string causes;
  for (const std::string& name : names) {
    const auto value = resolved_.find(name);
    if (value == resolved_.end()) continue;
    causes += fmt::format("; {} is {} ({})", name, value->second.Show(),
                          value->second.location().ToString());
  }
  SayOnce(location, fmt::format("${{{}}}: the result is not finite{}", expression, causes));
}

Value Expressions::Arithmetic(const std::string& expression, const Location& location) {
  const std::set<std::string> names = NamesIn(expression);
  std::map<std::string, double> numbers;
  for (const std::string& name : names) {
    if (!written_.contains(name)) continue;
    const Value* const value = Use(name, location);
    if (value == nullptr) return Value({}, location);
    double number = 0.0;
    if (value->boolean() != nullptr) number = *value->boolean() ? 1.0 : 0.0;
    if (value->boolean() == nullptr && !value->number(number)) {
      SayOnce(location, fmt::format("${{{}}}: '{}' is {}; expected a number", expression, name,
                                    value->Show()));
      return Value({}, location);
    }
    numbers[name] = number;
  }
  if (names.contains("true")) numbers["true"] = 1.0;
  if (names.contains("false")) numbers["false"] = 0.0;
  try {
    const ArithmeticResult result = Calculate(expression, numbers);
    if (result.count != 1) {
      problems_.Add(location, fmt::format("${{{}}}: got {} values; expected one (with a decimal "
                                          "point, not a comma)",
                                          expression, result.count));
      return Value({}, location);
    }
    if (!std::isfinite(result.number)) {
      SayNotFinite(expression, names, location);
      return Value({}, location);
    }
    if (IsLogical(expression)) return Value(result.number != 0.0, location);
    return Value(result.number, location);
  } catch (const ArithmeticError& error) {
    SayMistake(expression, error, location);
    return Value({}, location);
  }
}

void Expressions::SayMistake(const std::string& expression, const ArithmeticError& error,
                             const Location& location) {
  std::vector<std::string> names{"pi", "deg"};
  for (const auto& entry : written_) names.push_back(entry.first);
  problems_.Add(location, error.unknown.empty()
                              ? fmt::format("${{{}}}: {}", expression, error.what())
                              : fmt::format("${{{}}}: unknown parameter '{}'{}", expression,
                                            error.unknown, DidYouMean(error.unknown, names)));
}

}  // namespace oca::files
