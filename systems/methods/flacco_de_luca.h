// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/flacco_de_luca_law.h"
#include "oca/systems/methods/velocity_methods.h"

namespace oca::systems {

/// robot::FlaccoDeLucaLaw as a VelocityMethod, a baseline: obstacles repulse the tip (with
/// `repulsion: all` every link), and take speed from the joints that would lead the rest of the arm
/// to them. Position and acceleration limits are left to a MotionLimiter. It evades by as much as
/// balances the pull of the request: 0.1 m for repulsion_speed 0.5 m/s and a VelocityLoop's
/// position_gain 5 1/s.
///
/// Ports are those of VelocityMethod; share is the largest risk.
///
/// throws ConfigError if there is no such model or link, it has more than 32 joints, or a parameter
///        is out of its bounds; while running if a proximity or a pose is of no link of the model
struct FlaccoDeLucaMethod {
  using Law = robot::FlaccoDeLucaLaw;
  static constexpr SystemDoc kDoc{
      "repulses the tip, and slows the joints that lead the arm to obstacles",
      "v = repulsion_speed / (1 + exp(alpha (2 d / influence_distance - 1))); u = r + J+ v within "
      "bounds V (1 - risk)",
      "Flacco, Kroeger, De Luca, Khatib 2012, ICRA"};
  enum class Repulsion { kTip, kAll };
  friend std::span<const char* const> EnumNames(Repulsion) {
    static constexpr std::array kNames{"tip", "all"};
    return kNames;
  }
  struct Params {
    std::string model{};
    std::string tip{};
    Repulsion repulsion{Repulsion::kTip};
    double repulsion_speed{0.5};
    double influence_distance{0.4};
    double alpha{6.0};
    double max_joint_velocity{2.0};
    double most_damping{0.05};
    double damping_threshold{0.1};
    static void Describe(Fields<Params>& fields);
  };
  static constexpr const char* kHow = "repulsed or held back";

  static Params Checked(const Params& params) { return WithDamping(params); }
  static Law LawOf(const Params& params, const robot::RobotModel& model);
};

using FlaccoDeLuca = VelocityMethod<FlaccoDeLucaMethod>;

}  // namespace oca::systems
