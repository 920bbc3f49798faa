// SPDX-License-Identifier: BSD-3-Clause
#include "framework/params.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/error.h"
#include "framework/nearest.h"
#include "framework/signal.h"

namespace oca {
namespace {

using nlohmann::ordered_json;

std::string WithUnit(const FieldInfo& field) { return field.unit.empty() ? "" : " " + field.unit; }

/// `where: got X; expected Y`
void AddMismatch(const Value& value, const std::string& where, const std::string& expected,
                 Problems& problems) {
  problems.Add(value.location(),
               fmt::format("{}: got {}; expected {}", where, value.Show(), expected));
}

bool ReadNumber(const Value& value, const FieldInfo& field, const std::string& where, double& out,
                Problems& problems) {
  double number = 0.0;
  if (!value.number(number)) {
    AddMismatch(value, where, "a number" + (field.unit.empty() ? "" : " in " + field.unit),
                problems);
    return false;
  }
  if (!std::isfinite(number)) {
    AddMismatch(value, where, "a finite number", problems);
    return false;
  }
  if (!field.bounds.Contains(number)) {
    problems.Add(value.location(), fmt::format("{}: got {}{}; expected {}", where, number,
                                               WithUnit(field), field.bounds.ToString()));
    return false;
  }
  out = number;
  return true;
}

void AddBounds(const Bounds& bounds, ordered_json& schema) {
  if (std::isfinite(bounds.lower)) {
    schema[bounds.above ? "exclusiveMinimum" : "minimum"] = bounds.lower;
  }
  if (std::isfinite(bounds.upper)) schema["maximum"] = bounds.upper;
}

ordered_json NumberSchema(const FieldInfo& field, const char* type = "number") {
  ordered_json schema{{"type", type}};
  AddBounds(field.bounds, schema);
  return schema;
}

/// Infinity and NaN, which mean none and unset, are null: JSON has no word for them.
std::string ShowNumber(double number) {
  return std::isfinite(number) ? fmt::format("{}", number) : "null";
}

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
    const ordered_json number = NumberSchema(field);
    const ordered_json list{{"type", "array"}, {"items", number}, {"minItems", 1}};
    return ordered_json{{"oneOf", ordered_json::array({number, list})}}.dump();
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

class EnumType final : public ParamType {
 public:
  EnumType(std::span<const char* const> names, std::function<int(const void*)> get,
           std::function<void(void*, int)> set)
      : names_(names.begin(), names.end()), get_(std::move(get)), set_(std::move(set)) {}
  std::string Name() const override { return fmt::format("{}", fmt::join(names_, " | ")); }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    const std::string* text = value.string();
    const auto found =
        text == nullptr ? names_.end() : std::find(names_.begin(), names_.end(), *text);
    if (found == names_.end()) {
      return AddMismatch(value, where,
                         fmt::format("one of {}{}", fmt::join(names_, ", "),
                                     text == nullptr ? "" : DidYouMean(*text, names_)),
                         problems);
    }
    set_(target, static_cast<int>(found - names_.begin()));
  }
  std::string Show(const void* value) const override { return '"' + names_.at(get_(value)) + '"'; }
  std::string Schema(const FieldInfo& /*field*/) const override {
    return ordered_json{{"enum", names_}}.dump();
  }

 private:
  std::vector<std::string> names_;
  std::function<int(const void*)> get_;
  std::function<void(void*, int)> set_;
};

class ListType final : public ParamType {
 public:
  ListType(const ParamType& item, std::function<void(void*)> clear,
           std::function<void*(void*)> append, std::function<std::size_t(const void*)> size,
           std::function<const void*(const void*, std::size_t)> at)
      : item_(item),
        clear_(std::move(clear)),
        append_(std::move(append)),
        size_(std::move(size)),
        at_(std::move(at)) {}
  std::string Name() const override { return "list of " + item_.Name(); }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    if (value.list() == nullptr) return AddMismatch(value, where, "a " + Name(), problems);
    clear_(target);
    for (std::size_t i = 0; i < value.list()->size(); ++i) {
      item_.Read((*value.list())[i], field, fmt::format("{}[{}]", where, i), append_(target),
                 problems);
    }
  }
  std::string Show(const void* value) const override {
    std::string text = "[";
    for (std::size_t i = 0; i < size_(value); ++i) {
      text += (i == 0 ? "" : ",") + item_.Show(at_(value, i));
    }
    return text + "]";
  }
  std::string Schema(const FieldInfo& field) const override {
    return ordered_json{{"type", "array"}, {"items", ordered_json::parse(item_.Schema(field))}}
        .dump();
  }

