// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/attractive_field.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

AttractiveField::Params Checked(const AttractiveField::Params& params) {
  Validated(params);
  if (params.link.empty()) throw ConfigError("link: got an empty text; expected a link's name");
  return params;
}

}  // namespace

void AttractiveField::Params::Describe(Fields<Params>& fields) {
  fields.Add("link", &Params::link, "", "the link that is pulled").Required();
  fields.Add("point", &Params::point, "m", "where it is pulled, in the link's frame");
  fields.Add("target", &Params::target, "m", "where to, in the world").Required();
  fields.Add("gain", &Params::gain, "N/m", "gain k_p of eq. (2.2)").AtLeast(0.0);
  fields
      .Add("saturation_distance", &Params::saturation_distance, "m",
           "distance from the target beyond which the force does not grow")
      .Above(0.0);
}

AttractiveField::Params AttractiveField::Example() {
  Params params;
  params.link = "lwr4_link_7";
  params.target = {0.0, 0.6, 1.0};
  return params;
}

AttractiveField::AttractiveField(const Params& params)
    : params_(Checked(params)),
      link_(params_.link),
      target_name_("target"),
      links(DeclareInput<LinkPoses>("links")),
      forces(DeclareOutput<LinkForceSet, &AttractiveField::CalcForces>("forces", {}, links)) {
  DeclareRole(Limits{.shown = Limits::Shown::kListed,
                     .signal = forces,
                     .member = "forces",
                     .how = "pulled to its target"});
}

void AttractiveField::CalcForces(const LinkPoses& poses, LinkForceSet& force_set) const {
  const int index = poses.Find(link_);
  if (index < 0) {
    throw ConfigError(
        fmt::format("links: got no pose of '{}'; expected one, the parameter link", link_.text()));
  }
  const Eigen::Vector3d x = poses.poses[index] * params_.point;
  const Eigen::Vector3d error = x - params_.target;
  const double distance = error.norm();
  const double scale =
      distance > params_.saturation_distance ? params_.saturation_distance / distance : 1.0;
  force_set.forces.resize(1);
  force_set.forces[0] = {link_, target_name_, -params_.gain * scale * error, x};
}

}  // namespace oca::systems
