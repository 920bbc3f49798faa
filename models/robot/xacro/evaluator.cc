// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "oca/models/nearest_name.h"
#include "oca/models/robot/xacro/arithmetic.h"

namespace oca::robot::xacro {
namespace {

using Kind = Expression::Kind;

std::size_t SizeOf(const PythonValue& value) {
  constexpr std::size_t kOne = sizeof(PythonValue);
  if (value.text() != nullptr) return kOne + value.text()->size();
  if (value.list() != nullptr) return kOne * (1 + value.list()->items.size());
  if (value.dict() != nullptr) return kOne * (1 + value.dict()->entries.size());
  return kOne;
}

/// Of looking for one text in another.
std::size_t SearchWork(const PythonValue& in, const PythonValue& part) {
  if (in.text() == nullptr || part.text() == nullptr) return 0;
  return in.text()->size() * part.text()->size() / 64;
}

class Evaluation {
 public:
  Evaluation(Surroundings& in, Budget& budget) : in_(in), budget_(budget) {}

  PythonValue Of(const Expression& e) {
    const Budget::Level level(budget_);
    PythonValue value = Work(e);
    budget_.Spend(SizeOf(value));
    return value;
  }

 private:
  PythonValue Work(const Expression& e) {
    switch (e.kind) {
      case Kind::kConstant:
        return e.value;
      case Kind::kName:
        return Named(e.text);
      case Kind::kNot:
        return PythonValue(!Of(*e.parts[0]).truth());
      case Kind::kNegative:
        return Negative(Of(*e.parts[0]));
      case Kind::kPositive:
        return Negative(Negative(Of(*e.parts[0])));
      case Kind::kArithmetic:
        return Calculate(Of(*e.parts[0]), e.text, Of(*e.parts[1]));
      case Kind::kComparison:
        return Compared(e);
      case Kind::kAnd:
      case Kind::kOr:
        return Decided(e);
      case Kind::kConditional:
        return Of(*e.parts[Of(*e.parts[1]).truth() ? 0 : 2]);
      case Kind::kList:
      case Kind::kTuple:
        return PythonValue::ListOf(AllOf(e, 0), e.kind == Kind::kTuple);
      case Kind::kDict:
        return Dictionary(e);
      case Kind::kSubscript:
        return Item(Of(*e.parts[0]), Of(*e.parts[1]));
      case Kind::kSlice:
        return Slice(e);
      case Kind::kAttribute:
        return Attribute(e);
      case Kind::kCall:
        return Call(e);
    }
    return {};
  }

  PythonValue::Items AllOf(const Expression& e, std::size_t from) {
    PythonValue::Items items;
    for (std::size_t i = from; i < e.parts.size(); ++i) items.push_back(Of(*e.parts[i]));
    return items;
  }

  PythonValue Named(const std::string& name) {
    if (const PythonValue* const property = in_.Property(name)) return *property;
    if (const auto constant = ConstantNamed(name)) return PythonValue(*constant);
    const std::vector<std::string> known = in_.PropertyNames();
    const std::string nearest = models::NearestName(name, known);
    throw Mistake("unknown name", fmt::format("'{}'", name),
                  nearest.empty() ? "a property" : fmt::format("a property such as '{}'", nearest));
  }

  static bool Holds(const PythonValue& a, const std::string& word, const PythonValue& b) {
    if (word == "==") return Equal(a, b);
    if (word == "!=") return !Equal(a, b);
    if (word == "<") return Less(a, b);
    if (word == ">") return Less(b, a);
    if (word == "in") return Contains(b, a);
    if (word == "not in") return !Contains(b, a);
    if (word == "is" || word == "is not") {
      const bool same = a.type() == b.type() && Equal(a, b);
      return same == (word == "is");
    }
    const bool unordered =
        a.is_number() && b.is_number() && (std::isnan(a.number()) || std::isnan(b.number()));
    return !unordered && (word == "<=" ? !Less(b, a) : !Less(a, b));
  }

  PythonValue Compared(const Expression& e) {
    PythonValue left = Of(*e.parts[0]);
    for (std::size_t i = 0; i < e.words.size(); ++i) {
      PythonValue right = Of(*e.parts[i + 1]);
      budget_.Spend(SizeOf(left) + SizeOf(right) + SearchWork(right, left));
      if (!Holds(left, e.words[i], right)) return PythonValue(false);
      left = std::move(right);
    }
    return PythonValue(true);
  }

