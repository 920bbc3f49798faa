// SPDX-License-Identifier: BSD-3-Clause
// Parameters that expressions use, and what is taken over from earlier expressions of the file.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "oca/diagrams/files/arithmetic.h"
#include "oca/diagrams/files/expression.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::files {
namespace {

constexpr std::size_t kLargestCopies = 100000;
constexpr int kLongestChain = 100;

/// Values in a tree; a text counts for every 16 characters.
std::size_t SizeOf(const Value& value) {
  std::size_t size = 1;
  if (value.string() != nullptr) size += value.string()->size() / 16;
  if (value.list() != nullptr) {
    for (const Value& item : *value.list()) size += SizeOf(item);
  }
  if (value.map() != nullptr) {
    for (const Value::Entry& entry : *value.map()) size += SizeOf(entry.value);
  }
  return size;
}

bool IsSamePlace(const Location& a, const Location& b) {
  if (a.line != b.line || a.column != b.column) return false;
  return a.file == b.file || (a.file && b.file && *a.file == *b.file);
}

/// Whether two values are one, written in one place; lists and maps only if they are shared.
bool IsSame(const Value& a, const Value& b) {
  if (a.kind() != b.kind() || !IsSamePlace(a.location(), b.location())) return false;
  if (a.boolean() != nullptr) return *a.boolean() == *b.boolean();
  if (a.string() != nullptr) return *a.string() == *b.string();
  if (a.integer() != nullptr) return *a.integer() == *b.integer();
  double x = 0.0, y = 0.0;
  if (a.number(x) && b.number(y)) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  }
  return a.null() || a.Shares(b);
}

/// The list or map that a value holds; nullptr if it is something else.
const void* HeldBy(const Value& value) {
  if (value.list() != nullptr) return value.list();
  return value.map();
}

bool HasExpression(const Value& value) {
  return value.string() != nullptr && value.string()->find("${") != std::string::npos;
}

/// Whether what an expression may stand in came out as it was.
bool IsAsWritten(const Value& resolved, const Value& written) {
  return HeldBy(written) != nullptr ? resolved.Shares(written) : !HasExpression(written);
}

}  // namespace

Expressions::Expressions(const Value& parameters, Problems& problems,
                         std::shared_ptr<const Resolution> earlier)
    : written_(parameters), earlier_(std::move(earlier)), problems_(problems) {
  if (written_.map() == nullptr) return;
  parameters_.reserve(written_.map()->size());
  for (const Value::Entry& entry : *written_.map()) {
    if (IsName(entry.key) && !IsReserved(entry.key)) {
      parameters_.push_back({&entry});
      continue;
    }
    problems_.Add(entry.location, fmt::format("parameters.{}: not a free name; expected letters, "
                                              "digits and underscores, not pi, deg or a function",
                                              entry.key));
  }
  std::sort(parameters_.begin(), parameters_.end(),
            [](const auto& a, const auto& b) { return a.entry->key < b.entry->key; });
  if (earlier_ != nullptr) FindUnchanged();
  for (Parameter& parameter : parameters_) ValueOf(parameter, parameter.entry->value.location());
}

/// Nothing is, unless the parameters have the same names: they mean what they meant.
void Expressions::FindUnchanged() {
  const auto named_alike = [](const Parameter& parameter, const Resolution::PartPtr& part) {
    return parameter.entry->key == part->name;
  };
  if (!std::equal(parameters_.begin(), parameters_.end(), earlier_->parameters.begin(),
                  earlier_->parameters.end(), named_alike)) {
    earlier_ = nullptr;
    return;
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Resolution::PartPtr& part = earlier_->parameters[i];
    if (IsSame(parameters_[i].entry->value, part->written)) parameters_[i].earlier = part;
  }
  for (bool changed = true; changed;) {  // what uses a parameter that has changed has changed too
    changed = false;
    for (Parameter& parameter : parameters_) {
      if (parameter.earlier == nullptr || IsUnchanged(*parameter.earlier)) continue;
      parameter.earlier = nullptr;
      changed = true;
    }
  }
}

bool Expressions::IsUnchanged(const Resolution::Part& part) const {
  return std::all_of(part.used.begin(), part.used.end(), [this](std::size_t parameter) {
    return parameters_[parameter].earlier != nullptr;
  });
}

bool Expressions::TakeOver(const Resolution::PartPtr& part) {
  if (copied_ + part->copied > kLargestCopies) return false;  // to be told where
  copied_ += part->copied;
  for (const std::size_t parameter : part->used) parameters_[parameter].used = true;
  Keep(part);
  return true;
}

void Expressions::Keep(const Resolution::PartPtr& part) {
  if (const void* const held = HeldBy(part->written)) lists_and_maps_.emplace(held, part);
  for (const Resolution::PartPtr& inner : part->inner) Keep(inner);
}

void Expressions::Include(const Resolution::PartPtr& part) {
  if (current_ == nullptr) return;
  current_->inner.push_back(part);
  current_->copied += part->copied;
  for (const std::size_t parameter : part->used) CountUse(parameter, 0);
}

void Expressions::CountUse(std::size_t parameter, std::size_t copied) {
  if (current_ == nullptr) return;
  auto& used = current_->used;
  if (std::find(used.begin(), used.end(), parameter) == used.end()) used.push_back(parameter);
  current_->copied += copied;
}

