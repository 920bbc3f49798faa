// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/jacobian_mapping.h"

#include <optional>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/require.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/fields/loop_gain.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {

struct JacobianMapping::Solution {
  Eigen::VectorXd delta;
  bool regularised{false};
  std::vector<robot::BodyWrench> body_wrenches;
  std::vector<Eigen::Isometry3d> reordered;
  std::optional<robot::MappingWorkspace> workspace;
};

robot::MappingSettings MappingSettingsOf(const JacobianMapping::Params& params) {
  Validated(params);
  using Method = JacobianMapping::Method;
  switch (params.method) {
    case Method::kTranspose:
      return {robot::MappingMethod::kTranspose, params.alpha, 0.0};
    case Method::kPseudoInverse:
      return {robot::MappingMethod::kPseudoInverse, params.alpha, 0.0};
    case Method::kDamped:
      RequireAbove("damping", params.damping, 0.0);
      return {robot::MappingMethod::kDamped, params.alpha, params.damping};
  }
  throw ConfigError("method: got no such method; expected transpose, pseudo_inverse or damped");
}

void JacobianMapping::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  fields.Add("alpha", &Params::alpha, "", "factor of the delta; absorbs the unit of the wrench");
  fields.Add("method", &Params::method, "", "how wrenches become joint offsets");
  fields
      .Add("damping", &Params::damping, "m", "lambda of the method damped, which needs more than 0")
      .AtLeast(0.0);
}

JacobianMapping::JacobianMapping(const Params& params, const ModelSet& models)
    : params_(params),
      model_(MovableModel(models, params.model)),
      settings_(MappingSettingsOf(params)),
      wrenches(DeclareInput<WrenchSet>("wrenches")),
      links(DeclareInput<LinkPoses>("links")),
      solution_(DeclareCached<&JacobianMapping::CalcSolution>(wrenches, links)),
      delta(DeclareOutput<Vector, &Solution::delta>("delta", DeltaSpec(*model_), solution_)),
      regularised(DeclareOutput<Vector, &Solution::regularised>("regularised", {1, Unit::Any()},
                                                                solution_)) {
  DeclareRole(MapsForces{
      .links = links, .delta = delta, .make_gain = [params, models](const Period& period) {
        LoopGain::Params gain{.period = period};
        gain.model = params.model;
        gain.alpha = params.alpha;
        gain.method = params.method;
        gain.damping = params.damping;
        return std::make_unique<LoopGain>(gain, models);
      }});
}

void JacobianMapping::CalcSolution(const WrenchSet& wrench_set, const LinkPoses& poses,
                                   Solution& result) const {
  if (!result.workspace) result.workspace.emplace(*model_);
  result.delta.resize(model_->num_positions());
  result.body_wrenches.assign(model_->bodies().size(), robot::BodyWrench{});
  const auto X_WL = PosesInOrder(*model_, poses, result.reordered);
  for (const LinkWrench& wrench : wrench_set.wrenches) {
    const int link = LinkNumber(*model_, wrench.link, "wrenches");
    if (model_->body(link) < 0) continue;
    const Eigen::Vector3d origin = X_WL[model_->body(link)].translation();
    robot::BodyWrench& sum = result.body_wrenches[model_->body_index(link)];
    sum.force += wrench.force;
    sum.torque += wrench.torque + (wrench.origin - origin).cross(wrench.force);
  }
  const auto status = robot::MapWrenches(*model_, X_WL, result.body_wrenches, settings_,
                                         *result.workspace, result.delta);
  result.regularised = status == robot::MappingStatus::kRegularised;
}

}  // namespace oca::systems