  PythonValue Decided(const Expression& e) {
    PythonValue value;
    for (const ExpressionPtr& part : e.parts) {
      value = Of(*part);
      if (value.truth() == (e.kind == Kind::kOr)) break;
    }
    return value;
  }

  PythonValue Dictionary(const Expression& e) {
    PythonValue::Entries entries;
    for (std::size_t i = 0; i < e.parts.size(); i += 2) {
      entries.emplace_back(Of(*e.parts[i]), Of(*e.parts[i + 1]));
    }
    return PythonValue::DictOf(std::move(entries));
  }

  static std::int64_t Place(const PythonValue& at, std::size_t size) {
    if (!at.is_whole()) throw Mistake("place in a list", std::string(at.type()), "a whole number");
    const auto count = static_cast<std::int64_t>(size);
    const std::int64_t place = at.whole() < 0 ? at.whole() + count : at.whole();
    if (place < 0 || place >= count) {
      throw Mistake("place in a list", fmt::format("{}", at.whole()),
                    size == 0 ? "a list that is not empty" : fmt::format("0 to {}", size - 1));
    }
    return place;
  }

  static std::string KeysOf(const PythonValue::Dict& dict) {
    std::string keys;
    for (std::size_t i = 0; i < dict.entries.size() && i < 12; ++i) {
      keys += (i == 0 ? "" : ", ") + ToText(dict.entries[i].first);
    }
    return dict.entries.empty() ? "none: it is empty" : "one of " + keys;
  }

  static PythonValue Item(const PythonValue& of, const PythonValue& at) {
    if (const auto* dict = of.dict()) {
      const PythonValue* const found = Find(*dict, at);
      if (found == nullptr) throw Mistake("unknown key", Shown(at), KeysOf(*dict));
      return *found;
    }
    if (const auto* list = of.list()) {
      return list->items[static_cast<std::size_t>(Place(at, list->items.size()))];
    }
    if (of.text() == nullptr) {
      throw Mistake("[]", std::string(of.type()), "a dictionary, list or text");
    }
    const std::vector<std::size_t> offsets = CharacterOffsets(*of.text());
    const auto place = static_cast<std::size_t>(Place(at, offsets.size() - 1));
    return PythonValue(of.text()->substr(offsets[place], offsets[place + 1] - offsets[place]));
  }

  std::optional<std::int64_t> Bound(const ExpressionPtr& part) {
    if (part == nullptr) return std::nullopt;
    const PythonValue bound = Of(*part);
    if (bound.none()) return std::nullopt;
    if (!bound.is_whole())
      throw Mistake("bound of [:]", std::string(bound.type()), "whole numbers");
    return std::clamp<std::int64_t>(bound.whole(), -2'000'000'000, 2'000'000'000);
  }

  /// The places that [from:to:step] takes of `size`.
  std::vector<std::size_t> Places(const Expression& e, std::size_t size) {
    const auto from = Bound(e.parts[1]), to = Bound(e.parts[2]);
    const std::int64_t step = Bound(e.parts[3]).value_or(1);
    if (step == 0) throw Mistake("step of [::]", "0", "another number");
    const auto count = static_cast<std::int64_t>(size);
    const auto clip = [&](std::int64_t at) {
      if (at < 0) at += count;
      return step > 0 ? std::clamp<std::int64_t>(at, 0, count)
                      : std::clamp<std::int64_t>(at, -1, count - 1);
    };
    const std::int64_t first = from ? clip(*from) : (step > 0 ? 0 : count - 1);
    const std::int64_t last = to ? clip(*to) : (step > 0 ? count : -1);
    std::vector<std::size_t> places;
    for (std::int64_t at = first; step > 0 ? at < last : at > last; at += step) {
      places.push_back(static_cast<std::size_t>(at));
    }
    return places;
  }

  PythonValue Slice(const Expression& e) {
    const PythonValue of = Of(*e.parts[0]);
    if (const auto* list = of.list()) {
      PythonValue::Items items;
      for (const std::size_t at : Places(e, list->items.size())) items.push_back(list->items[at]);
      return PythonValue::ListOf(std::move(items), list->tuple);
    }
    if (of.text() == nullptr) throw Mistake("[:]", std::string(of.type()), "a list or text");
    const std::vector<std::size_t> offsets = CharacterOffsets(*of.text());
    budget_.Spend(offsets.size() * sizeof(std::size_t));
    std::string text;
    for (const std::size_t at : Places(e, offsets.size() - 1)) {
      text += of.text()->substr(offsets[at], offsets[at + 1] - offsets[at]);
    }
    return PythonValue(std::move(text));
  }

