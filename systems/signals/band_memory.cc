// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/band_memory.h"

#include <cmath>

#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::BandMemory;
using systems::Json;

Fault Signal<BandMemory>::Check(const BandMemory& value, Look /*look*/) {
  return Fault::UnlessFinite(value.held.controls().allFinite() &&
                             value.next.controls().allFinite() && std::isfinite(value.nearest) &&
                             std::isfinite(value.block_amount) && std::isfinite(value.cost));
}

void Signal<BandMemory>::WriteJson(const BandMemory& value, std::string& out) {
  out += oca::internal::JsonText(
      Json{{"plans", value.plans},
           {"start", planning::kBandStartNames[static_cast<std::size_t>(value.start)]},
           {"clear", value.clear},
           {"reaches", value.reaches},
           {"stuck", value.stuck},
           {"nearest", value.nearest},
           {"link", value.link.text()},
           {"obstacle", value.obstacle.text()},
           {"distance", value.distance},
           {"lack", planning::kBandLackNames[static_cast<std::size_t>(value.lack)]},
           {"block", planning::kBandBlockNames[static_cast<std::size_t>(value.block)]},
           {"block_link", value.block_link.text()},
           {"block_body", value.block_body.text()},
           {"block_amount", value.block_amount},
           {"time", value.time},
           {"cost", value.cost},
           {"evaluations", value.work.looks()},
           {"charged", value.charged},
           {"overruns", value.overruns}});
}

}  // namespace oca