 private:
  const ParamType& item_;
  std::function<void(void*)> clear_;
  std::function<void*(void*)> append_;
  std::function<std::size_t(const void*)> size_;
  std::function<const void*(const void*, std::size_t)> at_;
};

class OptionalType final : public ParamType {
 public:
  OptionalType(const ParamType& item, std::function<void*(void*)> engage,
               std::function<const void*(const void*)> get)
      : item_(item), engage_(std::move(engage)), get_(std::move(get)) {}
  std::string Name() const override { return item_.Name(); }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    item_.Read(value, field, where, engage_(target), problems);
  }
  std::string Show(const void* value) const override {
    const void* item = get_(value);
    return item == nullptr ? "null" : item_.Show(item);
  }
  std::string Schema(const FieldInfo& field) const override { return item_.Schema(field); }

 private:
  const ParamType& item_;
  std::function<void*(void*)> engage_;
  std::function<const void*(const void*)> get_;
};

class StructType final : public ParamType {
 public:
  StructType(const std::vector<Field>& (*fields)(), std::function<std::shared_ptr<void>()> make)
      : fields_(fields), make_(std::move(make)) {}
  std::string Name() const override {
    std::vector<std::string> keys;
    for (const Field& field : fields_()) keys.push_back(field.key);
    return fmt::format("{{{}}}", fmt::join(keys, ", "));
  }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    ReadFields(value, fields_(), where, target, problems);
  }
  std::string Show(const void* value) const override { return ShowFields(fields_(), value); }
  std::string Schema(const FieldInfo& /*field*/) const override {
    return SchemaOfFields(fields_(), make_().get());
  }

 private:
  const std::vector<Field>& (*fields_)();
  std::function<std::shared_ptr<void>()> make_;
};

template <class Type>
const ParamType& Shared() {
  static const Type type;
  return type;
}

/// `frequency` (Hz) instead of `period`. Returns whether it stood there.
bool ReadFrequency(const Value& map, const Field& field, const std::string& prefix, void* params,
                   Problems& problems) {
  const Value* const value = map.Find("frequency");
  if (value == nullptr) return false;
  if (map.Find(field.key) != nullptr) {
    problems.Add(
        value->location(),
        fmt::format("{}frequency: got it beside {}; expected one of the two", prefix, field.key));
    return true;
  }
  FieldInfo info{"frequency", "Hz", "", false, {.lower = 0.0, .above = true}};
  double hertz = 0.0;
  if (!ReadNumber(*value, info, prefix + "frequency", hertz, problems)) return true;
  try {
    const Period inverse = Period::FromSeconds(hertz);
    *static_cast<Period*>(field.member(params)) =
        Period(inverse.denominator(), inverse.numerator());
  } catch (const ConfigError&) {
    AddMismatch(*value, prefix + "frequency", "a ratio of integers", problems);
  }
  return true;
}

}  // namespace

std::string Bounds::ToString() const {
  const bool below = std::isfinite(upper);
  if (std::isfinite(lower) && below) {
    return fmt::format("in {}{}, {}]", above ? "(" : "[", lower, upper);
  }
  if (std::isfinite(lower)) return fmt::format("{} {}", above ? ">" : ">=", lower);
  return below ? fmt::format("<= {}", upper) : "";
}

