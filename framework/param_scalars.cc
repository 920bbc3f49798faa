// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "framework/error.h"
#include "framework/param_numbers.h"
#include "framework/params.h"
#include "framework/signal.h"

namespace oca {
namespace {

using internal::AddMismatch;
using internal::NumberSchema;
using internal::ReadNumber;
using internal::ShowNumber;
using nlohmann::ordered_json;

class NumberType final : public ParamType {
 public:
  std::string Name() const override { return "number"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    ReadNumber(value, field, where, *static_cast<double*>(target), problems);
  }
  std::string Show(const void* value) const override {
    return ShowNumber(*static_cast<const double*>(value));
  }
  std::string Schema(const FieldInfo& field) const override { return NumberSchema(field).dump(); }
};

class IntegerType final : public ParamType {
 public:
  std::string Name() const override { return "integer"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    double number = 0.0;
    if (!ReadNumber(value, field, where, number, problems)) return;
    if (number != std::floor(number) || std::fabs(number) > std::numeric_limits<int>::max()) {
      return AddMismatch(value, where, "an integer", problems);
    }
    *static_cast<int*>(target) = static_cast<int>(number);
  }
  std::string Show(const void* value) const override {
    return fmt::format("{}", *static_cast<const int*>(value));
  }
  std::string Schema(const FieldInfo& field) const override {
    return NumberSchema(field, "integer").dump();
  }
};

class BooleanType final : public ParamType {
 public:
  std::string Name() const override { return "true or false"; }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    if (value.boolean() == nullptr) return AddMismatch(value, where, "true or false", problems);
    *static_cast<bool*>(target) = *value.boolean();
  }
  std::string Show(const void* value) const override {
    return *static_cast<const bool*>(value) ? "true" : "false";
  }
  std::string Schema(const FieldInfo& /*field*/) const override { return R"({"type":"boolean"})"; }
};

class StringType final : public ParamType {
 public:
  std::string Name() const override { return "text"; }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    if (value.string() == nullptr) return AddMismatch(value, where, "text", problems);
    *static_cast<std::string*>(target) = *value.string();
  }
  std::string Show(const void* value) const override {
    return ordered_json(*static_cast<const std::string*>(value)).dump();
  }
  std::string Schema(const FieldInfo& /*field*/) const override { return R"({"type":"string"})"; }
};

class PeriodType final : public ParamType {
 public:
  std::string Name() const override { return "seconds, exact"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    double seconds = 0.0;
    if (!ReadNumber(value, field, where, seconds, problems)) return;
    try {
      *static_cast<Period*>(target) = Period::FromSeconds(seconds);
    } catch (const ConfigError& error) {
      problems.Add(value.location(), fmt::format("{}: {}", where, error.what()));
    }
  }
  std::string Show(const void* value) const override {
    return fmt::format("{}", static_cast<const Period*>(value)->seconds());
  }
  std::string Schema(const FieldInfo& field) const override { return NumberSchema(field).dump(); }
};

/// A list of numbers of any length, or of a fixed one; optionally a lone number.
bool ReadNumbers(const Value& value, const FieldInfo& field, const std::string& where,
                 Eigen::Index length, Eigen::VectorXd& out, Problems& problems) {
  const auto expected = [&] {
    return length < 0 ? std::string("a list of numbers")
                      : fmt::format("a list of {} numbers", length);
  };
  if (value.list() == nullptr) {
    AddMismatch(value, where, expected(), problems);
    return false;
  }
  const auto size = static_cast<Eigen::Index>(value.list()->size());
  if ((length >= 0 && size != length) || size == 0) {
    problems.Add(value.location(), fmt::format("{}: got a list of {}; expected {}", where, size,
                                               length < 0 ? "at least one number" : expected()));
    return false;
  }
  out.resize(size);
  bool good = true;
  for (Eigen::Index i = 0; i < size; ++i) {
    good &=
        ReadNumber((*value.list())[i], field, fmt::format("{}[{}]", where, i), out[i], problems);
  }
  return good;
}

