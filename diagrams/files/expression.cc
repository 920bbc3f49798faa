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

constexpr int kDeepestTerm = 32;
constexpr std::size_t kLongest = 1000;

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

std::string Text(const Value& value) {
  if (value.string() != nullptr) return *value.string();
  double number = 0.0;
  if (value.number(number)) return fmt::format("{}", number);
  return value.Show();
}

}  // namespace

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
    const Parameter* const parameter = Find(name);
    if (parameter == nullptr || parameter->part == nullptr) continue;
    const Value& value = parameter->part->resolved;
    causes += fmt::format("; {} is {} ({})", name, value.Show(), value.location().ToString());
  }
  SayOnce(location, fmt::format("${{{}}}: the result is not finite{}", expression, causes));
}

Value Expressions::Arithmetic(const std::string& expression, const Location& location) {
  const std::set<std::string> names = NamesIn(expression);
  std::map<std::string, double> numbers;
  for (const std::string& name : names) {
    if (Find(name) == nullptr) continue;
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
  problems_.Add(location, error.unknown.empty()
                              ? fmt::format("${{{}}}: {}", expression, error.what())
                              : fmt::format("${{{}}}: unknown parameter '{}'{}", expression,
                                            error.unknown, DidYouMean(error.unknown, Names())));
}

}  // namespace oca::files