  Surroundings* NamespaceOf(const Expression& e) {
    if (e.kind == Kind::kName) {
      return in_.Property(e.text) == nullptr ? in_.Namespace(e.text) : nullptr;
    }
    if (e.kind != Kind::kAttribute) return nullptr;
    Surroundings* const outer = NamespaceOf(*e.parts[0]);
    return outer == nullptr ? nullptr : outer->Namespace(e.text);
  }

  /// "xacro", "math" or "python" if `e` names one of these and no property.
  std::string ModuleOf(const Expression& e) {
    const bool module = e.kind == Kind::kName &&
                        (e.text == "xacro" || e.text == "math" || e.text == "python") &&
                        in_.Property(e.text) == nullptr && in_.Namespace(e.text) == nullptr;
    return module ? e.text : "";
  }

  PythonValue Attribute(const Expression& e) {
    if (Surroundings* const space = NamespaceOf(*e.parts[0])) {
      if (const PythonValue* const property = space->Property(e.text)) return *property;
      throw Mistake("unknown name in a namespace", fmt::format("'{}'", e.text), "a property of it");
    }
    if (!ModuleOf(*e.parts[0]).empty()) {
      if (const auto constant = ConstantNamed(e.text)) return PythonValue(*constant);
      throw Mistake("attribute", fmt::format("'{}'", e.text), "a function that is called, or pi");
    }
    const PythonValue of = Of(*e.parts[0]);
    if (of.dict() == nullptr) {
      throw Mistake(fmt::format("attribute '{}'", e.text), std::string(of.type()),
                    "a dictionary, or the call of a method");
    }
    return Item(of, PythonValue(e.text));
  }

  PythonValue Call(const Expression& e) {
    const Expression& callee = *e.parts[0];
    Arguments arguments{AllOf(e, 1), {}};
    for (std::size_t i = 0; i < e.words.size(); ++i) {
      PythonValue& value = arguments.values[arguments.values.size() - e.words.size() + i];
      arguments.named.emplace_back(e.words[i], std::move(value));
    }
    arguments.values.resize(arguments.values.size() - e.words.size());
    for (const PythonValue& value : arguments.values) budget_.Spend(SizeOf(value));
    if (callee.kind == Kind::kName) {
      if (callee.text == "load_yaml" || callee.text == "abs_filename" || callee.text == "dotify") {
        return in_.CallXacro(callee.text, arguments);
      }
      return CallFunction(callee.text, arguments, budget_);
    }
    if (callee.kind != Kind::kAttribute) throw Mistake("call", "a value", "a function's name");
    const std::string module = ModuleOf(*callee.parts[0]);
    if (module == "xacro") return in_.CallXacro(callee.text, arguments);
    if (!module.empty()) return CallFunction(callee.text, arguments, budget_);
    const PythonValue of = Of(*callee.parts[0]);
    for (const PythonValue& value : arguments.values) budget_.Spend(SearchWork(of, value));
    return CallMethod(of, callee.text, arguments, budget_);
  }

  Surroundings& in_;
  Budget& budget_;
};

}  // namespace

PythonValue Evaluate(const Expression& expression, Surroundings& in, Budget& budget) {
  return Evaluation(in, budget).Of(expression);
}

PythonValue LiteralOf(const std::string& text) {
  if (text.size() >= 2 && text.front() == '\'' && text.back() == '\'') {
    return PythonValue(text.substr(1, text.size() - 2));
  }
  if (text.size() > 100 || text.find('_') != std::string::npos) return PythonValue(text);
  if (const auto whole = WholeOf(text)) return PythonValue(*whole);
  const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
  if (digits) return PythonValue(text);  // empty, or a whole number beyond 64 bits
  if (const auto number = NumberOf(text)) return PythonValue(*number);
  if (text == "true" || text == "True") return PythonValue(true);
  if (text == "false" || text == "False") return PythonValue(false);
  return PythonValue(text);
}

}  // namespace oca::robot::xacro
