// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Pulls a point x of one link towards a target x_d:
///
///     F = -gain (x - x_d)   within saturation_distance of the target,
///
/// and beyond it F keeps the size gain * saturation_distance, so that a far target does not
/// dominate the repulsion. The potential is quadratic near the target and conic far from it.
///
/// in    links   LinkPoses
/// out   forces  LinkForceSet  N  one force, at the point, of obstacle "target"
/// state -
/// throws ConfigError if link is empty, gain negative, saturation_distance not positive, or a
///        number not finite; while running if no pose of the link comes in
/// source Khatib 1986, section 3; report eq. (2.2), (2.4), (2.6)
class AttractiveField final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "pulls a point of a link towards a target",
      "force = -gain (x - target), no larger than gain saturation_distance",
      "Khatib 1986, section 3; Jain, Sixt, Exner 2016, eq. (2.2), (2.4)"};
  struct Params {
    std::string link{};
    Eigen::Vector3d point{Eigen::Vector3d::Zero()};
    Eigen::Vector3d target{Eigen::Vector3d::Zero()};
    double gain{1.0};
    double saturation_distance{0.1};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example();

  explicit AttractiveField(const Params& params);

 private:
  const Params params_;
  const models::Name link_;
  const models::Name target_name_;
  void CalcForces(const LinkPoses& poses, LinkForceSet& force_set) const;

 public:
  const Input<LinkPoses> links;
  const Output<LinkForceSet> forces;
};

}  // namespace oca::systems
