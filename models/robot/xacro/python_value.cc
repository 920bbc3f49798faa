// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/python_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace oca::robot::xacro {
namespace {

constexpr int kDeepestValue = 64;

int DepthOf(const PythonValue& value) {
  if (const auto* list = value.list()) return list->depth;
  if (const auto* dict = value.dict()) return dict->depth;
  return 0;
}

int CheckedDepth(int inner) {
  if (inner >= kDeepestValue) {
    throw Mistake("nested lists", fmt::format("more than {} levels", kDeepestValue), "fewer");
  }
  return inner + 1;
}

void CheckCount(std::size_t items) {
  if (items > kMostItems) {
    throw Mistake("size of a list", fmt::format("{} items", items),
                  fmt::format("at most {}", kMostItems));
  }
}

// The shortest digits that read back as the number, laid out as Python does.
std::string FloatText(double number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number < 0 ? "-inf" : "inf";
  char buffer[64];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::scientific).ptr;
  std::string_view text(buffer, static_cast<std::size_t>(end - buffer));
  const std::string sign = text.starts_with('-') ? "-" : "";
  text.remove_prefix(sign.size());
  const std::size_t e = text.find('e');
  const int exponent = std::atoi(std::string(text.substr(e + 1)).c_str());
  std::string digits(1, text[0]);
  if (e > 1) digits += text.substr(2, e - 2);
  const int count = static_cast<int>(digits.size());
  if (exponent < -4 || exponent >= 16) {
    const std::string fraction = count > 1 ? "." + digits.substr(1) : "";
    return fmt::format("{}{}{}e{}{:02}", sign, digits[0], fraction, exponent < 0 ? '-' : '+',
                       std::abs(exponent));
  }
  if (exponent < 0)
    return sign + "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  if (count <= exponent + 1) {
    return sign + digits + std::string(static_cast<std::size_t>(exponent + 1 - count), '0') + ".0";
  }
  const auto point = static_cast<std::size_t>(exponent + 1);
  return sign + digits.substr(0, point) + "." + digits.substr(point);
}

void Append(std::string& out, std::string_view text) {
  if (out.size() + text.size() > kMostText) {
    throw Mistake("length of a text", fmt::format("more than {} bytes", kMostText), "fewer");
  }
  out += text;
}

