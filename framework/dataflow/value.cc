// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/value.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

#include "oca/framework/dataflow/error.h"

namespace oca {

std::string Location::ToString() const {
  const std::string name = file ? *file : std::string("parameters");
  return line > 0 ? fmt::format("{}:{}:{}", name, line, column) : name;
}

namespace {

/// For one owner alone: a copy if there are others.
template <class T>
T* Own(std::shared_ptr<T>& held) {
  if (held.use_count() > 1) held = std::make_shared<T>(*held);
  // What others read of it happened before they let go of it.
  std::atomic_thread_fence(std::memory_order_acquire);
  return held.get();
}

}  // namespace

Value::Held Value::Hold(Data data) {
  return std::visit(
      [](auto one) -> Held {
        using T = decltype(one);
        if constexpr (std::is_same_v<T, List> || std::is_same_v<T, Map>) {
          return std::make_shared<T>(std::move(one));
        } else {
          return Held(std::move(one));
        }
      },
      std::move(data));
}

Value::Value() = default;
Value::Value(Data data, Location location)
    : data_(Hold(std::move(data))), location_(std::move(location)) {}
Value::Value(const Value& other) = default;
Value::Value(Value&& other) noexcept = default;
Value& Value::operator=(const Value& other) = default;
Value& Value::operator=(Value&& other) noexcept = default;
Value::~Value() = default;

const Value::List* Value::list() const {
  const auto* const held = std::get_if<std::shared_ptr<List>>(&data_);
  return held == nullptr ? nullptr : held->get();
}
const Value::Map* Value::map() const {
  const auto* const held = std::get_if<std::shared_ptr<Map>>(&data_);
  return held == nullptr ? nullptr : held->get();
}
Value::List* Value::list() {
  auto* const held = std::get_if<std::shared_ptr<List>>(&data_);
  return held == nullptr ? nullptr : Own(*held);
}
Value::Map* Value::map() {
  auto* const held = std::get_if<std::shared_ptr<Map>>(&data_);
  return held == nullptr ? nullptr : Own(*held);
}

Value Value::At(Location location) const {
  Value moved = *this;
  moved.location_ = std::move(location);
  return moved;
}

bool Value::Shares(const Value& other) const {
  return kind() == other.kind() && ((list() != nullptr && list() == other.list()) ||
                                    (map() != nullptr && map() == other.map()));
}

bool Value::number(double& out) const {
  if (const auto* whole = std::get_if<std::int64_t>(&data_)) {
    out = static_cast<double>(*whole);
    return true;
  }
  if (const auto* real = std::get_if<double>(&data_)) {
    out = *real;
    return true;
  }
  return false;
}

const Value* Value::Find(const std::string& key) const {
  if (map() == nullptr) return nullptr;
  const auto found =
      std::find_if(map()->begin(), map()->end(), [&](const Entry& e) { return e.key == key; });
  return found == map()->end() ? nullptr : &found->value;
}

std::string Value::Show() const {
  struct Visitor {
    std::string operator()(std::monostate) const { return "nothing"; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return fmt::format("{}", value); }
    std::string operator()(const std::string& value) const {
      constexpr std::size_t kLongest = 60;
      return value.size() > kLongest ? fmt::format("'{}...'", value.substr(0, kLongest))
                                     : fmt::format("'{}'", value);
    }
    std::string operator()(const std::shared_ptr<List>&) const { return "a list"; }
    std::string operator()(const std::shared_ptr<Map>&) const { return "a map"; }
  };
  return std::visit(Visitor(), data_);
}

std::string Diagnostic::ToString() const {
  const char* const name = kind == Kind::kError ? "error" : "warning";
  return fmt::format("{}: {}: {}", location.ToString(), name, what);
}

void Problems::Add(const Location& location, const std::string& what) {
  all_.push_back({location, what});
}

void Problems::Add(const Problems& others) {
  all_.insert(all_.end(), others.all_.begin(), others.all_.end());
}

void Problems::Throw() const {
  if (all_.empty()) return;
  std::vector<std::string> lines;
  for (const Diagnostic& problem : all_) lines.push_back(problem.ToString());
  throw ConfigError(fmt::format("{}", fmt::join(lines, "\n")));
}

}  // namespace oca
