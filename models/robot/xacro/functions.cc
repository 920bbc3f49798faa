// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/functions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "oca/models/robot/xacro/arithmetic.h"

namespace oca::robot::xacro {
namespace {

const PythonValue::Items& ItemsOf(std::string_view what, const PythonValue& value) {
  if (value.list() == nullptr) throw Mistake(what, Shown(value), "a list");
  return value.list()->items;
}

/// What list(), sorted() and their like go through: keys of a dictionary, letters of a text.
PythonValue::Items Elements(std::string_view what, const PythonValue& value) {
  PythonValue::Items items;
  if (const auto* dict = value.dict()) {
    for (const auto& [key, item] : dict->entries) items.push_back(key);
  } else if (value.text() != nullptr) {
    const std::vector<std::size_t> offsets = CharacterOffsets(*value.text());
    if (offsets.size() > kMostItems) throw Mistake(what, "a long text", "a shorter one");
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
      items.emplace_back(value.text()->substr(offsets[i], offsets[i + 1] - offsets[i]));
    }
  } else {
    items = ItemsOf(what, value);
  }
  return items;
}

PythonValue Extreme(const Arguments& arguments, bool most) {
  const char* const what = most ? "max()" : "min()";
  CheckCount(what, arguments, 1, kMostItems);
  const PythonValue::Items items =
      arguments.values.size() == 1 ? Elements(what, arguments.values[0]) : arguments.values;
  if (items.empty()) throw Mistake(what, "an empty list", "values");
  const PythonValue* best = &items[0];
  for (const PythonValue& item : items) {
    if (most ? Less(*best, item) : Less(item, *best)) best = &item;
  }
  return *best;
}

PythonValue Max(const Arguments& arguments, Budget&) { return Extreme(arguments, true); }
PythonValue Min(const Arguments& arguments, Budget&) { return Extreme(arguments, false); }

PythonValue Absolute(const Arguments& arguments, Budget&) {
  CheckCount("abs()", arguments, 1, 1);
  const PythonValue& value = arguments.values[0];
  return NumberArgument("abs()", value) < 0.0 ? Negative(value) : value;
}

PythonValue Rounded(const Arguments& arguments, Budget&) {
  CheckCount("round()", arguments, 1, 2);
  const double number = NumberArgument("round()", arguments.values[0]);
  if (arguments.values.size() == 1) {
    if (arguments.values[0].is_whole()) return arguments.values[0];
    return PythonValue(ToWhole(std::nearbyint(number), "round()"));
  }
  const PythonValue& digits = arguments.values[1];
  if (!digits.is_whole() || digits.whole() < 0 || digits.whole() > 30) {
    throw Mistake("digits of round()", Shown(digits), "0 to 30");
  }
  if (arguments.values[0].is_whole()) return arguments.values[0];
  if (!std::isfinite(number)) return PythonValue(number);
  return PythonValue(std::strtod(fmt::format("{:.{}f}", number, digits.whole()).c_str(), nullptr));
}

template <double (*kRound)(double)>
PythonValue RoundedBy(const Arguments& arguments, Budget&) {
  CheckCount("rounding", arguments, 1, 1);
  if (arguments.values[0].is_whole()) return PythonValue(arguments.values[0].whole());
  return PythonValue(ToWhole(kRound(NumberArgument("rounding", arguments.values[0])), "rounding"));
}
double Floor(double x) { return std::floor(x); }
double Ceiling(double x) { return std::ceil(x); }
double Truncated(double x) { return std::trunc(x); }

PythonValue Whole(const Arguments& arguments, Budget&) {
  CheckCount("int()", arguments, 0, 1);
  if (arguments.values.empty()) return PythonValue(std::int64_t{0});
  const PythonValue& value = arguments.values[0];
  if (value.is_whole()) return PythonValue(value.whole());
  if (value.is_float()) return PythonValue(ToWhole(std::trunc(value.number()), "int()"));
  const auto whole = value.text() == nullptr ? std::nullopt : WholeOf(*value.text());
  if (!whole) throw Mistake("int()", Shown(value), "a whole number of 64 bits");
  return PythonValue(*whole);
}

PythonValue Float(const Arguments& arguments, Budget&) {
  CheckCount("float()", arguments, 0, 1);
  if (arguments.values.empty()) return PythonValue(0.0);
  const PythonValue& value = arguments.values[0];
  if (value.is_number()) return PythonValue(value.number());
  const auto number = value.text() == nullptr ? std::nullopt : NumberOf(*value.text());
  if (!number) throw Mistake("float()", Shown(value), "a number");
  return PythonValue(*number);
}

PythonValue Text(const Arguments& arguments, Budget&) {
  CheckCount("str()", arguments, 0, 1);
  return PythonValue(arguments.values.empty() ? std::string() : ToText(arguments.values[0]));
}

PythonValue Represented(const Arguments& arguments, Budget&) {
  CheckCount("repr()", arguments, 1, 1);
  return PythonValue(Repr(arguments.values[0]));
}

PythonValue Boolean(const Arguments& arguments, Budget&) {
  CheckCount("bool()", arguments, 0, 1);
  return PythonValue(!arguments.values.empty() && arguments.values[0].truth());
}

PythonValue Length(const Arguments& arguments, Budget&) {
  CheckCount("len()", arguments, 1, 1);
  const PythonValue& value = arguments.values[0];
  std::size_t size = 0;
  if (value.text() != nullptr) {
    size = CharacterOffsets(*value.text()).size() - 1;
  } else if (const auto* dict = value.dict()) {
    size = dict->entries.size();
  } else if (const auto* list = value.list()) {
    size = list->items.size();
  } else {
    throw Mistake("len()", std::string(value.type()), "a text, list or dictionary");
  }
  return PythonValue(static_cast<std::int64_t>(size));
}

template <bool kTuple>
PythonValue ListFrom(const Arguments& arguments, Budget&) {
  CheckCount("list()", arguments, 0, 1);
  if (arguments.values.empty()) return PythonValue::ListOf({}, kTuple);
  return PythonValue::ListOf(Elements("list()", arguments.values[0]), kTuple);
}

PythonValue Dictionary(const Arguments& arguments, Budget&) {
  if (arguments.values.size() > 1) throw Mistake("dict()", "several values", "at most one");
  PythonValue::Entries entries;
  if (!arguments.values.empty()) {
    const PythonValue& from = arguments.values[0];
    if (const auto* dict = from.dict()) {
      entries = dict->entries;
    } else {
      for (const PythonValue& pair : ItemsOf("dict()", from)) {
        const PythonValue::Items& both = ItemsOf("item of dict()", pair);
        if (both.size() != 2) throw Mistake("item of dict()", Shown(pair), "a key and a value");
        entries.emplace_back(both[0], both[1]);
      }
    }
  }
  for (const auto& [name, value] : arguments.named) entries.emplace_back(PythonValue(name), value);
  return PythonValue::DictOf(std::move(entries));
}

PythonValue Total(const Arguments& arguments, Budget&) {
  CheckCount("sum()", arguments, 1, 1);
  PythonValue total(std::int64_t{0});
  for (const PythonValue& item : ItemsOf("sum()", arguments.values[0])) {
    total = Calculate(total, "+", item);
  }
  return total;
}

PythonValue Sorted(const Arguments& arguments, Budget&) {
  CheckCount("sorted()", arguments, 1, 1);
  PythonValue::Items items = Elements("sorted()", arguments.values[0]);
  for (const PythonValue& item : items) {  // so that the order is one of all
    if (item.is_float() && std::isnan(item.number())) throw Mistake("sorted()", "nan", "numbers");
    Less(item, items[0]);
  }
  std::stable_sort(items.begin(), items.end(), Less);
  return PythonValue::ListOf(std::move(items));
}

PythonValue Reversed(const Arguments& arguments, Budget&) {
  CheckCount("reversed()", arguments, 1, 1);
  PythonValue::Items items = Elements("reversed()", arguments.values[0]);
  std::reverse(items.begin(), items.end());
  return PythonValue::ListOf(std::move(items));
}

PythonValue Range(const Arguments& arguments, Budget&) {
  CheckCount("range()", arguments, 1, 3);
  std::int64_t bounds[3] = {0, 0, 1};
  for (std::size_t i = 0; i < arguments.values.size(); ++i) {
    const PythonValue& value = arguments.values[i];
    if (!value.is_whole() || std::abs(value.whole()) > 1'000'000'000) {
      throw Mistake("range()", Shown(value), "whole numbers up to 10^9");
    }
    bounds[arguments.values.size() == 1 ? 1 : i] = value.whole();
  }
  if (bounds[2] == 0) throw Mistake("step of range()", "0", "another number");
  PythonValue::Items items;
  for (std::int64_t at = bounds[0]; bounds[2] > 0 ? at < bounds[1] : at > bounds[1];
       at += bounds[2]) {
    if (items.size() >= kMostItems) {
      throw Mistake("range()", "more", fmt::format("at most {} items", kMostItems));
    }
    items.emplace_back(at);
  }
  return PythonValue::ListOf(std::move(items));
}

template <bool kAll>
PythonValue Quantified(const Arguments& arguments, Budget&) {
  CheckCount(kAll ? "all()" : "any()", arguments, 1, 1);
  for (const PythonValue& item : Elements("all() or any()", arguments.values[0])) {
    if (item.truth() != kAll) return PythonValue(!kAll);
  }
  return PythonValue(kAll);
}

using Function = PythonValue (*)(const Arguments&, Budget&);
const std::map<std::string, Function>& Functions() {
  static const std::map<std::string, Function> functions = {
      {"max", Max},
      {"min", Min},
      {"abs", Absolute},
      {"round", Rounded},
      {"floor", RoundedBy<Floor>},
      {"ceil", RoundedBy<Ceiling>},
      {"trunc", RoundedBy<Truncated>},
      {"int", Whole},
      {"float", Float},
      {"str", Text},
      {"repr", Represented},
      {"bool", Boolean},
      {"len", Length},
      {"list", ListFrom<false>},
      {"tuple", ListFrom<true>},
      {"dict", Dictionary},
      {"sum", Total},
      {"sorted", Sorted},
      {"reversed", Reversed},
      {"range", Range},
      {"all", Quantified<true>},
      {"any", Quantified<false>},
  };
  return functions;
}

[[noreturn]] void FailUnknown(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& entry : Functions()) known.push_back(entry.first);
  for (const std::string& math : MathFunctions()) known.push_back(math);
  throw Mistake("unknown function", fmt::format("'{}'", name),
                fmt::format("one of {}; or xacro.{}", fmt::join(known, ", "),
                            fmt::join(kXacroFunctions, ", xacro.")));
}

}  // namespace

PythonValue CallFunction(const std::string& name, const Arguments& arguments, Budget& budget) {
  if (const auto own = Functions().find(name); own != Functions().end()) {
    return own->second(arguments, budget);
  }
  const std::optional<PythonValue> value = CallMath(name, arguments);
  if (!value) FailUnknown(name);
  return *value;
}

void CheckCount(std::string_view what, const Arguments& arguments, std::size_t least,
                std::size_t most) {
  if (!arguments.named.empty()) {
    throw Mistake(what, fmt::format("an argument {}=", arguments.named[0].first),
                  "arguments without names");
  }
  if (arguments.values.size() >= least && arguments.values.size() <= most) return;
  throw Mistake(what, fmt::format("{} arguments", arguments.values.size()),
                least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most));
}

std::int64_t ToWhole(double number, std::string_view what) {
  constexpr double kLimit = 9223372036854775808.0;
  if (!(number >= -kLimit && number < kLimit)) {
    throw Mistake(what, fmt::format("{}", number), "a number that 64 bits hold");
  }
  return static_cast<std::int64_t>(number);
}

}  // namespace oca::robot::xacro
