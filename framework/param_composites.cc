// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/nearest.h"
#include "framework/param_numbers.h"
#include "framework/params.h"

namespace oca {
namespace {

using internal::AddMismatch;
using nlohmann::ordered_json;

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

}  // namespace

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

}  // namespace oca
