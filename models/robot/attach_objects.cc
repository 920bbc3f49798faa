// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/attach_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"

namespace oca::robot {
namespace {

const Eigen::Vector4d kObjectColour{0.72, 0.58, 0.40, 1.0};

int FindLink(const std::vector<Link>& links, const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < links.size(); ++i) {
    names.push_back(links[i].name.text());
    if (names.back() == name) return static_cast<int>(i);
  }
  throw models::ModelError(
      fmt::format("{}: unknown link; got '{}'; expected a link of the robot, nearest is '{}'",
                  where, name, models::NearestName(name, names)));
}

void CheckId(const std::vector<Link>& links, const std::vector<Joint>& joints,
             const std::string& id, const std::string& where) {
  const auto named = [&id](const auto& item) { return item.name.text() == id; };
  const bool taken = std::any_of(links.begin(), links.end(), named) ||
                     std::any_of(joints.begin(), joints.end(), named);
  if (!id.empty() && !taken) return;
  throw models::ModelError(fmt::format("{}: id; got {}; expected a name of its own", where,
                                       id.empty() ? "an empty one" : "one that is taken"));
}

}  // namespace

RobotModel AttachObjects(const RobotModel& robot, std::span<const AttachedObject> objects) {
  std::vector<Link> links = robot.links();
  std::vector<Joint> joints = robot.joints();
  std::vector<std::pair<int, int>> disabled = robot.disabled_pairs();
  for (const AttachedObject& object : objects) {
    const std::string where =
        fmt::format("robot '{}' attached object '{}'", robot.name().text(), object.id);
    CheckId(links, joints, object.id, where);
    const int number = static_cast<int>(links.size());
    Joint joint;
    joint.name = models::Name(object.id);
    joint.parent_link = FindLink(links, object.link, where);
    joint.child_link = number;
    joint.X_PJ = object.X_LO;
    Link link;
    link.name = models::Name(object.id);
    link.collisions.push_back({Eigen::Isometry3d::Identity(), object.shape, where});
    link.attached = true;
    VisualElement visual;
    visual.shape = object.shape;
    visual.colour = kObjectColour;
    link.visuals.push_back(std::move(visual));
    for (const std::string& touched : object.touches) {
      disabled.emplace_back(FindLink(links, touched, where + " touches"), number);
    }
    joints.push_back(std::move(joint));
    links.push_back(std::move(link));
  }
  return {robot.name(), std::move(links),    std::move(joints),
          robot.X_WB(), std::move(disabled), robot.states()};
}

}  // namespace oca::robot
