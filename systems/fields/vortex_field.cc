// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/vortex_field.h"

#include <vector>

#include "oca/models/robot/kinematics.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/fields/force_per_proximity.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

// Time within which the distance to the request counts as a velocity, s.
constexpr double kCatchUp = 1.0;

}  // namespace

struct VortexField::Axes {
  Eigen::Matrix3Xd axes;
  Eigen::VectorXd wish;
  Eigen::Matrix3Xd J_v;
  std::vector<Eigen::Isometry3d> reordered;
  std::vector<const Proximity*> nearest;
};

void VortexField::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  fields.Add("force_gain", &Params::force_gain, "N m^3", "as of a RepulsiveField").AtLeast(0.0);
  fields.Add("max_distance", &Params::max_distance, "m", "as of a RepulsiveField").Above(0.0);
  fields.Add("min_distance", &Params::min_distance, "m", "as of a RepulsiveField").Above(0.0);
  fields
      .Add("turn", &Params::turn, "rad",
           "by how much the force is turned off the normal far from contact; 0 is a RepulsiveField")
      .AtLeast(0.0)
      .AtMost(1.5);
  AddControlPeriod(fields);
}

VortexField::VortexField(const Params& params, const ModelSet& models)
    : law_{{WithRange(params).force_gain, params.max_distance, params.min_distance}, params.turn},
      model_(MovableModel(models, params.model)),
      held_(DeclareDiscreteState("held", {3 * model_->num_links(), Unit::Any()}, 0.0)),
      proximities(DeclareInput<ProximitySet>("proximities")),
      links(DeclareInput<LinkPoses>("links")),
      position(DeclareInput<Vector>("position", DeltaSpec(*model_))),
      velocity(DeclareOptionalInput<Vector>("velocity", RateSpec(*model_))),
      measured_position(DeclareInput<Vector>("measured_position", PositionSpec(*model_))),
      axes_(DeclareCached<&VortexField::CalcAxes>(proximities, links, position, velocity,
                                                  measured_position, held_)),
      forces(
          DeclareOutput<LinkForceSet, &VortexField::CalcForces>("forces", {}, proximities, axes_)),
      slopes(DeclareOutput<ContactSlopes, &VortexField::CalcSlopes>("slopes", {}, proximities,
                                                                    axes_)) {
  DeclareUpdate<&VortexField::Update>(Every{params.period}, Writes(held_), axes_);
  DeclareRole(Repels{params.max_distance});
  DeclareRole(Limits{
      .shown = Limits::Shown::kBelow, .signal = proximities, .bound = {params.max_distance}});
}

void VortexField::CalcAxes(const ProximitySet& set, const LinkPoses& poses, VectorView request,
                           OptionalVector rate, VectorView measured, VectorView held,
                           Axes& result) const {
  result.axes.resize(3, model_->num_links());
  result.J_v.resize(3, model_->num_positions());
  result.nearest.assign(model_->links().size(), nullptr);
  for (const Proximity& proximity : set.proximities) {
    const double seen = SeenDistance(proximity, law_.repulsion.range);
    if (seen > law_.repulsion.range) continue;
    const Proximity*& nearest = result.nearest[LinkNumber(*model_, proximity.link, "proximities")];
    if (nearest == nullptr || seen < SeenDistance(*nearest, law_.repulsion.range)) {
      nearest = &proximity;
    }
  }
  result.wish = (request - measured) / kCatchUp;
  if (rate) result.wish += *rate;
  const auto X_WL = PosesInOrder(*model_, poses, result.reordered);
  for (int link = 0; link < model_->num_links(); ++link) {
    const Proximity* const nearest = result.nearest[link];
    auto axis = result.axes.col(link);
    axis = held.segment<3>(3 * link);
    if (nearest == nullptr) {
      axis.setZero();
    } else if (axis.isZero(0.0)) {
      robot::PointJacobian(*model_, X_WL, link, nearest->point_on_link, result.J_v);
      Eigen::Vector3d way = -nearest->obstacle_velocity;
      way.noalias() += result.J_v * result.wish;
      axis = robot::AxisAround(nearest->normal, way, X_WL[0].linear());
    }
  }
}

void VortexField::CalcForces(const ProximitySet& set, const Axes& about,
                             LinkForceSet& result) const {
  ForcePerProximity(set, result, [&](const Proximity& proximity) {
    return law_.Force(SeenDistance(proximity, law_.repulsion.range), proximity.normal,
                      about.axes.col(LinkNumber(*model_, proximity.link, "proximities")));
  });
}

void VortexField::CalcSlopes(const ProximitySet& set, const Axes& about,
                             ContactSlopes& result) const {
  SlopePerProximity(set, result, [&](const Proximity& proximity) -> std::optional<ContactSlope> {
    const double share = robot::RangeShare(proximity, law_.repulsion.range);
    const double seen = proximity.distance / share;
    if (seen > law_.repulsion.range) return std::nullopt;
    const Eigen::Vector3d axis = about.axes.col(LinkNumber(*model_, proximity.link, "proximities"));
    return SlopeAt(proximity, law_.Slope(seen, proximity.normal, axis) / share);
  });
}

void VortexField::Update(const Axes& about, MutableVectorView next) const {
  next = about.axes.reshaped();
}

}  // namespace oca::systems
