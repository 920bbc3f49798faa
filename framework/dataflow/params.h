// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/per_component.h"
#include "oca/framework/dataflow/period.h"
#include "oca/framework/dataflow/value.h"

namespace oca {

/// The closed or open interval that numbers of a parameter must lie in.
struct Bounds {
  double lower{-std::numeric_limits<double>::infinity()};
  double upper{std::numeric_limits<double>::infinity()};
  bool above{false};  ///< lower itself is excluded
  bool Contains(double x) const { return (above ? x > lower : x >= lower) && x <= upper; }
  /// `> 0`, `in [0, 1]`, or empty if there are none.
  std::string ToString() const;
};

/// What one field of a Params struct is, told once, read by files, `describe` and schema.
struct FieldInfo {
  std::string key;
  std::string unit;  ///< empty: none
  std::string meaning;
  bool required{false};
  Bounds bounds{};
};

/// How values of one C++ type are read, shown and described.
class ParamType {
 public:
  virtual ~ParamType() = default;
  /// `number`, `list of 3 numbers`, ...
  virtual std::string Name() const = 0;
  /// Reads `value` into `*target`, adding to `problems` what is wrong, `where` saying which field.
  virtual void Read(const Value& value, const FieldInfo& field, const std::string& where,
                    void* target, Problems& problems) const = 0;
  /// Adds to `problems` what Read would have refused of a value that was set in C++.
  virtual void Check(const void* value, const FieldInfo& field, const std::string& where,
                     std::vector<std::string>& problems) const = 0;
  /// Whether two values are one, NaN equal to itself.
  virtual bool Same(const void* a, const void* b) const;
  /// The value as JSON; null if JSON cannot say it.
  virtual nlohmann::ordered_json ToJson(const void* value) const = 0;
  /// JSON Schema, without the description.
  virtual nlohmann::ordered_json Schema(const FieldInfo& field) const = 0;
};

template <class T>
const ParamType& ParamTypeOf();

/// A field of one Params struct.
struct Field : FieldInfo {
  const ParamType* type{nullptr};
  std::function<void*(void*)> member;
};

/// The fields of a Params struct P; P::Describe fills it:
///
///     static void Describe(Fields<Params>& fields) {
///       fields.Add("force_gain", &Params::force_gain, "N m^3", "gain eta").AtLeast(0);
///     }
template <class P>
class Fields {
 public:
  /// Refines the field added last.
  class Refine {
   public:
    explicit Refine(Field& field) : field_(field) {}
    Refine& AtLeast(double lower) { return field_.bounds.lower = lower, *this; }
    Refine& AtMost(double upper) { return field_.bounds.upper = upper, *this; }
    Refine& Above(double lower) {
      field_.bounds.above = true;
      return AtLeast(lower);
    }
    Refine& Required() { return field_.required = true, *this; }

   private:
    Field& field_;
  };

  template <class T>
  Refine Add(std::string key, T P::*member, std::string unit, std::string meaning) {
    Field field{{std::move(key), std::move(unit), std::move(meaning)}, &ParamTypeOf<T>(), {}};
    field.member = [member](void* params) -> void* { return &(static_cast<P*>(params)->*member); };
    all_.push_back(std::move(field));
    return Refine(all_.back());
  }
  /// The fields of a member, a Params struct itself, as if they were its own.
  template <class Part>
  void Include(Part P::*part);
  const std::vector<Field>& all() const { return all_; }

