// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "oca/framework/dataflow/error_base.h"

namespace oca::robot::xacro {

/// What is wrong with an expression or an element; who knows the place adds it.
class Mistake : public Error {
 public:
  /// "what; got X; expected Y"
  Mistake(std::string_view what, std::string_view got, std::string_view expected);
  explicit Mistake(const std::string& text) : Error(text) {}
};

/// A value of an expression, with the types, texts and comparisons of Python, whose whole numbers
/// end at 64 bits. Lists, tuples and dictionaries are immutable and shared.
class PythonValue {
 public:
  using Items = std::vector<PythonValue>;
  using Entries = std::vector<std::pair<PythonValue, PythonValue>>;
  struct List {
    Items items;
    bool tuple{false};
    int depth{1};
  };
  struct Dict {
    Entries entries;  // each key once
    int depth{1};
  };
  using ListPtr = std::shared_ptr<const List>;
  using DictPtr = std::shared_ptr<const Dict>;

  PythonValue() = default;  ///< None
  explicit PythonValue(bool value) : data_(value) {}
  explicit PythonValue(std::int64_t value) : data_(value) {}
  explicit PythonValue(double value) : data_(value) {}
  explicit PythonValue(std::string value) : data_(std::move(value)) {}
  /// throws Mistake if it nests deeper than 64 levels
  static PythonValue ListOf(Items items, bool tuple = false);
  /// Of entries with equal keys the last one counts. throws Mistake as ListOf
  static PythonValue DictOf(Entries entries);

  bool none() const { return std::holds_alternative<std::monostate>(data_); }
  const bool* boolean() const { return std::get_if<bool>(&data_); }
  const std::string* text() const { return std::get_if<std::string>(&data_); }
  const List* list() const;
  const Dict* dict() const;
  bool is_float() const { return std::holds_alternative<double>(data_); }
  /// A whole number or a boolean, which counts as 0 or 1.
  bool is_whole() const;
  bool is_number() const { return is_float() || is_whole(); }
  std::int64_t whole() const;  ///< of is_whole()
  double number() const;       ///< of is_number()

  /// "int", "str", ..., as in messages.
  std::string_view type() const;
  bool truth() const;

 private:
  std::variant<std::monostate, bool, std::int64_t, double, std::string, ListPtr, DictPtr> data_;
};

/// The value of a key; nullptr if there is none.
const PythonValue* Find(const PythonValue::Dict& dict, const PythonValue& key);

/// As Python's == and <. throws Mistake where Python has no order
bool Equal(const PythonValue& a, const PythonValue& b);
bool Less(const PythonValue& a, const PythonValue& b);

/// As Python's str() and repr(). throws Mistake if it is longer than kMostText
std::string ToText(const PythonValue& value);
std::string Repr(const PythonValue& value);
/// The same, cut for messages.
std::string Shown(const PythonValue& value);

inline constexpr std::size_t kMostText = 1'000'000;  ///< bytes of one text
inline constexpr std::size_t kMostItems = 100'000;   ///< of one list or dictionary

}  // namespace oca::robot::xacro
