// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace oca {

/// Where a value was written: a file with line and column (from 1), or an option such as `-s`.
struct Location {
  std::shared_ptr<const std::string> file;
  int line{0};  ///< 0: the source has no lines
  int column{0};
  /// `file:line:column`
  std::string ToString() const;
};

/// A tree of parameters as read from YAML or JSON, every node knowing where it stands. Copies share
/// what they hold until one of them changes it, so that copying a tree costs nothing.
class Value {
 public:
  struct Entry;
  using List = std::vector<Value>;
  using Map = std::vector<Entry>;  ///< in the order of the file; keys are unique
  using Data = std::variant<std::monostate, bool, std::int64_t, double, std::string, List, Map>;

  // Defined where Entry is complete.
  Value();
  Value(Data data, Location location);
  Value(const Value& other);
  Value(Value&& other) noexcept;
  Value& operator=(const Value& other);
  Value& operator=(Value&& other) noexcept;
  ~Value();

  const Location& location() const { return location_; }
  /// The same, standing elsewhere.
  Value At(Location location) const;
  /// Which alternative of Data it holds.
  std::size_t kind() const { return data_.index(); }

  bool null() const { return std::holds_alternative<std::monostate>(data_); }
  const bool* boolean() const { return std::get_if<bool>(&data_); }
  const std::int64_t* integer() const { return std::get_if<std::int64_t>(&data_); }
  const std::string* string() const { return std::get_if<std::string>(&data_); }
  const List* list() const;
  const Map* map() const;
  /// To be changed; those that point into a copy of this value then point elsewhere.
  List* list();
  Map* map();
  /// Whether both hold one list or map, not only equal ones.
  bool Shares(const Value& other) const;
  /// The number, integers included; returns false if there is none.
  bool number(double& out) const;
  /// The entry of a map; nullptr if this is no map or has no such key.
  const Value* Find(const std::string& key) const;
  /// For messages: `7`, `'text'`, `a list`, `a map`.
  std::string Show() const;

 private:
  using Held = std::variant<std::monostate, bool, std::int64_t, double, std::string,
                            std::shared_ptr<List>, std::shared_ptr<Map>>;
  static Held Hold(Data data);

  Held data_;
  Location location_;
};

struct Value::Entry {
  std::string key;
  Location location;  ///< of the key
  Value value;
};

/// What is wrong at a place in a file, or to be warned of.
struct Diagnostic {
  enum class Kind { kError, kWarning };
  Location location;
  std::string what;
  Kind kind{Kind::kError};
  /// `file:line:column: error: what`
  std::string ToString() const;
};

/// Collects the problems of a file, so that a person sees all of them at once.
class Problems {
 public:
  void Add(const Location& location, const std::string& what);
  /// Adds the problems of another collection.
  void Add(const Problems& others);
  bool empty() const { return all_.empty(); }
  const std::vector<Diagnostic>& all() const { return all_; }
  /// throws ConfigError with all problems, a line each, if there are any.
  void Throw() const;

 private:
  std::vector<Diagnostic> all_;
};

}  // namespace oca
