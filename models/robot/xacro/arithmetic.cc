// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/arithmetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "oca/models/robot/xacro/functions.h"

namespace oca::robot::xacro {
namespace {

[[noreturn]] void FailTypes(const PythonValue& a, const std::string& word, const PythonValue& b) {
  throw Mistake(fmt::format("'{}'", word), fmt::format("{} {} {}", a.type(), word, b.type()),
                "two numbers, or texts and lists where Python has it");
}

[[noreturn]] void FailOverflow(const std::string& word) {
  throw Mistake(fmt::format("'{}'", word), "a whole number beyond 64 bits", "a smaller one");
}

std::int64_t PowerOf(std::int64_t base, std::int64_t exponent) {
  std::int64_t result = 1;
  while (exponent > 0) {
    if (exponent % 2 == 1 && __builtin_mul_overflow(result, base, &result)) FailOverflow("**");
    exponent /= 2;
    if (exponent > 0 && __builtin_mul_overflow(base, base, &base)) FailOverflow("**");
  }
  return result;
}

double FloatPower(double a, double b) {
  if (a == 0.0 && b < 0.0) throw Mistake("'**'", "0 to a negative power", "a number but 0");
  if (a < 0.0 && b != std::floor(b)) {
    throw Mistake("'**'", "a root of a negative number", "a number of 0 or more");
  }
  const double result = std::pow(a, b);
  if (std::isinf(result) && std::isfinite(a) && std::isfinite(b)) {
    throw Mistake("'**'", "a number beyond those of a double", "a smaller one");
  }
  return result;
}

PythonValue OfWholes(std::int64_t a, const std::string& word, std::int64_t b) {
  std::int64_t result = 0;
  if (word == "+") {
    if (__builtin_add_overflow(a, b, &result)) FailOverflow(word);
  } else if (word == "-") {
    if (__builtin_sub_overflow(a, b, &result)) FailOverflow(word);
  } else if (word == "*") {
    if (__builtin_mul_overflow(a, b, &result)) FailOverflow(word);
  } else if (word == "**") {
    if (b < 0) return PythonValue(FloatPower(static_cast<double>(a), static_cast<double>(b)));
    return PythonValue(PowerOf(a, b));
  } else if (word == "/") {
    return PythonValue(static_cast<double>(a) / static_cast<double>(b));
  } else {
    if (a == std::numeric_limits<std::int64_t>::min() && b == -1) FailOverflow(word);
    const std::int64_t rest = a % b;
    const bool down = rest != 0 && (rest < 0) != (b < 0);
    result = word == "//" ? a / b - (down ? 1 : 0) : rest + (down ? b : 0);
  }
  return PythonValue(result);
}

PythonValue OfFloats(double a, const std::string& word, double b) {
  if (word == "+") return PythonValue(a + b);
  if (word == "-") return PythonValue(a - b);
  if (word == "*") return PythonValue(a * b);
  if (word == "/") return PythonValue(a / b);
  if (word == "**") return PythonValue(FloatPower(a, b));
  double rest = std::fmod(a, b);
  if (rest != 0.0 && (rest < 0.0) != (b < 0.0)) rest += b;
  if (word == "%") return PythonValue(rest);
  return PythonValue(std::round((a - rest) / b));
}

PythonValue Repeated(const PythonValue& of, std::int64_t times, const std::string& word) {
  const auto count = static_cast<std::size_t>(std::max<std::int64_t>(times, 0));
  if (of.text() != nullptr) {
    const std::string& text = *of.text();
    if (!text.empty() && count > kMostText / text.size()) {
      throw Mistake(fmt::format("'{}'", word), fmt::format("a text {} times", count),
                    fmt::format("at most {} bytes", kMostText));
    }
    std::string result;
    for (std::size_t i = 0; i < count && !text.empty(); ++i) result += text;
    return PythonValue(std::move(result));
  }
  const PythonValue::Items& items = of.list()->items;
  if (!items.empty() && count > kMostItems / items.size()) {
    throw Mistake(fmt::format("'{}'", word), fmt::format("a list {} times", count),
                  fmt::format("at most {} items", kMostItems));
  }
  PythonValue::Items result;
  for (std::size_t i = 0; i < count && !items.empty(); ++i) {
    result.insert(result.end(), items.begin(), items.end());
  }
  return PythonValue::ListOf(std::move(result), of.list()->tuple);
}

}  // namespace

PythonValue Calculate(const PythonValue& a, const std::string& word, const PythonValue& b) {
  if (a.is_number() && b.is_number()) {
    if ((word == "/" || word == "//" || word == "%") && b.number() == 0.0) {
      throw Mistake(fmt::format("'{}'", word), "a division by 0", "another number");
    }
    if (a.is_whole() && b.is_whole()) return OfWholes(a.whole(), word, b.whole());
    return OfFloats(a.number(), word, b.number());
  }
  if (word == "+" && a.text() != nullptr && b.text() != nullptr) {
    if (a.text()->size() + b.text()->size() > kMostText) {
      throw Mistake("'+'", "two long texts", fmt::format("at most {} bytes", kMostText));
    }
    return PythonValue(*a.text() + *b.text());
  }
  if (word == "+" && a.list() != nullptr && b.list() != nullptr &&
      a.list()->tuple == b.list()->tuple) {
    PythonValue::Items items = a.list()->items;
    items.insert(items.end(), b.list()->items.begin(), b.list()->items.end());
    return PythonValue::ListOf(std::move(items), a.list()->tuple);
  }
  const auto repeats = [](const PythonValue& of, const PythonValue& times) {
    return (of.text() != nullptr || of.list() != nullptr) && times.is_whole();
  };
  if (word == "*" && repeats(a, b)) return Repeated(a, b.whole(), word);
  if (word == "*" && repeats(b, a)) return Repeated(b, a.whole(), word);
  if (word == "%" && a.text() != nullptr) return FormatPercent(*a.text(), b);
  FailTypes(a, word, b);
}

PythonValue Negative(const PythonValue& value) {
  if (!value.is_number()) throw Mistake("'-'", std::string(value.type()), "a number");
  if (value.is_float()) return PythonValue(-value.number());
  return OfWholes(0, "-", value.whole());
}

bool Contains(const PythonValue& container, const PythonValue& item) {
  if (container.text() != nullptr && item.text() != nullptr) {
    return container.text()->find(*item.text()) != std::string::npos;
  }
  if (const auto* list = container.list()) {
    return std::any_of(list->items.begin(), list->items.end(),
                       [&](const PythonValue& one) { return Equal(one, item); });
  }
  if (const auto* dict = container.dict()) return Find(*dict, item) != nullptr;
  throw Mistake("'in'", fmt::format("{} in {}", item.type(), container.type()),
                "a text in a text, or a value in a list or dictionary");
}

}  // namespace oca::robot::xacro
