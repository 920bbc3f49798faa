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
  if (!std::isfinite(value.clear_for) || !std::isfinite(value.standing_for)) {
    return Fault::UnlessFinite(false);
  }
  if (look == Look::kFinite) return {};
  if (!(value.clear_for >= 0.0)) {
    return FaultOf("clear_for: got {} s; expected at least 0", value.clear_for);
  }
  if (value.standing_for >= 0.0) return {};
  return FaultOf("standing_for: got {} s; expected at least 0", value.standing_for);
}

void Signal<ClearMotion>::WriteJson(const ClearMotion& value, std::string& out) {
  const auto texts = [](const std::vector<models::Name>& names) {
    Json list = Json::array();
    for (const models::Name name : names) list.push_back(name.text());
    return list;
  };
  out += oca::internal::JsonText(Json{{"clear_for", value.clear_for},
                                      {"bodies", texts(value.bodies)},
                                      {"own_links", value.own_links},
                                      {"standing_for", value.standing_for},
                                      {"standing", texts(value.standing)}});
}

ClearMotion Signal<ClearMotion>::ReadJson(std::string_view text) {
  const Json json = oca::internal::ReadJsonTree(text);
  const JsonReader reader(json, "clear");
  reader.CheckKeys({"clear_for", "bodies", "own_links", "standing_for", "standing"});
  ClearMotion value;
  value.clear_for = reader.At("clear_for").Number();
  reader.At("bodies").ForEach(
      [&](const JsonReader& body) { value.bodies.emplace_back(body.Label()); });
  if (!json["own_links"].is_boolean()) {
    reader.At("own_links").Fail(oca::internal::JsonText(json["own_links"]), "true or false");
  }
  value.own_links = json["own_links"].get<bool>();
  if (json.contains("standing_for")) value.standing_for = reader.At("standing_for").Number();
  if (json.contains("standing")) {
    reader.At("standing").ForEach([&](const JsonReader& body) {
      value.standing.emplace_back(body.Label());
    });
  }
  return value;
}

}  // namespace oca
