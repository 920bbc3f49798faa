// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/robot_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/joint_limits.h"

namespace oca::robot {
namespace {

// Looks `name` up in the .name of every item.
template <typename Item>
int Find(const std::vector<Item>& items, std::string_view name, std::string_view kind,
         models::Name robot) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name.text() == name) return static_cast<int>(i);
    names.push_back(items[i].name.text());
  }
  throw models::ModelError(
      fmt::format("robot '{}': unknown {}; got '{}'; expected a {} of the robot, nearest is '{}'",
                  robot.text(), kind, name, kind, models::NearestName(name, names)));
}

void CheckPose(const Eigen::Isometry3d& X, const std::string& where) {
  if (!X.matrix().allFinite()) {
    throw models::ModelError(where +
                             ": pose; got a number that is not finite; expected finite numbers");
  }
  const Eigen::Matrix3d R = X.linear();
  if (!(R.transpose() * R).isIdentity(1e-9) || R.determinant() < 0.0) {
    throw models::ModelError(where +
                             ": pose; got a matrix that is no rotation; expected a rotation");
  }
}

// -1, or the coordinate axis that `axis` is parallel to.
int ParallelTo(const Eigen::Vector3d& axis) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) == 1.0) return i;
  }
  return -1;
}

}  // namespace

RobotModel::RobotModel(models::Name name, std::vector<Link> links, std::vector<Joint> joints,
                       const Eigen::Isometry3d& X_WB,
                       std::vector<std::pair<int, int>> disabled_pairs,
                       std::vector<NamedState> states)
    : name_(name),
      links_(std::move(links)),
      joints_(std::move(joints)),
      X_WB_(X_WB),
      disabled_pairs_(std::move(disabled_pairs)),
      states_(std::move(states)) {
  CheckTree();
  NumberPositions();
  CompileSteps();
  CollectLimits();
  AssignBodies();
  for (auto& [a, b] : disabled_pairs_) {
    if (a > b) std::swap(a, b);
  }
  std::sort(disabled_pairs_.begin(), disabled_pairs_.end());
  disabled_pairs_.erase(std::unique(disabled_pairs_.begin(), disabled_pairs_.end()),
                        disabled_pairs_.end());
}

RobotModel RobotModel::At(const Eigen::Isometry3d& X_WB) const {
  CheckPose(X_WB, fmt::format("robot '{}' base", name_.text()));
  RobotModel placed = *this;
  placed.X_WB_ = X_WB;
  return placed;
}

void RobotModel::CheckTree() const {
  const std::string where = fmt::format("robot '{}'", name_.text());
  if (links_.empty()) throw models::ModelError(where + ": links; got none; expected at least one");
  if (joints_.size() + 1 != links_.size()) {
    throw models::ModelError(
        fmt::format("{}: joints; got {} for {} links; expected one less than links", where,
                    joints_.size(), links_.size()));
  }
  CheckPose(X_WB_, where + " base");
  for (const Link& link : links_) CheckInertia(link);
  for (int j = 0; j < num_joints(); ++j) {
    if (joints_[j].child_link != j + 1 || joints_[j].parent_link < 0 ||
        joints_[j].parent_link > j) {
      throw models::ModelError(fmt::format(
          "{}: joint '{}'; got links {} -> {}; expected parents first, child {}", where,
          joints_[j].name.text(), joints_[j].parent_link, joints_[j].child_link, j + 1));
    }
    CheckJoint(joints_[j]);
  }
  for (const auto& [a, b] : disabled_pairs_) {
    if (std::min(a, b) < 0 || std::max(a, b) >= num_links()) {
      throw models::ModelError(
          fmt::format("{}: disabled pair; got ({}, {}); expected link numbers below {}", where, a,
                      b, num_links()));
    }
  }
}

void RobotModel::CheckJoint(const Joint& joint) const {
  const std::string where = fmt::format("robot '{}' joint '{}'", name_.text(), joint.name.text());
  CheckPose(joint.X_PJ, where);
  if (!joint.movable()) {
    if (!joint.mimic) return;
    throw models::ModelError(where +
                             ": mimic; got one of a fixed joint; expected a joint that moves");
  }
  // Negated comparisons, so that NaN is refused too.
  if (!(std::abs(joint.axis.norm() - 1.0) < 1e-9)) {
    throw models::ModelError(
        fmt::format("{}: axis; got length {}; expected a unit vector", where, joint.axis.norm()));
  }
  if (!(joint.lower_limit <= joint.upper_limit)) {
    throw models::ModelError(
        fmt::format("{}: limits; got lower {} and upper {}; expected lower <= upper", where,
                    joint.lower_limit, joint.upper_limit));
  }
  for (const double limit : {joint.velocity_limit, joint.effort_limit}) {
    if (!(limit >= 0.0)) {
      throw models::ModelError(
          fmt::format("{}: velocity or effort limit; got {}; expected >= 0", where, limit));
    }
  }
  for (const double limit : {joint.acceleration_limit, joint.jerk_limit}) {
    if (!(limit > 0.0)) {
      throw models::ModelError(
          fmt::format("{}: acceleration or jerk limit; got {}; expected > 0", where, limit));
    }
  }
}

void RobotModel::CheckInertia(const Link& link) const {
  const auto& [mass, p_LC, I_C] = link.inertia;
  const auto fail = [&](const std::string& what, const std::string& got, const char* expected) {
    throw models::ModelError(fmt::format("robot '{}' link '{}': {}; got {}; expected {}",
                                         name_.text(), link.name.text(), what, got, expected));
  };
  if (!std::isfinite(mass) || !p_LC.allFinite() || !I_C.allFinite()) {
    fail("inertia", "a number that is not finite", "finite numbers");
  }
  if (mass < 0.0) fail("mass", fmt::format("{} kg", mass), ">= 0");
}

