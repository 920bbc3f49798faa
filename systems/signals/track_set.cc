// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/track_set.h"

#include "oca/framework/dataflow/fixed_text.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::TrackReport;
using systems::TrackSet;

Fault Signal<TrackSet>::Check(const TrackSet& value, Look look) {
  for (const TrackReport& track : value.tracks) {
    if (!AllFinite(&track.age, 1) || !AllFinite(&track.nis, 1) ||
        !AllFinite(track.weights.data(), 5)) {
      return FaultOf("track '{}': got a NaN or an infinity; expected finite numbers",
                     track.id.text());
    }
    if (look == Look::kFinite) continue;
    if (!(track.age >= 0.0 && track.nis >= 0.0 && track.weights.minCoeff() >= 0.0)) {
      return FaultOf(
          "track '{}': age, nis, weights; got {}, {} and at least {}; expected at least 0",
          track.id.text(), track.age, track.nis, track.weights.minCoeff());
    }
  }
  return {};
}

void Signal<TrackSet>::WriteJson(const TrackSet& value, std::string& out) {
  systems::Json list = systems::Json::array();
  for (const TrackReport& track : value.tracks) {
    list.push_back({{"id", track.id.text()},
                    {"state", EnumNames(track.state)[static_cast<std::size_t>(track.state)]},
                    {"age", track.age},
                    {"nis", track.nis},
                    {"weights", std::vector<double>(track.weights.begin(), track.weights.end())}});
  }
  out += oca::internal::JsonText(list);
}

}  // namespace oca