std::string ShowNumbers(const double* values, Eigen::Index size) {
  std::string text;
  WriteVectorJson(values, static_cast<std::size_t>(size), text);
  return text;
}

class PerComponentType final : public ParamType {
 public:
  std::string Name() const override { return "number or list"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    if (value.list() == nullptr) {
      double scalar = 0.0;
      double probe = 0.0;
      if (!value.number(probe)) return AddMismatch(value, where, "a number or a list", problems);
      if (!ReadNumber(value, field, where, scalar, problems)) return;
      *static_cast<PerComponent*>(target) = PerComponent(scalar);
      return;
    }
    Eigen::VectorXd numbers;
    if (ReadNumbers(value, field, where, -1, numbers, problems)) {
      *static_cast<PerComponent*>(target) = PerComponent(numbers);
    }
  }
  std::string Show(const void* value) const override {
    const auto& values = *static_cast<const PerComponent*>(value);
    return values.scalar() ? ShowNumber(values[0])
                           : ShowNumbers(values.values().data(), values.values().size());
  }
  std::string Schema(const FieldInfo& field) const override {
    // One schema for both, for bounds speak of numbers and the rest of lists: an editor then says
    // what is wrong with either, and not that no alternative fits.
    ordered_json schema = NumberSchema(field);
    schema["items"] = schema;
    schema["type"] = {"number", "array"};
    schema["minItems"] = 1;
    return schema.dump();
  }
};

class VectorType final : public ParamType {
 public:
  std::string Name() const override { return "list of numbers"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    Eigen::VectorXd numbers;
    if (ReadNumbers(value, field, where, -1, numbers, problems)) {
      *static_cast<Eigen::VectorXd*>(target) = numbers;
    }
  }
  std::string Show(const void* value) const override {
    const auto& values = *static_cast<const Eigen::VectorXd*>(value);
    return ShowNumbers(values.data(), values.size());
  }
  std::string Schema(const FieldInfo& field) const override {
    return ordered_json{{"type", "array"}, {"items", NumberSchema(field)}, {"minItems", 1}}.dump();
  }
};

class Vector3Type final : public ParamType {
 public:
  std::string Name() const override { return "list of 3 numbers"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    Eigen::VectorXd numbers;
    if (ReadNumbers(value, field, where, 3, numbers, problems)) {
      *static_cast<Eigen::Vector3d*>(target) = numbers;
    }
  }
  std::string Show(const void* value) const override {
    return ShowNumbers(static_cast<const Eigen::Vector3d*>(value)->data(), 3);
  }
  std::string Schema(const FieldInfo& field) const override {
    return ordered_json{
        {"type", "array"}, {"items", NumberSchema(field)}, {"minItems", 3}, {"maxItems", 3}}
        .dump();
  }
};

template <class Type>
const ParamType& Shared() {
  static const Type type;
  return type;
}

}  // namespace

template <>
const ParamType& ParamTypeOf<double>() {
  return Shared<NumberType>();
}
template <>
const ParamType& ParamTypeOf<int>() {
  return Shared<IntegerType>();
}
template <>
const ParamType& ParamTypeOf<bool>() {
  return Shared<BooleanType>();
}
template <>
const ParamType& ParamTypeOf<std::string>() {
  return Shared<StringType>();
}
template <>
const ParamType& ParamTypeOf<Period>() {
  return Shared<PeriodType>();
}
template <>
const ParamType& ParamTypeOf<PerComponent>() {
  return Shared<PerComponentType>();
}
template <>
const ParamType& ParamTypeOf<Eigen::VectorXd>() {
  return Shared<VectorType>();
}
template <>
const ParamType& ParamTypeOf<Eigen::Vector3d>() {
  return Shared<Vector3Type>();
}

}  // namespace oca
