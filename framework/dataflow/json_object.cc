// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/json_object.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca {
namespace {

using nlohmann::ordered_json;

[[noreturn]] void RefuseMissing(std::string_view key) {
  throw ConfigError(fmt::format("got no such key; expected the key '{}'", key));
}

[[noreturn]] void RefuseMember(std::string_view key, const ordered_json& got,
                               const char* expected) {
  throw ConfigError(fmt::format("{}: got {}; expected {}", key, internal::JsonText(got), expected));
}

}  // namespace

void JsonObject::Key(std::string_view key) {
  if (!first_) out_ += ',';
  first_ = false;
  out_ += internal::JsonText(ordered_json(key)) + ':';
}

JsonObject& JsonObject::Number(std::string_view key, double number) {
  Key(key);
  out_ += internal::JsonText(ordered_json(number));
  return *this;
}

JsonObject& JsonObject::Numbers(std::string_view key, std::span<const double> numbers) {
  Key(key);
  out_ += internal::JsonText(ordered_json(numbers));
  return *this;
}

JsonObject& JsonObject::Flag(std::string_view key, bool flag) {
  Key(key);
  out_ += flag ? "true" : "false";
  return *this;
}

JsonObject& JsonObject::Text(std::string_view key, std::string_view text) {
  Key(key);
  out_ += internal::JsonText(ordered_json(text));
  return *this;
}

struct JsonMembers::Tree {
  const ordered_json& At(const char* key) const {
    const auto found = json.find(key);
    if (found == json.end()) RefuseMissing(key);
    return *found;
  }
  double NumberAt(const char* key, const ordered_json& value) const {
    if (!value.is_number()) RefuseMember(key, value, "a number");
    return value.get<double>();
  }
  ordered_json json;
};

JsonMembers::JsonMembers(std::string_view text, std::initializer_list<const char*> keys)
    : tree_(new Tree{internal::ReadJsonTree(text)}) {
  const ordered_json& json = tree_->json;
  const std::vector<std::string> known(keys.begin(), keys.end());
  if (!json.is_object()) {
    throw ConfigError(fmt::format("got {}; expected an object with {}", internal::JsonText(json),
                                  fmt::join(known, ", ")));
  }
  for (const auto& [key, value] : json.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw ConfigError(fmt::format("got the unknown key '{}'; expected one of {}{}", key,
                                  fmt::join(known, ", "), DidYouMean(key, known)));
  }
  for (const std::string& key : known) {
    if (!json.contains(key)) RefuseMissing(key);
  }
}

JsonMembers::~JsonMembers() = default;

double JsonMembers::Number(const char* key) const { return tree_->NumberAt(key, tree_->At(key)); }

std::vector<double> JsonMembers::Numbers(const char* key) const {
  const ordered_json& list = tree_->At(key);
  if (!list.is_array()) RefuseMember(key, list, "a list of numbers");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < list.size(); ++i) {
    numbers.push_back(tree_->NumberAt(fmt::format("{}[{}]", key, i).c_str(), list[i]));
  }
  return numbers;
}

bool JsonMembers::Flag(const char* key) const {
  const ordered_json& value = tree_->At(key);
  if (!value.is_boolean()) RefuseMember(key, value, "true or false");
  return value.get<bool>();
}

std::string JsonMembers::Text(const char* key) const {
  const ordered_json& value = tree_->At(key);
  if (!value.is_string()) RefuseMember(key, value, "a text");
  return value.get<std::string>();
}

}  // namespace oca
