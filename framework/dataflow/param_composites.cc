// SPDX-License-Identifier: BSD-3-Clause
// The parameter types made of others: words of an enum, lists, what may be left out.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/nearest.h"
#include "oca/framework/dataflow/param_numbers.h"
#include "oca/framework/dataflow/params.h"

namespace oca {
namespace {

using internal::AddMismatch;
using internal::NameOfItem;
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
  void Check(const void* value, const FieldInfo& /*field*/, const std::string& where,
             std::vector<std::string>& problems) const override {
    if (Has(get_(value))) return;
    problems.push_back(
        fmt::format("{}: got {}; expected one of {}", where, get_(value), fmt::join(names_, ", ")));
  }
  ordered_json ToJson(const void* value) const override {
    const int index = get_(value);
    return Has(index) ? ordered_json(names_[static_cast<std::size_t>(index)]) : ordered_json();
  }
  ordered_json Schema(const FieldInfo& /*field*/) const override { return {{"enum", names_}}; }

 private:
  bool Has(int index) const { return index >= 0 && index < static_cast<int>(names_.size()); }

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
      item_.Read((*value.list())[i], field, NameOfItem(where, i), append_(target), problems);
    }
  }
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    for (std::size_t i = 0; i < size_(value); ++i) {
      std::vector<std::string> any;
      item_.Check(at_(value, i), field, where, any);
      if (!any.empty()) item_.Check(at_(value, i), field, NameOfItem(where, i), problems);
    }
  }
  ordered_json ToJson(const void* value) const override {
    ordered_json list = ordered_json::array();
    for (std::size_t i = 0; i < size_(value); ++i) list.push_back(item_.ToJson(at_(value, i)));
    return list;
  }
  ordered_json Schema(const FieldInfo& field) const override {
    return {{"type", "array"}, {"items", item_.Schema(field)}};
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
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    if (const void* const item = get_(value)) item_.Check(item, field, where, problems);
  }
  bool Same(const void* a, const void* b) const override {
    const void* const one = get_(a);
    const void* const other = get_(b);
    return one == nullptr || other == nullptr ? one == other : item_.Same(one, other);
  }
  ordered_json ToJson(const void* value) const override {
    const void* const item = get_(value);
    return item == nullptr ? ordered_json() : item_.ToJson(item);
  }
  ordered_json Schema(const FieldInfo& field) const override { return item_.Schema(field); }

 private:
  const ParamType& item_;
  std::function<void*(void*)> engage_;
  std::function<const void*(const void*)> get_;
};

class StructType final : public ParamType {
 public:
  StructType(const std::vector<Field>& (*fields)(), std::shared_ptr<const void> defaults)
      : fields_(fields), defaults_(std::move(defaults)) {}
  std::string Name() const override {
    std::vector<std::string> keys;
    for (const Field& field : fields_()) keys.push_back(field.key);
    return fmt::format("{{{}}}", fmt::join(keys, ", "));
  }
  void Read(const Value& value, const FieldInfo& /*field*/, const std::string& where, void* target,
            Problems& problems) const override {
    ReadFields(value, fields_(), where, target, problems);
  }
  void Check(const void* value, const FieldInfo& /*field*/, const std::string& where,
             std::vector<std::string>& problems) const override {
    CheckFields(fields_(), value, defaults_.get(), where, problems);
  }
  ordered_json ToJson(const void* value) const override { return JsonOfFields(fields_(), value); }
  ordered_json Schema(const FieldInfo& /*field*/) const override {
    return SchemaOfFields(fields_(), defaults_.get());
  }

 private:
  const std::vector<Field>& (*fields_)();
  const std::shared_ptr<const void> defaults_;
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
                                          std::shared_ptr<const void> defaults) {
  return std::make_unique<StructType>(fields, std::move(defaults));
}

}  // namespace internal

}  // namespace oca
