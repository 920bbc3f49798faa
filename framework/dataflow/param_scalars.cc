// SPDX-License-Identifier: BSD-3-Clause
// The parameter types of one value: numbers, texts, periods, vectors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/param_numbers.h"
#include "oca/framework/dataflow/params.h"

namespace oca {
namespace {

using internal::AddMismatch;
using internal::CheckNumber;
using internal::NameOfItem;
using internal::NumberJson;
using internal::NumberSchema;
using internal::ReadNumber;
using nlohmann::ordered_json;

bool SameNumber(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

class NumberType final : public ParamType {
 public:
  std::string Name() const override { return "number"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    ReadNumber(value, field, where, *static_cast<double*>(target), problems);
  }
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    CheckNumber(*static_cast<const double*>(value), field, where, problems);
  }
  bool Same(const void* a, const void* b) const override {
    return SameNumber(*static_cast<const double*>(a), *static_cast<const double*>(b));
  }
  ordered_json ToJson(const void* value) const override {
    return NumberJson(*static_cast<const double*>(value));
  }
  ordered_json Schema(const FieldInfo& field) const override { return NumberSchema(field); }
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
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    CheckNumber(*static_cast<const int*>(value), field, where, problems);
  }
  ordered_json ToJson(const void* value) const override { return *static_cast<const int*>(value); }
  ordered_json Schema(const FieldInfo& field) const override {
    return NumberSchema(field, "integer");
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
  void Check(const void* /*value*/, const FieldInfo& /*field*/, const std::string& /*where*/,
             std::vector<std::string>& /*problems*/) const override {}
  ordered_json ToJson(const void* value) const override { return *static_cast<const bool*>(value); }
  ordered_json Schema(const FieldInfo& /*field*/) const override { return {{"type", "boolean"}}; }
};

class StringType final : public ParamType {
 public:
  std::string Name() const override { return "text"; }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    if (value.string() == nullptr) return AddMismatch(value, where, "text", problems);
    *static_cast<std::string*>(target) = *value.string();
  }
  void Check(const void* /*value*/, const FieldInfo& /*field*/, const std::string& /*where*/,
             std::vector<std::string>& /*problems*/) const override {}
  ordered_json ToJson(const void* value) const override {
    return *static_cast<const std::string*>(value);
  }
  ordered_json Schema(const FieldInfo& /*field*/) const override { return {{"type", "string"}}; }
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
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    CheckNumber(static_cast<const Period*>(value)->seconds(), field, where, problems);
  }
  ordered_json ToJson(const void* value) const override {
    return NumberJson(static_cast<const Period*>(value)->seconds());
  }
  ordered_json Schema(const FieldInfo& field) const override { return NumberSchema(field); }
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
    const Value& item = (*value.list())[i];
    Problems any;
    if (ReadNumber(item, field, where, out[i], any)) continue;
    good =
        ReadNumber(item, field, NameOfItem(where, static_cast<std::size_t>(i)), out[i], problems);
  }
  return good;
}

void CheckNumbers(const Eigen::VectorXd& values, const FieldInfo& field, const std::string& where,
                  std::vector<std::string>& problems) {
  if (values.size() == 0) {
    problems.push_back(fmt::format("{}: got a list of 0; expected at least one number", where));
  }
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    std::vector<std::string> any;
    CheckNumber(values[i], field, where, any);
    if (!any.empty())
      CheckNumber(values[i], field, NameOfItem(where, static_cast<std::size_t>(i)), problems);
  }
}

ordered_json NumbersJson(const double* values, Eigen::Index size) {
  ordered_json list = ordered_json::array();
  for (Eigen::Index i = 0; i < size; ++i) list.push_back(NumberJson(values[i]));
  return list;
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
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    const auto& values = *static_cast<const PerComponent*>(value);
    if (values.scalar()) return CheckNumber(values[0], field, where, problems);
    CheckNumbers(values.values(), field, where, problems);
  }
  bool Same(const void* a, const void* b) const override {
    const auto& one = *static_cast<const PerComponent*>(a);
    const auto& other = *static_cast<const PerComponent*>(b);
    return one.scalar() == other.scalar() && one.values().size() == other.values().size() &&
           std::equal(one.values().begin(), one.values().end(), other.values().begin(), SameNumber);
  }
  ordered_json ToJson(const void* value) const override {
    const auto& values = *static_cast<const PerComponent*>(value);
    return values.scalar() ? NumberJson(values[0])
                           : NumbersJson(values.values().data(), values.values().size());
  }
  ordered_json Schema(const FieldInfo& field) const override {
    // One schema for both, for bounds speak of numbers and the rest of lists: an editor then says
    // what is wrong with either, and not that no alternative fits.
    ordered_json schema = NumberSchema(field);
    schema["items"] = schema;
    schema["type"] = {"number", "array"};
    schema["minItems"] = 1;
    return schema;
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
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    CheckNumbers(*static_cast<const Eigen::VectorXd*>(value), field, where, problems);
  }
  ordered_json ToJson(const void* value) const override {
    const auto& values = *static_cast<const Eigen::VectorXd*>(value);
    return NumbersJson(values.data(), values.size());
  }
  ordered_json Schema(const FieldInfo& field) const override {
    return {{"type", "array"}, {"items", NumberSchema(field)}, {"minItems", 1}};
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
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    CheckNumbers(*static_cast<const Eigen::Vector3d*>(value), field, where, problems);
  }
  ordered_json ToJson(const void* value) const override {
    return NumbersJson(static_cast<const Eigen::Vector3d*>(value)->data(), 3);
  }
  ordered_json Schema(const FieldInfo& field) const override {
    return {{"type", "array"}, {"items", NumberSchema(field)}, {"minItems", 3}, {"maxItems", 3}};
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
