// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/band_memory.h"

#include <algorithm>
#include <cmath>

#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::BandMemory;
using systems::Json;
using systems::JsonReader;

Fault Signal<BandMemory>::Check(const BandMemory& value, Look /*look*/) {
  return Fault::UnlessFinite(value.held.controls().allFinite() &&
                             value.next.controls().allFinite() && std::isfinite(value.nearest) &&
                             std::isfinite(value.cost));
}

void Signal<BandMemory>::WriteJson(const BandMemory& value, std::string& out) {
  out += Json{{"plans", value.plans},
              {"start", planning::kBandStartNames[static_cast<std::size_t>(value.start)]},
              {"clear", value.clear},
              {"stuck", value.stuck},
              {"nearest", value.nearest},
              {"link", value.link.text()},
              {"obstacle", value.obstacle.text()},
              {"time", value.time},
              {"cost", value.cost},
              {"evaluations", value.evaluations}}
             .dump();
}

BandMemory Signal<BandMemory>::ReadJson(std::string_view text) {
  const Json json = systems::ParseJson(text);
  const JsonReader reader(json, "plan");
  reader.CheckKeys({"plans", "start", "clear", "stuck", "nearest", "link", "obstacle", "time",
                    "cost", "evaluations"});
  const auto flag = [&](const char* key) {
    if (!json[key].is_boolean()) reader.At(key).Fail(json[key].dump(), "true or false");
    return json[key].get<bool>();
  };
  BandMemory value;
  value.plans = static_cast<std::uint64_t>(reader.At("plans").Number());
  const std::string start = reader.At("start").Text();
  const auto& names = planning::kBandStartNames;
  const auto found = std::find(names.begin(), names.end(), start);
  if (found == names.end()) reader.At("start").Fail("'" + start + "'", "request, last, pause, ...");
  value.start = static_cast<planning::BandStart>(found - names.begin());
  value.clear = flag("clear");
  value.stuck = flag("stuck");
  value.nearest = reader.At("nearest").Number();
  value.link = models::Name(reader.At("link").Text());
  value.obstacle = models::Name(reader.At("obstacle").Text());
  value.time = reader.At("time").Number();
  value.cost = reader.At("cost").Number();
  value.evaluations = static_cast<std::uint64_t>(reader.At("evaluations").Number());
  return value;
}

}  // namespace oca
