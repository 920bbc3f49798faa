// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/band_signals.h"

#include <cmath>

#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::BandMemory;
using systems::BandReport;
using systems::Json;

namespace {

bool Finite(const BandReport& report) {
  return std::isfinite(report.nearest) && std::isfinite(report.block_amount) &&
         std::isfinite(report.cost);
}

}  // namespace

Fault Signal<BandReport>::Check(const BandReport& value, Look /*look*/) {
  return Fault::UnlessFinite(Finite(value));
}

Fault Signal<BandMemory>::Check(const BandMemory& value, Look /*look*/) {
  return Fault::UnlessFinite(value.held.controls().allFinite() &&
                             value.next.controls().allFinite() && Finite(value.report));
}

void Signal<BandReport>::WriteJson(const BandReport& value, std::string& out) {
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
