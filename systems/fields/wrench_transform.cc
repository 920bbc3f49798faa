// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/wrench_transform.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {

void WrenchTransform::Params::Describe(Fields<Params>& /*fields*/) {}

WrenchTransform::WrenchTransform(const Params& /*params*/)
    : forces(DeclareInput<LinkForceSet>("forces")),
      links(DeclareInput<LinkPoses>("links")),
      wrenches(
          DeclareOutput<WrenchSet, &WrenchTransform::CalcWrenches>("wrenches", {}, forces, links)),
      wrenches_in_link(DeclareOutput<WrenchSet, &WrenchTransform::CalcInLink>(
          "wrenches_in_link", {}, wrenches, links)) {
  DeclareRole(NotDrawn{wrenches_in_link});
}

void WrenchTransform::CalcWrenches(const LinkForceSet& force_set, const LinkPoses& poses,
                                   WrenchSet& wrench_set) const {
  auto& all = wrench_set.wrenches;
  all.clear();
  all.reserve(poses.size());
  int index = 0;  // the next force is often on the same link or a later one
  for (const LinkForce& force : force_set.forces) {
    index = poses.Find(force.link, index);
    if (index < 0) {
      throw ConfigError(
          fmt::format("forces: got one on '{}'; expected a link of `links`", force.link.text()));
    }
    const int body = poses.bodies[index];
    if (body < 0) continue;
    auto wrench = std::find_if(all.begin(), all.end(), [&](const LinkWrench& other) {
      return other.link == poses.links[body];
    });
    if (wrench == all.end()) {
      all.push_back({poses.links[body], Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                     poses.poses[body].translation()});
      wrench = all.end() - 1;
    }
    wrench->force += force.force;
    wrench->torque += (force.point - wrench->origin).cross(force.force);
  }
}

void WrenchTransform::CalcInLink(const WrenchSet& in_world, const LinkPoses& poses,
                                 WrenchSet& in_link) const {
  in_link.wrenches.clear();
  in_link.wrenches.reserve(poses.size());
  int index = 0;
  for (const LinkWrench& wrench : in_world.wrenches) {
    index = poses.Find(wrench.link, index);
    const auto R_LW = poses.poses[index].linear().transpose();
    in_link.wrenches.push_back(
        {wrench.link, R_LW * wrench.force, R_LW * wrench.torque, Eigen::Vector3d::Zero()});
  }
}

}  // namespace oca::systems
