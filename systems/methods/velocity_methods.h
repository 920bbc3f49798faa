// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/avoidance_velocity.h"
#include "oca/models/robot/filtered_inverse.h"
#include "oca/systems/basics/require.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/roles.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

// What methods that choose joint velocities share.

/// Describes the parameters model and tip, `tip_meaning` being that of the latter.
template <class P>
void AddModelAndTip(Fields<P>& fields, const char* tip_meaning) {
  AddModel(fields);
  fields.Add("tip", &P::tip, "", tip_meaning);
}

/// Describes the parameters most_damping and damping_threshold.
template <class P>
void AddDamping(Fields<P>& fields) {
  fields.Add("most_damping", &P::most_damping, "m/rad", "damping of a singular direction")
      .Above(0.0);
  fields
      .Add("damping_threshold", &P::damping_threshold, "m/rad",
           "singular value below which there is damping; at least most_damping")
      .Above(0.0);
}

/// The parameters. throws ConfigError if one is out of its bounds or most_damping exceeds
/// damping_threshold
template <class P>
P WithDamping(const P& params) {
  Validated(params);
  RequireAtLeast("damping_threshold", params.damping_threshold, params.most_damping);
  return params;
}

/// throws ConfigError as MovableModel, and if it has more joints than robot::JointVector holds
std::shared_ptr<const robot::RobotModel> FilteredModel(const ModelSet& models,
                                                       const std::string& name);

/// The link `tip`, or the last one if it is empty. throws ConfigError if there is no such link, or
/// several are last and none is named
int TipNumber(const robot::RobotModel& model, const std::string& tip);

/// A law that chooses the joint velocity of one arm, as a system; what FlaccoDeLuca and
/// TaskPriority share.
///
/// `Method` names the law and its parameters, and documents the type: Law, whose Choose(model, set,
/// X_WL, wish, result) computes u; Params, their Checked(params), and LawOf(params, model); kDoc,
/// and kHow for Limits. X_WL are the poses of the model's links in its own order.
///
/// in    proximities  ProximitySet
///       links        LinkPoses
///       wish         n  u/s        the joint velocity that follows the request
/// out   velocity     n  u/s        u
///       share        1             of avoidance, from 0 to 1
///       rows         1             number of proximities that take part
/// state -
template <class Method>
class VelocityMethod final : public System {
 public:
  static constexpr SystemDoc kDoc = Method::kDoc;
  using Params = typename Method::Params;
  static Params Example() { return {}; }

  VelocityMethod(const Params& params, const ModelSet& models)
      : model_(FilteredModel(models, Method::Checked(params).model)),
        law_(Method::LawOf(params, *model_)),
        proximities(DeclareInput<ProximitySet>("proximities")),
        links(DeclareInput<LinkPoses>("links")),
        wish(DeclareInput<Vector>("wish", RateSpec(*model_))),
        solution_(DeclareCached<&VelocityMethod::CalcSolution>(proximities, links, wish)),
        velocity(
            DeclareOutput<Vector, &Solution::velocity>("velocity", RateSpec(*model_), solution_)),
        share(DeclareOutput<Vector, &Solution::share>("share", {1, Unit::Any()}, solution_)),
        rows(DeclareOutput<Vector, &Solution::rows>("rows", {1, Unit::Any()}, solution_)) {
    DeclareRole(Limits{
        .shown = Limits::Shown::kAbove, .signal = rows, .bound = {0.0}, .how = Method::kHow});
  }

 private:
  /// With the memory that it was computed in.
  struct Solution : robot::AvoidanceVelocity {
    std::vector<Eigen::Isometry3d> reordered{};
  };
  void CalcSolution(const ProximitySet& set, const LinkPoses& poses, VectorView request,
                    Solution& result) const {
    law_.Choose(*model_, set, PosesInOrder(*model_, poses, result.reordered), request, result);
  }

  const std::shared_ptr<const robot::RobotModel> model_;
  const typename Method::Law law_;

 public:
  const Input<ProximitySet> proximities;
  const Input<LinkPoses> links;
  const Input<Vector> wish;

 private:
  const Cached<Solution> solution_;

 public:
  const Output<Vector> velocity;
  const Output<Vector> share;
  const Output<Vector> rows;
};

}  // namespace oca::systems