void AppendQuoted(std::string& out, const std::string& text) {
  const bool single = text.find('\'') != text.npos && text.find('"') == text.npos;
  const char quote = single ? '"' : '\'';
  std::string quoted(1, quote);
  for (const char c : text) {
    if (c == '\n') {
      quoted += "\\n";
    } else if (c == '\t') {
      quoted += "\\t";
    } else if (c == '\r') {
      quoted += "\\r";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned>(c));
    } else {
      if (c == quote || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  Append(out, quoted + quote);
}

void AppendRepr(std::string& out, const PythonValue& value) {
  if (value.text() != nullptr) return AppendQuoted(out, *value.text());
  if (const auto* list = value.list()) {
    Append(out, list->tuple ? "(" : "[");
    for (std::size_t i = 0; i < list->items.size(); ++i) {
      if (i > 0) Append(out, ", ");
      AppendRepr(out, list->items[i]);
    }
    if (list->tuple && list->items.size() == 1) Append(out, ",");
    return Append(out, list->tuple ? ")" : "]");
  }
  if (const auto* dict = value.dict()) {
    Append(out, "{");
    for (std::size_t i = 0; i < dict->entries.size(); ++i) {
      if (i > 0) Append(out, ", ");
      AppendRepr(out, dict->entries[i].first);
      Append(out, ": ");
      AppendRepr(out, dict->entries[i].second);
    }
    return Append(out, "}");
  }
  if (value.none()) return Append(out, "None");
  if (value.boolean() != nullptr) return Append(out, *value.boolean() ? "True" : "False");
  Append(out, value.is_float() ? FloatText(value.number()) : fmt::format("{}", value.whole()));
}

// Steps of one comparison: lists that share their items may be far larger than their memory.
struct Steps {
  std::size_t left{10 * kMostItems};
  void Take() {
    if (left-- == 0) throw Mistake("comparison", "lists of more than 10^6 items", "smaller ones");
  }
};

bool EqualIn(const PythonValue& a, const PythonValue& b, Steps& steps) {
  steps.Take();
  if (a.is_number() && b.is_number()) {
    if (a.is_whole() && b.is_whole()) return a.whole() == b.whole();
    return a.number() == b.number();
  }
  if (a.text() != nullptr && b.text() != nullptr) return *a.text() == *b.text();
  const auto *list_a = a.list(), *list_b = b.list();
  if (list_a != nullptr && list_b != nullptr) {
    return list_a->tuple == list_b->tuple &&
           std::equal(list_a->items.begin(), list_a->items.end(), list_b->items.begin(),
                      list_b->items.end(), [&](const PythonValue& x, const PythonValue& y) {
                        return EqualIn(x, y, steps);
                      });
  }
  const auto *dict_a = a.dict(), *dict_b = b.dict();
  if (dict_a != nullptr && dict_b != nullptr) {
    if (dict_a->entries.size() != dict_b->entries.size()) return false;
    return std::all_of(dict_a->entries.begin(), dict_a->entries.end(), [&](const auto& entry) {
      const PythonValue* const other = Find(*dict_b, entry.first);
      return other != nullptr && EqualIn(entry.second, *other, steps);
    });
  }
  return a.none() && b.none();
}

bool LessIn(const PythonValue& a, const PythonValue& b, Steps& steps) {
  steps.Take();
  if (a.is_number() && b.is_number()) {
    if (a.is_whole() && b.is_whole()) return a.whole() < b.whole();
    return a.number() < b.number();
  }
  if (a.text() != nullptr && b.text() != nullptr) return *a.text() < *b.text();
  const auto *list_a = a.list(), *list_b = b.list();
  if (list_a != nullptr && list_b != nullptr && list_a->tuple == list_b->tuple) {
    const std::size_t both = std::min(list_a->items.size(), list_b->items.size());
    for (std::size_t i = 0; i < both; ++i) {
      if (!EqualIn(list_a->items[i], list_b->items[i], steps)) {
        return LessIn(list_a->items[i], list_b->items[i], steps);
      }
    }
    return list_a->items.size() < list_b->items.size();
  }
  throw Mistake("order", fmt::format("{} and {}", a.type(), b.type()), "two numbers or two texts");
}

}  // namespace

Mistake::Mistake(std::string_view what, std::string_view got, std::string_view expected)
    : Error(fmt::format("{}; got {}; expected {}", what, got, expected)) {}

PythonValue PythonValue::ListOf(Items items, bool tuple) {
  CheckCount(items.size());
  int depth = 0;
  for (const PythonValue& item : items) depth = std::max(depth, DepthOf(item));
  PythonValue value;
  value.data_ = std::make_shared<const List>(List{std::move(items), tuple, CheckedDepth(depth)});
  return value;
}

PythonValue PythonValue::DictOf(
    Entries entries) {  // NOLINT(performance-unnecessary-value-param): moved from
  CheckCount(entries.size());
  int depth = 0;
  std::map<std::string, std::size_t> places;
  Dict dict;
  for (auto& [key, item] : entries) {
    if (key.list() != nullptr || key.dict() != nullptr) {
      throw Mistake("key of a dictionary", std::string(key.type()), "a text or number");
    }
    depth = std::max(depth, DepthOf(item));
    const auto [place, fresh] = places.emplace(Repr(key), dict.entries.size());
    if (fresh) {
      dict.entries.emplace_back(std::move(key), std::move(item));
    } else {
      dict.entries[place->second].second = std::move(item);
    }
  }
  dict.depth = CheckedDepth(depth);
  PythonValue value;
  value.data_ = std::make_shared<const Dict>(std::move(dict));
  return value;
}

const PythonValue::List* PythonValue::list() const {
  const auto* const list = std::get_if<ListPtr>(&data_);
  return list == nullptr ? nullptr : list->get();
}

const PythonValue::Dict* PythonValue::dict() const {
  const auto* const dict = std::get_if<DictPtr>(&data_);
  return dict == nullptr ? nullptr : dict->get();
}

bool PythonValue::is_whole() const {
  return std::holds_alternative<std::int64_t>(data_) || boolean() != nullptr;
}

std::int64_t PythonValue::whole() const {
  return boolean() != nullptr ? (*boolean() ? 1 : 0) : std::get<std::int64_t>(data_);
}

double PythonValue::number() const {
  return is_float() ? std::get<double>(data_) : static_cast<double>(whole());
}

std::string_view PythonValue::type() const {
  constexpr std::string_view kNames[] = {"None", "bool", "int", "float", "str", "list", "dict"};
  if (list() != nullptr && list()->tuple) return "tuple";
  return kNames[data_.index()];
}

bool PythonValue::truth() const {
  if (is_number()) return number() != 0.0;
  if (text() != nullptr) return !text()->empty();
  if (list() != nullptr) return !list()->items.empty();
  return dict() != nullptr && !dict()->entries.empty();
}

const PythonValue* Find(const PythonValue::Dict& dict, const PythonValue& key) {
  for (const auto& [name, value] : dict.entries) {
    if (name.text() != nullptr && key.text() != nullptr) {
      if (*name.text() == *key.text()) return &value;
    } else if (Equal(name, key)) {
      return &value;
    }
  }
  return nullptr;
}

bool Equal(const PythonValue& a, const PythonValue& b) {
  Steps steps;
  return EqualIn(a, b, steps);
}

bool Less(const PythonValue& a, const PythonValue& b) {
  Steps steps;
  return LessIn(a, b, steps);
}

std::string ToText(const PythonValue& value) {
  return value.text() != nullptr ? *value.text() : Repr(value);
}

std::string Repr(const PythonValue& value) {
  std::string text;
  AppendRepr(text, value);
  return text;
}

std::string Shown(const PythonValue& value) {
  constexpr std::size_t kMostShown = 60;
  const std::string text = Repr(value);
  return text.size() <= kMostShown ? text : text.substr(0, kMostShown) + "...";
}

}  // namespace oca::robot::xacro
