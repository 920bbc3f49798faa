// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/yaml_values.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
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

/// A whole number in YAML 1.1: decimal, 0b, 0x, octal with a leading 0.
std::optional<PythonValue> WholeInYaml(std::string_view text) {
  const bool negative = text.starts_with('-');
  std::string_view digits = negative || text.starts_with('+') ? text.substr(1) : text;
  if (digits.empty() || digits[0] < '0' || digits[0] > '9') return std::nullopt;
  int base = 10;
  if (digits.starts_with("0x") || digits.starts_with("0b")) {
    base = digits[1] == 'x' ? 16 : 2;
    digits.remove_prefix(2);
  } else if (digits.size() > 1 && digits[0] == '0') {
    base = 8;
    digits.remove_prefix(1);
  }
  const std::string plain = WithoutUnderscores(digits);
  const std::string_view known = std::string_view("0123456789abcdefABCDEF")
                                     .substr(0, base == 16 ? 22 : static_cast<std::size_t>(base));
  if (plain.empty() || plain.find_first_not_of(known) != plain.npos) return std::nullopt;
  if (plain.size() > (base == 2 ? 62u : base == 16 ? 15u : 18u)) return std::nullopt;
  const std::int64_t whole = std::stoll(plain, nullptr, base);
  return PythonValue(negative ? -whole : whole);
}

/// A float in YAML 1.1 has a point, and a sign in its exponent.
std::optional<PythonValue> FloatInYaml(std::string_view text) {
  const std::string_view body =
      text.starts_with('-') || text.starts_with('+') ? text.substr(1) : text;
  if (IsOneOf(body, {".inf", ".Inf", ".INF"})) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return PythonValue(text.starts_with('-') ? -kInfinity : kInfinity);
  }
  if (IsOneOf(text, {".nan", ".NaN", ".NAN"})) {
    return PythonValue(std::numeric_limits<double>::quiet_NaN());
  }
  const std::size_t point = body.find('.'), e = body.find_first_of("eE");
  if (point == body.npos || (point == 0 && body.size() == 1)) return std::nullopt;
  if (body.find_first_not_of("0123456789_.eE+-") != body.npos) return std::nullopt;
  if (e != body.npos && (e + 2 >= body.size() || (body[e + 1] != '+' && body[e + 1] != '-'))) {
    return std::nullopt;
  }
  const auto number = NumberOf(WithoutUnderscores(text));
  return number ? std::optional(PythonValue(*number)) : std::nullopt;
}

PythonValue PlainValue(const std::string& text) {
  if (IsOneOf(text, {"", "~", "null", "Null", "NULL"})) return {};
  if (IsOneOf(text, {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"})) {
    return PythonValue(true);
  }
  if (IsOneOf(text, {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"})) {
    return PythonValue(false);
  }
  if (text.size() < 100) {
    if (const auto whole = WholeInYaml(text)) return *whole;
    if (const auto number = FloatInYaml(text)) return *number;
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
    if (node.tag.empty() || node.tag == "?") return PlainValue(text);
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
