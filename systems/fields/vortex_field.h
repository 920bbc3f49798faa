// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/turned_repulsive_law.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// A RepulsiveField whose force is turned towards the way around the obstacle, so that a link which
/// is pushed back against its request slides along instead of standing still:
///
///     F = |F_rep(rho)| (cos(phi) n + sin(phi) a x n)      robot::TurnedRepulsiveLaw
///
/// Each link has one unit axis a for all its obstacles, chosen when the first of them comes within
/// max_distance, where F is 0, and kept until the last one is out again: so F does not flip, and is
/// continuous as long as obstacles come and go at the rim. The axis is that which turns the normal
/// n of the nearest obstacle towards where the link's nearest point is going as seen from the
/// obstacle:
///
///     d = J_p (velocity + (position - measured_position) / 1 s) - v_O
///
/// robot::AxisAround makes a of n, d and the base's axes: a request that leads straight at the
/// obstacle is led up. In contact phi is 0: F points straight out, and F . n >= |F| cos(turn)
/// everywhere.
///
/// in    proximities        ProximitySet
/// in    links              LinkPoses
/// in    position           n  rad, m      requested
/// in    velocity           n  rad/s, m/s  requested; optional
/// in    measured_position  n  rad, m
/// out   forces             LinkForceSet  N  one a proximity, same order, at point_on_link
/// out   slopes             ContactSlopes    for a LoopGain
/// state held               3 num_links      the axes of the last tick
/// throws ConfigError as RepulsiveField does, if turn is not within [0, 1.5], period is not
///        positive or there is no such model; while running if a proximity is of no link of the
///        model
/// source Singh, Stephanou, Wen, ICRA 1996 (circular fields); Haddadin et al., ICRA 2011
class VortexField final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "repulsion turned towards the way around the obstacle, out of local minima",
      "force = |F_rep| (cos(phi) normal + sin(phi) axis x normal), phi = turn clamp(2 distance / "
      "max_distance, 0, 1)",
      "Singh, Stephanou, Wen 1996; Haddadin et al. 2011"};
  struct Params {
    std::string model{};
    double force_gain{1.0};
    double max_distance{0.3};
    double min_distance{0.01};
    double turn{1.0};
    Period period{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  VortexField(const Params& params, const ModelSet& models);

 private:
  using OptionalVector = std::optional<VectorView>;
  const robot::TurnedRepulsiveLaw law_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const DiscreteState<Vector> held_;

  /// A column a link of the model, 0 for a link without obstacles.
  struct Axes;
  void CalcAxes(const ProximitySet& set, const LinkPoses& poses, VectorView request,
                OptionalVector rate, VectorView measured, VectorView held, Axes& result) const;
  void CalcForces(const ProximitySet& set, const Axes& about, LinkForceSet& result) const;
  void CalcSlopes(const ProximitySet& set, const Axes& about, ContactSlopes& result) const;
  void Update(const Axes& about, MutableVectorView next) const;

 public:
  const Input<ProximitySet> proximities;
  const Input<LinkPoses> links;
  const Input<Vector> position;
  const OptionalInput<Vector> velocity;
  const Input<Vector> measured_position;

 private:
  const Cached<Axes> axes_;

 public:
  const Output<LinkForceSet> forces;
  const Output<ContactSlopes> slopes;
};

}  // namespace oca::systems
