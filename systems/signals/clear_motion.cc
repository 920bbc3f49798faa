// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/clear_motion.h"

#include <cmath>

#include "oca/framework/dataflow/fixed_text.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::ClearMotion;
using systems::Json;
using systems::JsonReader;

Fault Signal<ClearMotion>::Check(const ClearMotion& value, Look look) {
  if (!std::isfinite(value.clear_for)) return Fault::UnlessFinite(false);
  if (look == Look::kFinite || value.clear_for >= 0.0) return {};
  return FaultOf("clear_for: got {} s; expected at least 0", value.clear_for);
}

void Signal<ClearMotion>::WriteJson(const ClearMotion& value, std::string& out) {
  Json bodies = Json::array();
  for (const models::Name body : value.bodies) bodies.push_back(body.text());
  out += oca::internal::JsonText(
      Json{{"clear_for", value.clear_for}, {"bodies", bodies}, {"own_links", value.own_links}});
}

ClearMotion Signal<ClearMotion>::ReadJson(std::string_view text) {
  const Json json = oca::internal::ReadJsonTree(text);
  const JsonReader reader(json, "clear");
  reader.CheckKeys({"clear_for", "bodies", "own_links"});
  ClearMotion value;
  value.clear_for = reader.At("clear_for").Number();
  reader.At("bodies").ForEach(
      [&](const JsonReader& body) { value.bodies.emplace_back(body.Label()); });
  if (!json["own_links"].is_boolean()) {
    reader.At("own_links").Fail(oca::internal::JsonText(json["own_links"]), "true or false");
  }
  value.own_links = json["own_links"].get<bool>();
  return value;
}

}  // namespace oca