Value Expressions::Resolve(const Value& value) {
  const void* const held = HeldBy(value);
  if (held == nullptr) {
    return HasExpression(value) ? ResolveText(*value.string(), value.location()) : value;
  }
  if (earlier_ != nullptr) {
    const auto found = earlier_->lists_and_maps.find(held);
    if (found != earlier_->lists_and_maps.end() && IsUnchanged(*found->second) &&
        TakeOver(found->second)) {
      Include(found->second);
      return found->second->resolved.At(value.location());
    }
  }
  Resolution::Part part;
  Resolution::Part* const outer = std::exchange(current_, &part);
  Value resolved = ResolveItems(value);
  current_ = outer;
  if (resolved.Shares(value)) return resolved;  // no expression in it
  part.written = value;
  part.resolved = resolved;
  const auto kept = std::make_shared<const Resolution::Part>(std::move(part));
  lists_and_maps_.emplace(held, kept);
  Include(kept);
  return resolved;
}

Value Expressions::ResolveItems(const Value& value) {
  Value resolved = value;  // shared, until something in it is an expression
  if (const Value::List* const list = value.list()) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      Value item = Resolve((*list)[i]);
      if (!IsAsWritten(item, (*list)[i])) (*resolved.list())[i] = std::move(item);
    }
  } else if (const Value::Map* const map = value.map()) {
    for (std::size_t i = 0; i < map->size(); ++i) {
      Value item = Resolve((*map)[i].value);
      if (!IsAsWritten(item, (*map)[i].value)) (*resolved.map())[i].value = std::move(item);
    }
  }
  return resolved;
}

Resolution Expressions::TakeResolution() {
  Resolution resolution;
  for (Parameter& parameter : parameters_) {
    resolution.parameters.push_back(std::move(parameter.part));
  }
  resolution.lists_and_maps = std::move(lists_and_maps_);
  return resolution;
}

Expressions::Parameter* Expressions::Find(const std::string& name) {
  const auto place =
      std::lower_bound(parameters_.begin(), parameters_.end(), name,
                       [](const auto& one, const auto& key) { return one.entry->key < key; });
  return place != parameters_.end() && place->entry->key == name ? &*place : nullptr;
}

std::vector<std::string> Expressions::Names() const {
  std::vector<std::string> names{"pi", "deg"};
  for (const Parameter& parameter : parameters_) names.push_back(parameter.entry->key);
  return names;
}

const Value* Expressions::ValueOf(Parameter& parameter, const Location& location) {
  if (parameter.part != nullptr) return &parameter.part->resolved;
  if (parameter.earlier != nullptr && TakeOver(parameter.earlier)) {
    parameter.part = parameter.earlier;
    return &parameter.part->resolved;
  }
  const std::string& name = parameter.entry->key;
  if (std::exchange(parameter.open, true)) {
    problems_.Add(location, fmt::format("parameters.{}: defined by itself", name));
    return nullptr;
  }
  if (++chain_ > kLongestChain) {
    problems_.Add(location, fmt::format("parameters.{}: defined through more than {} others", name,
                                        kLongestChain));
  }
  const auto part = std::make_shared<Resolution::Part>();
  part->name = name;
  part->written = parameter.entry->value;
  Resolution::Part* const outer = std::exchange(current_, part.get());
  part->resolved = chain_ > kLongestChain ? Value({}, location) : Resolve(part->written);
  current_ = outer;
  --chain_;
  parameter.open = false;
  parameter.part = part;
  return &parameter.part->resolved;
}

const Value* Expressions::Use(const std::string& name, const Location& location) {
  MarkUsed(name);
  Parameter* const parameter = Find(name);
  if (parameter == nullptr) {
    problems_.Add(location, fmt::format("${{...}}: unknown parameter '{}'{}", name,
                                        DidYouMean(name, Names())));
    return nullptr;
  }
  const Value* const value = ValueOf(*parameter, location);
  if (value == nullptr || copied_ > kLargestCopies) return nullptr;
  const std::size_t size = SizeOf(*value);
  copied_ += size;
  CountUse(static_cast<std::size_t>(parameter - parameters_.data()), size);
  if (copied_ <= kLargestCopies) return value;
  problems_.Add(location, fmt::format("${{{}}}: parameters that use parameters add up to more than "
                                      "{} values",
                                      name, kLargestCopies));
  return nullptr;
}

void Expressions::MarkUsed(const std::string& name) {
  if (Parameter* const parameter = Find(name)) {
    parameter->used = true;
  } else {
    unknown_.insert(name);
  }
}

std::set<std::string> Expressions::used() const {
  std::set<std::string> names = unknown_;
  for (const Parameter& parameter : parameters_) {
    if (parameter.used) names.insert(parameter.entry->key);
  }
  return names;
}

std::vector<Diagnostic> Expressions::Unused(const std::set<std::string>& known) const {
  std::vector<Diagnostic> warnings;
  std::vector<std::string> others;  // that are used
  for (const auto& [entry, part, earlier, open, used] : parameters_) {
    if (used) continue;
    const std::string& name = entry->key;
    const auto& source = entry->value.location().file;
    const bool overridden = source && source->starts_with("-s ");
    if (!known.contains(name)) {
      if (others.empty()) {
        const std::set<std::string> names = this->used();
        others.assign(names.begin(), names.end());
        others.insert(others.end(), known.begin(), known.end());
      }
      warnings.push_back(
          {entry->location,
           fmt::format("parameters.{}: nothing uses it{}", name, DidYouMean(name, others)),
           Diagnostic::Kind::kWarning});
    } else if (overridden) {
      const Location at{source, 0, 0};
      warnings.push_back(
          {at, "nothing uses it with the parts that are chosen", Diagnostic::Kind::kWarning});
    }
  }
  return warnings;
}

}  // namespace oca::files