 private:
  std::vector<Field> all_;
};

template <class P>
concept ParamsStruct = std::default_initializable<P> && requires(Fields<P>& fields) {
  P::Describe(fields);
};

template <ParamsStruct P>
const std::vector<Field>& FieldsOf() {
  static const Fields<P> fields = [] {
    Fields<P> result;
    P::Describe(result);
    return result;
  }();
  return fields.all();
}

template <class P>
template <class Part>
void Fields<P>::Include(Part P::*part) {
  for (Field field : FieldsOf<Part>()) {
    field.member = [part, inner = field.member](void* params) {
      return inner(&(static_cast<P*>(params)->*part));
    };
    all_.push_back(std::move(field));
  }
}

/// Reads a map into `*params`: unknown keys, missing required ones, wrong types and numbers out of
/// bounds or not finite are added to `problems`. `where` is empty or the path of the map. For a
/// Period field named `period` the key `frequency` (Hz) may stand instead.
void ReadFields(const Value& value, const std::vector<Field>& fields, const std::string& where,
                void* params, Problems& problems);
/// Adds to `problems` what ReadFields would have refused of a struct that was filled in C++. A
/// value that may be left out may be the default, even one that no file could say.
void CheckFields(const std::vector<Field>& fields, const void* params, const void* defaults,
                 const std::string& where, std::vector<std::string>& problems);
/// Without the values that JSON cannot say.
nlohmann::ordered_json JsonOfFields(const std::vector<Field>& fields, const void* params);
nlohmann::ordered_json SchemaOfFields(const std::vector<Field>& fields, const void* defaults);

/// throws ConfigError with all problems.
template <ParamsStruct P>
P ReadParams(const Value& value, const std::string& where = "") {
  Problems problems;
  P params;
  ReadFields(value, FieldsOf<P>(), where, &params, problems);
  problems.Throw();
  return params;
}

namespace internal {
/// throws ConfigError with all problems, if there are any.
void ThrowProblems(const std::vector<std::string>& problems);
}  // namespace internal

/// The parameters, if they are what their Describe says: constructors ask it, since a struct filled
/// in C++ has passed no reader. What Describe cannot say, how fields go together, is theirs to
/// check. `where` is empty or the path of the struct. throws ConfigError with all problems, a line
/// each
template <ParamsStruct P>
const P& Validated(const P& params, const std::string& where = "") {
  std::vector<std::string> problems;
  const P defaults{};
  CheckFields(FieldsOf<P>(), &params, &defaults, where, problems);
  internal::ThrowProblems(problems);
  return params;
}

/// An enumeration is a parameter type if `EnumNames(E)` returns the names of 0, 1, 2, ...
template <class E>
concept NamedEnum = std::is_enum_v<E> && requires(E e) {
  { EnumNames(e) } -> std::convertible_to<std::span<const char* const>>;
};

namespace internal {

template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

std::unique_ptr<ParamType> MakeEnumType(std::span<const char* const> names,
                                        std::function<int(const void*)> get,
                                        std::function<void(void*, int)> set);
std::unique_ptr<ParamType> MakeListType(const ParamType& item, std::function<void(void*)> clear,
                                        std::function<void*(void*)> append,
                                        std::function<std::size_t(const void*)> size,
                                        std::function<const void*(const void*, std::size_t)> at);
std::unique_ptr<ParamType> MakeOptionalType(const ParamType& item,
                                            std::function<void*(void*)> engage,
                                            std::function<const void*(const void*)> get);
std::unique_ptr<ParamType> MakeStructType(const std::vector<Field>& (*fields)(),
                                          std::shared_ptr<const void> defaults);

template <class T>
std::unique_ptr<ParamType> MakeType() {
  if constexpr (kIsVector<T>) {
    return MakeListType(
        ParamTypeOf<typename T::value_type>(), [](void* list) { static_cast<T*>(list)->clear(); },
        [](void* list) -> void* { return &static_cast<T*>(list)->emplace_back(); },
        [](const void* list) { return static_cast<const T*>(list)->size(); },
        [](const void* list, std::size_t i) -> const void* {
          return &(*static_cast<const T*>(list))[i];
        });
  } else if constexpr (kIsOptional<T>) {
    return MakeOptionalType(
        ParamTypeOf<typename T::value_type>(),
        [](void* value) -> void* { return &static_cast<T*>(value)->emplace(); },
        [](const void* value) -> const void* {
          const T& optional = *static_cast<const T*>(value);
          return optional ? &*optional : nullptr;
        });
  } else if constexpr (NamedEnum<T>) {
    return MakeEnumType(
        EnumNames(T{}), [](const void* e) { return static_cast<int>(*static_cast<const T*>(e)); },
        [](void* e, int index) { *static_cast<T*>(e) = static_cast<T>(index); });
  } else {
    static_assert(ParamsStruct<T>, "this type cannot be a parameter");
    return MakeStructType(&FieldsOf<T>, std::make_shared<const T>());
  }
}

}  // namespace internal

template <class T>
const ParamType& ParamTypeOf() {
  static const std::unique_ptr<ParamType> type = internal::MakeType<T>();
  return *type;
}
template <>
const ParamType& ParamTypeOf<double>();
template <>
const ParamType& ParamTypeOf<int>();
template <>
const ParamType& ParamTypeOf<bool>();
template <>
const ParamType& ParamTypeOf<std::string>();
template <>
const ParamType& ParamTypeOf<Period>();
template <>
const ParamType& ParamTypeOf<PerComponent>();
template <>
const ParamType& ParamTypeOf<Eigen::VectorXd>();
template <>
const ParamType& ParamTypeOf<Eigen::Vector3d>();

}  // namespace oca