void RobotModel::NumberPositions() {
  for (int j = 0; j < num_joints(); ++j) {
    links_[j + 1].parent_joint = j;
    joints_[j].position_index = -1;
    if (joints_[j].movable() && !joints_[j].mimic) {
      joints_[j].position_index = num_positions();
      position_names_.push_back(joints_[j].name);
    }
  }
  links_[0].parent_joint = -1;
}

void RobotModel::CompileSteps() {
  for (const Joint& joint : joints_) {
    KinematicStep step{joint.type,
                       joint.parent_link,
                       joint.position_index,
                       3,
                       true,
                       1.0,
                       1.0,
                       0.0,
                       joint.X_PJ.translation(),
                       joint.axis,
                       joint.X_PJ.linear()};
    step.rotated = step.R_PJ != Eigen::Matrix3d::Identity();
    if (const int parallel = ParallelTo(joint.axis); parallel >= 0) {
      step.principal_axis = parallel;
      step.sign = joint.axis[parallel];
    }
    // A mimic of a mimic is followed to the joint that has a position of its own.
    const Joint* at = &joint;
    for (int hops = 0; at->movable() && at->mimic; ++hops) {
      const Mimic& rule = *at->mimic;
      const bool known = rule.joint >= 0 && rule.joint < num_joints();
      if (!known || !joints_[rule.joint].movable() || hops > num_joints() ||
          !std::isfinite(rule.multiplier) || !std::isfinite(rule.offset)) {
        throw models::ModelError(fmt::format(
            "robot '{}' joint '{}': mimic; got {}; expected a finite rule that leads to a movable "
            "joint which mimics none",
            name_.text(), joint.name.text(),
            !known                           ? "an unknown joint"
            : !joints_[rule.joint].movable() ? "a fixed joint"
            : hops > num_joints()            ? "a loop"
                                             : "a number that is not finite"));
      }
      step.offset += step.multiplier * rule.offset;
      step.multiplier *= rule.multiplier;
      at = &joints_[rule.joint];
    }
    step.column = at->position_index;
    steps_.push_back(step);
  }
}

void RobotModel::CollectLimits() {
  const int n = num_positions();
  for (Eigen::VectorXd* limits : {&lower_limits_, &upper_limits_, &velocity_limits_,
                                  &effort_limits_, &acceleration_limits_, &jerk_limits_}) {
    limits->resize(n);
  }
  const auto all = LimitsOfPositions(name_, joints_, steps_);
  for (int i = 0; i < n; ++i) {
    const PositionLimits& limits = all[static_cast<std::size_t>(i)];
    lower_limits_[i] = limits.lower;
    upper_limits_[i] = limits.upper;
    velocity_limits_[i] = limits.velocity;
    effort_limits_[i] = limits.effort;
    acceleration_limits_[i] = limits.acceleration;
    jerk_limits_[i] = limits.jerk;
  }
}

void RobotModel::AssignBodies() {
  body_of_link_.assign(links_.size(), -1);
  body_index_of_link_.assign(links_.size(), -1);
  for (int j = 0; j < num_joints(); ++j) {
    const int link = j + 1;
    if (joints_[j].movable()) {
      body_of_link_[link] = link;
      body_index_of_link_[link] = num_bodies();
      bodies_.push_back(link);
    } else {
      body_of_link_[link] = body_of_link_[joints_[j].parent_link];
      body_index_of_link_[link] = body_index_of_link_[joints_[j].parent_link];
    }
  }
}

std::string_view RobotModel::position_unit() const {
  bool angle = false;
  bool length = false;
  for (const Joint& joint : joints_) {
    if (joint.position_index < 0) continue;
    (joint.type == JointType::kPrismatic ? length : angle) = true;
  }
  if (angle && length) return "mixed";
  return length ? "m" : "rad";
}

bool RobotModel::collision_disabled(int link_a, int link_b) const {
  const auto pair = std::minmax(link_a, link_b);
  return link_a == link_b || std::binary_search(disabled_pairs_.begin(), disabled_pairs_.end(),
                                                std::pair<int, int>(pair.first, pair.second));
}

int RobotModel::BodyByDesign(int link) const {
  for (; link > 0; link = joints_[link - 1].parent_link) {
    if (joints_[link - 1].movable() || joints_[link - 1].held) break;
  }
  return link;
}

bool RobotModel::adjacent(int link_a, int link_b) const {
  if (body(link_a) == body(link_b)) return true;
  if (links_[link_a].attached || links_[link_b].attached) return false;
  const int a = BodyByDesign(link_a);
  const int b = BodyByDesign(link_b);
  // The body one joint nearer to the root.
  const auto before = [this](int body_link) {
    return BodyByDesign(joints_[body_link - 1].parent_link);
  };
  return a == b || (a > 0 && before(a) == b) || (b > 0 && before(b) == a);
}

int RobotModel::FindLink(std::string_view name) const { return Find(links_, name, "link", name_); }

int RobotModel::FindJoint(std::string_view name) const {
  return Find(joints_, name, "joint", name_);
}

int RobotModel::FindPosition(std::string_view joint_name) const {
  const Joint& joint = joints_[FindJoint(joint_name)];
  if (joint.position_index < 0) {
    throw models::ModelError(
        fmt::format("robot '{}': position of joint; got '{}', which is {}; expected a joint that "
                    "moves by itself",
                    name_.text(), joint_name,
                    joint.movable() ? "a mimic"
                    : joint.held    ? "held"
                                    : "fixed"));
  }
  return joint.position_index;
}

}  // namespace oca::robot
