// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/name.h"

namespace oca::systems {

/// How a tracker has a body in sight.
enum class TrackState {
  kNew,        ///< seen for the first time, or anew after poses that were not believed
  kTracked,    ///< where it was foreseen
  kTurning,    ///< farther off than its covariance allows: it changed its way
  kDoubted,    ///< its last pose is too far off to be believed
  kLost,       ///< not seen in the last set; goes on as it did
  kBack,       ///< seen again
  kNotTracked  ///< beyond the number of bodies that there is room for; its velocity is not known
};
inline std::span<const char* const> EnumNames(TrackState) {
  static constexpr std::array kNames{"new",  "tracked", "turning",    "doubted",
                                     "lost", "back",    "not_tracked"};
  return kNames;
}

struct TrackReport {
  models::Name id{};
  TrackState state{TrackState::kNew};
  double age{0.0};  ///< s; since the last pose that was used
  /// Of its last position: innovation^T S^-1 innovation, of chi-square with 3 degrees of freedom
  /// while the body does as the filter takes it to do.
  double nis{0.0};
  /// That it rests, goes straight, turns, is erratic, falls.
  Eigen::Matrix<double, 5, 1> weights{Eigen::Matrix<double, 5, 1>::Zero()};
};

/// JSON: [{"id", "state", "age", "nis", "weights": [5]}]
struct TrackSet {
  std::vector<TrackReport> tracks{};
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::TrackSet> {
  static constexpr const char* kName = "TrackSet";
  static Fault Check(const systems::TrackSet& value, Look look);
  static void WriteJson(const systems::TrackSet& value, std::string& out);
};

}  // namespace oca
