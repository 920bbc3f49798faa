// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/avoidance_velocity.h"

#include <cmath>

#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::AvoidanceVelocity;

Fault Signal<AvoidanceVelocity>::Check(const AvoidanceVelocity& value, Look /*look*/) {
  return Fault::UnlessFinite(value.velocity.allFinite() && std::isfinite(value.share));
}

void Signal<AvoidanceVelocity>::WriteJson(const AvoidanceVelocity& value, std::string& out) {
  out += R"({"velocity":)";
  WriteVectorJson(value.velocity.data(), static_cast<std::size_t>(value.velocity.size()), out);
  out += R"(,"share":)" + systems::Json(value.share).dump();
  out += R"(,"rows":)" + systems::Json(value.rows).dump() + '}';
}

AvoidanceVelocity Signal<AvoidanceVelocity>::ReadJson(std::string_view text) {
  const systems::Json json = systems::ParseJson(text);
  const systems::JsonReader reader(json, "solution");
  reader.CheckKeys({"velocity", "share", "rows"});
  AvoidanceVelocity value;
  value.velocity = ReadVectorJson(json["velocity"].dump());
  value.share = reader.At("share").Number();
  value.rows = static_cast<int>(reader.At("rows").Number());
  return value;
}

}  // namespace oca
