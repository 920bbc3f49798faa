// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/yaml_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <regex>
#include <string_view>
#include <vector>

#include "oca/models/robot/xacro/functions.h"
#include "oca/models/yaml_events.h"

namespace oca::robot::xacro {
namespace {

using models::internal::YamlError;
using models::internal::YamlMark;

struct Unit {
  std::string_view tag;
  double factor;
};
constexpr std::array kUnits = {Unit{"!degrees", std::numbers::pi / 180.0},
                               Unit{"!radians", 1.0},
                               Unit{"!meters", 1.0},
                               Unit{"!millimeters", 1e-3},
                               Unit{"!inches", 0.0254},
                               Unit{"!foot", 0.3048}};

bool IsOneOf(std::string_view text, std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words) {
    if (text == word) return true;
  }
  return false;
}

std::string WithoutUnderscores(std::string_view text) {
  std::string plain;
  for (const char c : text) {
    if (c != '_') plain += c;
  }
  return plain;
}

/// Plain scalars that are no texts. source PyYAML, lib/yaml/resolver.py
struct Patterns {
  const std::regex whole{
      "[-+]?0b[0-1_]+|[-+]?0[0-7_]+|[-+]?(0|[1-9][0-9_]*)|[-+]?0x[0-9a-fA-F_]+"
      "|[-+]?[1-9][0-9_]*(:[0-5]?[0-9])+"};
  const std::regex number{
      "[-+]?[0-9][0-9_]*\\.[0-9_]*([eE][-+][0-9]+)?|\\.[0-9][0-9_]*([eE][-+][0-9]+)?"
      "|[-+]?[0-9][0-9_]*(:[0-5]?[0-9])+\\.[0-9_]*"};
  const std::regex date{
      "[0-9]{4}-[0-9]{2}-[0-9]{2}|[0-9]{4}-[0-9]{1,2}-[0-9]{1,2}([Tt]|[ \\t]+)[0-9]{1,2}:[0-9]{2}"
      ":[0-9]{2}(\\.[0-9]*)?([ \\t]*(Z|[-+][0-9]{1,2}(:[0-9]{2})?))?"};
};

bool TakeSign(std::string_view& text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  return negative;
}

/// Parts of base 60 between colons, `1:30` is 90; else one part of another base.
/// throws Mistake beyond 64 bits
PythonValue WholeInYaml(const std::string& written) {
  const std::string plain = WithoutUnderscores(written);
  std::string_view digits = plain;
  const bool negative = TakeSign(digits);
  const int base = digits.starts_with("0b")                       ? 2
                   : digits.starts_with("0x")                     ? 16
                   : digits.size() > 1 && digits.starts_with('0') ? 8
                                                                  : 10;
  if (base == 2 || base == 16) digits.remove_prefix(2);
  __extension__ using Wide = __int128;
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  Wide whole = 0;
  while (true) {
    const std::size_t end = std::min(digits.find(':'), digits.size());
    std::int64_t part = 0;
    const auto error = std::from_chars(digits.data(), digits.data() + end, part, base).ec;
    whole = 60 * whole + part;
    if (error != std::errc() || whole > kMost) {
      throw Mistake("whole number", written, "one of 64 bits");
    }
    if (end == digits.size()) break;
    digits.remove_prefix(end + 1);
  }
  const auto value = static_cast<std::int64_t>(whole);
  return PythonValue(negative ? -value : value);
}

/// `1:30.5` is 90.5.
PythonValue FloatInYaml(const std::string& written) {
  const std::string plain = WithoutUnderscores(written);
  std::string_view digits = plain;
  const bool negative = TakeSign(digits);
  double number = 0.0;
  while (true) {
    const std::size_t end = std::min(digits.find(':'), digits.size());
    const auto part = NumberOf(digits.substr(0, end));
    if (!part) throw Mistake("number", written, "a number");
    number = 60.0 * number + *part;
    if (end == digits.size()) break;
    digits.remove_prefix(end + 1);
  }
  return PythonValue(negative ? -number : number);
}

std::optional<double> SpecialInYaml(std::string_view text) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (IsOneOf(text, {".nan", ".NaN", ".NAN"})) return std::numeric_limits<double>::quiet_NaN();
  const bool negative = TakeSign(text);
  if (!IsOneOf(text, {".inf", ".Inf", ".INF"})) return std::nullopt;
  return negative ? -kInfinity : kInfinity;
}

