// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/model_links.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/robot_model.h"

namespace oca::systems {
namespace {

bool InOrder(const robot::RobotModel& model, const LinkPoses& links) {
  if (static_cast<int>(links.size()) != model.num_links()) return false;
  for (int i = 0; i < model.num_links(); ++i) {
    if (!(links.links[i] == model.links()[i].name)) return false;
  }
  return true;
}

}  // namespace

std::shared_ptr<const robot::RobotModel> MovableModel(const ModelSet& models,
                                                      const std::string& name) {
  auto model = models.Get(name);
  if (model->num_positions() > 0) return model;
  throw ConfigError(fmt::format("model: got '{}', which has no movable joint; expected a robot",
                                model->name().text()));
}

PortSpec DeltaSpec(const robot::RobotModel& model) {
  const std::string_view unit = model.position_unit();
  return {model.num_positions(), unit == "mixed" ? Unit::Any() : Unit(std::string(unit))};
}

PortSpec PositionSpec(const robot::RobotModel& model) {
  const Eigen::Index n = model.num_positions();
  Plausible plausible{Eigen::VectorXd(n), Eigen::VectorXd(n), {}, robot::kPossibleRule};
  plausible.names.reserve(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    std::tie(plausible.lower[i], plausible.upper[i]) = robot::PossibleRange(model, i);
    plausible.names.push_back("joint '" +
                              model.position_names()[static_cast<std::size_t>(i)].text() + "'");
  }
  PortSpec spec = DeltaSpec(model);
  spec.plausible = std::make_shared<const Plausible>(std::move(plausible));
  return spec;
}

PortSpec RateSpec(const robot::RobotModel& model) {
  const PortSpec position = DeltaSpec(model);
  return {position.size, position.unit.Rate()};
}

void NameLinks(const robot::RobotModel& model, LinkPoses& poses) {
  for (int i = 0; i < model.num_links(); ++i) {
    poses.links.push_back(model.links()[i].name);
    poses.bodies.push_back(model.body(i));
  }
  poses.poses.resize(poses.links.size());
}

int LinkNumber(const robot::RobotModel& model, models::Name link, const char* port) {
  const auto& links = model.links();
  const auto found = std::find_if(links.begin(), links.end(),
                                  [&](const robot::Link& other) { return other.name == link; });
  if (found != links.end()) return static_cast<int>(found - links.begin());
  throw ConfigError(fmt::format("{}: got one on '{}'; expected a link of '{}'", port, link.text(),
                                model.name().text()));
}

std::span<const Eigen::Isometry3d> PosesInOrder(const robot::RobotModel& model,
                                                const LinkPoses& links,
                                                std::vector<Eigen::Isometry3d>& reordered) {
  if (InOrder(model, links)) return links.poses;
  reordered.resize(model.links().size());
  std::size_t found = 0;
  for (int i = 0; i < model.num_links(); ++i) {
    const robot::Link& link = model.links()[i];
    const int index = links.Find(link.name, i);
    if (index >= 0) {
      reordered[i] = links.poses[index];
      ++found;
    } else if (link.parent_joint < 0) {
      reordered[i] = model.X_WB();
    } else if (const auto& joint = model.joints()[link.parent_joint]; !joint.movable()) {
      reordered[i] = reordered[joint.parent_link] * joint.X_PJ;
    } else {
      throw ConfigError(fmt::format("links: got no pose of '{}'; expected one of each movable link",
                                    link.name.text()));
    }
  }
  if (found < links.size()) {
    throw ConfigError(fmt::format("links: got a link that is not of '{}'; expected its own links",
                                  model.name().text()));
  }
  return reordered;
}

}  // namespace oca::systems
