// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/ignored_pairs.h"

#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::IgnoredPairs;
using systems::Json;
using systems::JsonReader;

void Signal<IgnoredPairs>::WriteJson(const IgnoredPairs& value, std::string& out) {
  Json pairs = Json::array();
  for (const auto& [link, other] : value.pairs) {
    pairs.push_back(Json::array({link.text(), other.text()}));
  }
  out += oca::internal::JsonText(Json{{"pairs", std::move(pairs)}});
}

IgnoredPairs Signal<IgnoredPairs>::ReadJson(std::string_view text) {
  const Json json = oca::internal::ReadJsonTree(text);
  const JsonReader reader(json, "ignored");
  reader.CheckKeys({"pairs"});
  IgnoredPairs value;
  reader.At("pairs").ForEach([&](const JsonReader& pair) {
    std::vector<models::Name> names;
    pair.ForEach([&](const JsonReader& name) { names.emplace_back(name.Label()); });
    if (names.size() != 2) {
      pair.Fail(std::to_string(names.size()) + " names", "2: [link, obstacle]");
    }
    value.pairs.emplace_back(names[0], names[1]);
  });
  return value;
}

}  // namespace oca