PythonValue PlainValue(const std::string& text) {
  if (IsOneOf(text, {"", "~", "null", "Null", "NULL"})) return {};
  if (IsOneOf(text, {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"})) {
    return PythonValue(true);
  }
  if (IsOneOf(text, {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"})) {
    return PythonValue(false);
  }
  if (text == "=") throw Mistake("plain scalar", "=", "quotes around it");  // a tag of YAML 1.1
  constexpr std::string_view kBegins = "-+0123456789.";
  constexpr std::size_t kLongest = 1000;  // std::regex recurses
  if (kBegins.find(text.front()) == kBegins.npos || text.size() > kLongest) {
    return PythonValue(text);
  }
  static const Patterns patterns;
  if (std::regex_match(text, patterns.number)) return FloatInYaml(text);
  if (std::regex_match(text, patterns.whole)) return WholeInYaml(text);
  if (const auto special = SpecialInYaml(text)) return PythonValue(*special);
  if (std::regex_match(text, patterns.date)) {
    throw Mistake("plain scalar", fmt::format("the date {}", text), "quotes around it");
  }
  return PythonValue(text);
}

class ValueBuilder final : public models::internal::YamlEvents {
 public:
  explicit ValueBuilder(const std::function<PythonValue(const std::string&)>& evaluate)
      : evaluate_(evaluate) {}

  PythonValue Take() { return std::move(root_); }

  void OnNull(const YamlMark& mark, std::size_t anchor) override { Put({}, mark, anchor); }
  void OnAlias(const YamlMark& mark, std::size_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end())
      throw YamlError(mark, "an alias of itself; expected one of before");
    Put(found->second, mark, 0);
  }
  void OnScalar(const Node& node, const std::string& value) override {
    Put(Scalar(node, value), node.mark, node.anchor);
  }
  void OnListStart(const Node& node) override { Open(node, false); }
  void OnListEnd() override {
    Frame frame = TakeFrame();
    Put(Checked(frame.mark, [&] { return PythonValue::ListOf(std::move(frame.items)); }),
        frame.mark, frame.anchor);
  }
  void OnMapStart(const Node& node) override { Open(node, true); }
  void OnMapEnd() override {
    Frame frame = TakeFrame();
    Put(Checked(frame.mark, [&] { return MapOf(frame.items); }), frame.mark, frame.anchor);
  }

 private:
  struct Frame {
    YamlMark mark;
    std::size_t anchor;
    PythonValue::Items items;  // of a map keys and values in turn
  };

  template <class Make>
  static PythonValue Checked(const YamlMark& mark, const Make& make) {
    try {
      return make();
    } catch (const Mistake& mistake) {
      throw YamlError(mark, mistake.what());
    }
  }

  PythonValue Scalar(const Node& node, const std::string& text) const {
    if (node.tag == "!" || node.tag == "!!str" || node.tag == "tag:yaml.org,2002:str") {
      return PythonValue(text);
    }
    if (node.tag.empty() || node.tag == "?") {
      return Checked(node.mark, [&] { return PlainValue(text); });
    }
    for (const Unit& unit : kUnits) {
      if (node.tag != unit.tag) continue;
      return Checked(node.mark, [&] {
        const PythonValue value = evaluate_(text);
        if (!value.is_number()) throw Mistake(node.tag, Shown(value), "a number");
        return PythonValue(value.number() * unit.factor);
      });
    }
    FailTag(node);
  }

  [[noreturn]] static void FailTag(const Node& node) {
    throw YamlError(node.mark, fmt::format("tag; got '{}'; expected !degrees, !radians, !meters, "
                                           "!millimeters, !inches or !foot",
                                           node.tag));
  }

  PythonValue MapOf(const PythonValue::Items& items) {
    PythonValue::Entries merged, own;
    for (std::size_t i = 0; i + 1 < items.size(); i += 2) {
      const PythonValue& value = items[i + 1];
      const bool merge = items[i].text() != nullptr && *items[i].text() == "<<";
      if (!merge) {
        own.emplace_back(items[i], value);
      } else if (const auto* dict = value.dict()) {
        merged_ += dict->entries.size();
        if (merged_ > 10 * kMostItems) throw Mistake("<<", "too many merged keys", "fewer");
        merged.insert(merged.end(), dict->entries.begin(), dict->entries.end());
      } else {
        throw Mistake("<<", std::string(value.type()), "a map");
      }
    }
    merged.insert(merged.end(), own.begin(), own.end());
    return PythonValue::DictOf(std::move(merged));
  }

  void Open(const Node& node, bool map) {
    const bool tagged = !node.tag.empty() && node.tag != "?" && node.tag != "!";
    if (tagged && node.tag != (map ? "tag:yaml.org,2002:map" : "tag:yaml.org,2002:seq")) {
      FailTag(node);
    }
    if (stack_.size() >= static_cast<std::size_t>(models::internal::kDeepestYaml)) {
      throw YamlError(node.mark,
                      fmt::format("nested deeper than {} levels", models::internal::kDeepestYaml));
    }
    stack_.push_back({node.mark, node.anchor, {}});
  }

  Frame TakeFrame() {
    Frame frame = std::move(stack_.back());
    stack_.pop_back();
    return frame;
  }

  void Put(PythonValue value, const YamlMark& mark, std::size_t anchor) {
    if (anchor != 0) anchors_[anchor] = value;
    if (stack_.empty()) {
      root_ = std::move(value);
      return;
    }
    stack_.back().items.push_back(std::move(value));
    if (stack_.back().items.size() > 2 * kMostItems) {
      throw YamlError(mark, fmt::format("more than {} items", kMostItems));
    }
  }

  const std::function<PythonValue(const std::string&)>& evaluate_;
  std::vector<Frame> stack_;
  std::size_t merged_{0};  // entries that merge keys copied
  std::map<std::size_t, PythonValue> anchors_;
  PythonValue root_;
};

}  // namespace

PythonValue ReadYamlValues(
    const std::string& text,
    const std::function<PythonValue(const std::string& expression)>& evaluate) {
  ValueBuilder builder(evaluate);
  try {
    models::internal::ReadYamlEvents(text, builder);
  } catch (const YamlError& error) {
    throw Mistake(fmt::format("{}: {}", error.mark.line, error.what()));
  }
  return builder.Take();
}

}  // namespace oca::robot::xacro
