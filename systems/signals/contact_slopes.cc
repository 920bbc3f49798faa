// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/contact_slopes.h"

#include "oca/framework/dataflow/fixed_text.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/json_fields.h"
#include "oca/systems/signals/signal_limits.h"

namespace oca::systems {

ContactSlope SlopeAt(const Proximity& proximity, const Eigen::Vector3d& slope,
                     const Eigen::Vector3d& damping) {
  return {proximity.link,
          proximity.own_link,
          proximity.point_on_link,
          proximity.point_on_obstacle,
          proximity.normal,
          slope,
          damping};
}

}  // namespace oca::systems

namespace oca {

using systems::ContactSlope;
using systems::ContactSlopes;

Fault Signal<ContactSlopes>::Check(const ContactSlopes& value, Look look) {
  for (const ContactSlope& s : value.slopes) {
    if (!s.point_on_link.allFinite() || !s.point_on_obstacle.allFinite() || !s.normal.allFinite() ||
        !s.slope.allFinite() || !s.damping.allFinite()) {
      return Fault::UnlessFinite(false);
    }
    if (look == Look::kFinite) continue;
    if (s.link.empty()) return Fault("slope: link; got an empty name; expected a link");
    if (!systems::IsUnit(s.normal)) {
      return FaultOf("slope on '{}': normal; got length {:.12g}; expected 1, within 1e-9",
                     s.link.text(), s.normal.norm());
    }
    if (!systems::Near(s.point_on_link) || !systems::Near(s.point_on_obstacle)) {
      return FaultOf("slope on '{}': got a point beyond 1e6 m; expected a nearer one",
                     s.link.text());
    }
  }
  return {};
}

void Signal<ContactSlopes>::WriteJson(const ContactSlopes& value, std::string& out) {
  systems::Json list = systems::Json::array();
  for (const ContactSlope& s : value.slopes) {
    list.push_back({{"link", s.link.text()},
                    {"point_on_link", systems::ToJson(s.point_on_link)},
                    {"point_on_obstacle", systems::ToJson(s.point_on_obstacle)},
                    {"normal", systems::ToJson(s.normal)},
                    {"slope", systems::ToJson(s.slope)},
                    {"damping", systems::ToJson(s.damping)}});
  }
  out += oca::internal::JsonText(list);
}

ContactSlopes Signal<ContactSlopes>::ReadJson(std::string_view text) {
  const systems::Json json = oca::internal::ReadJsonTree(text);
  ContactSlopes value;
  systems::JsonReader(json, "slopes").ForEach([&](const systems::JsonReader& item) {
    item.CheckKeys({"link", "point_on_link", "point_on_obstacle", "normal", "slope", "damping"});
    ContactSlope& s = value.slopes.emplace_back();
    s.link = models::Name(item.At("link").Label());
    s.point_on_link = item.At("point_on_link").Vector3();
    s.point_on_obstacle = item.At("point_on_obstacle").Vector3();
    s.normal = item.At("normal").UnitVector();
    s.slope = item.At("slope").Vector3();
    s.damping = item.At("damping").Vector3();
  });
  return value;
}

}  // namespace oca
