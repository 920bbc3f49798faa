// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/signal_shape.h"

#include <nlohmann/json.hpp>

namespace oca {
namespace {

using nlohmann::ordered_json;

SignalShape ShapeOfTree(const ordered_json& tree) {
  using Kind = SignalShape::Kind;
  if (tree.is_number()) return {Kind::kNumber};
  if (tree.is_string()) return {Kind::kText};
  if (tree.is_boolean()) return {Kind::kFlag};
  SignalShape shape;
  if (tree.is_array()) {
    shape.kind = Kind::kList;
    if (!tree.empty()) shape.item.push_back(ShapeOfTree(tree[0]));
  } else if (tree.is_object()) {
    shape.kind = Kind::kObject;
    for (const auto& [key, member] : tree.items()) {
      shape.members.emplace_back(key, ShapeOfTree(member));
    }
  }
  return shape;
}

}  // namespace

SignalShape ShapeOf(const SignalType& type) {
  return ShapeOfTree(ordered_json::parse(DefaultJson(type)));
}

std::optional<double> MemberNumber(const SignalType& type, const void* value,
                                   std::string_view member) {
  std::string text;
  type.write_json(value, text);
  const ordered_json tree = ordered_json::parse(text, nullptr, false);
  const auto found = tree.is_object() ? tree.find(std::string(member)) : tree.end();
  if (found == tree.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

}  // namespace oca