void ReadFields(const Value& value, const std::vector<Field>& fields, const std::string& where,
                void* params, Problems& problems) {
  const std::string prefix = where.empty() ? "" : where + ".";
  static const Value::Map kEmpty;
  if (value.map() == nullptr && !value.null()) {
    return AddMismatch(value, where.empty() ? "parameters" : where, "a map", problems);
  }
  std::vector<std::string> keys;
  for (const Field& field : fields) {
    keys.push_back(field.key);
    if (field.key == "period" && field.type == &ParamTypeOf<Period>()) {
      keys.emplace_back("frequency");
      if (ReadFrequency(value, field, prefix, params, problems)) continue;
    }
    if (const Value* const given = value.Find(field.key)) {
      if (given->null()) continue;  // whoever read the tree has said so
      field.type->Read(*given, field, prefix + field.key, field.member(params), problems);
    } else if (field.required) {
      problems.Add(value.location(), fmt::format("{}{}: missing; expected {}", prefix, field.key,
                                                 field.type->Name()));
    }
  }
  for (const Value::Entry& entry : value.map() == nullptr ? kEmpty : *value.map()) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    problems.Add(entry.location,
                 fmt::format("{}{}: unknown key{}; known: {}", prefix, entry.key,
                             DidYouMean(entry.key, keys),
                             keys.empty() ? "none" : fmt::format("{}", fmt::join(keys, ", "))));
  }
}

std::string ShowFields(const std::vector<Field>& fields, const void* params) {
  std::string text = "{";
  for (const Field& field : fields) {
    // Showing does not write; the accessor serves reading too.
    const std::string value = field.type->Show(field.member(const_cast<void*>(params)));
    if (value == "null") continue;
    text += fmt::format("{}\"{}\":{}", text.size() > 1 ? "," : "", field.key, value);
  }
  return text + "}";
}

std::string SchemaOfFields(const std::vector<Field>& fields, const void* defaults) {
  ordered_json properties = ordered_json::object();
  ordered_json required = ordered_json::array();
  for (const Field& field : fields) {
    ordered_json schema = ordered_json::parse(field.type->Schema(field));
    schema["description"] =
        field.unit.empty() ? field.meaning : fmt::format("{} [{}]", field.meaning, field.unit);
    if (field.required) {
      required.push_back(field.key);
    } else {
      const auto shown =
          ordered_json::parse(field.type->Show(field.member(const_cast<void*>(defaults))));
      if (!shown.is_null()) schema["default"] = shown;
    }
    properties[field.key] = std::move(schema);
    if (field.key == "period" && field.type == &ParamTypeOf<Period>()) {
      properties["frequency"] = {
          {"type", "number"}, {"exclusiveMinimum", 0}, {"description", "instead of period [Hz]"}};
      if (field.required) required.erase(required.size() - 1);
    }
  }
  ordered_json schema{
      {"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
  if (!required.empty()) schema["required"] = required;
  return schema.dump();
}

namespace internal {

std::unique_ptr<ParamType> MakeEnumType(std::span<const char* const> names,
                                        std::function<int(const void*)> get,
                                        std::function<void(void*, int)> set) {
  return std::make_unique<EnumType>(names, std::move(get), std::move(set));
}

std::unique_ptr<ParamType> MakeListType(const ParamType& item, std::function<void(void*)> clear,
                                        std::function<void*(void*)> append,
                                        std::function<std::size_t(const void*)> size,
                                        std::function<const void*(const void*, std::size_t)> at) {
  return std::make_unique<ListType>(item, std::move(clear), std::move(append), std::move(size),
                                    std::move(at));
}

std::unique_ptr<ParamType> MakeOptionalType(const ParamType& item,
                                            std::function<void*(void*)> engage,
                                            std::function<const void*(const void*)> get) {
  return std::make_unique<OptionalType>(item, std::move(engage), std::move(get));
}

std::unique_ptr<ParamType> MakeStructType(const std::vector<Field>& (*fields)(),
                                          std::function<std::shared_ptr<void>()> make) {
  return std::make_unique<StructType>(fields, std::move(make));
}

}  // namespace internal

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
