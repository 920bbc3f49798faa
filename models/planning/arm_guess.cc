// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/arm_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <string>

#include "oca/models/error.h"

namespace oca::planning {
namespace {

using robot::Joint;
using robot::RobotModel;

constexpr std::size_t kLeastBeforeHand = 4;  // joints of an arm that may end in a hand
constexpr int kLongestFinger = 5;            // joints
constexpr double kWidestJaw = 0.15;          // m
constexpr double kSameLine = 0.01;           // sine of the angle between two

bool HasPosition(const Joint& joint) { return joint.position_index >= 0; }

/// One call of GuessArm.
class ArmSearch {
 public:
  explicit ArmSearch(const RobotModel& model)
      : model_(model), below_(model.links().size()), length_(model.links().size(), 0) {
    for (int j = 0; j < model.num_joints(); ++j) {
      below_[model.joints()[j].parent_link].push_back(j);
    }
    for (int j = model.num_joints() - 1; j >= 0; --j) {  // children before parents
      const Joint& joint = model.joints()[j];
      int& length = length_[joint.parent_link];
      length = std::max(length, LengthFrom(j));
    }
  }

  ArmGuess Run() const {
    ArmGuess guess;
    int at = 0;
    while (true) {
      const std::vector<int> next = Next(at);
      if (next.empty() || IsHand(next, guess.joints.size())) break;
      const auto longest = std::max_element(
          next.begin(), next.end(), [this](int a, int b) { return LengthFrom(a) < LengthFrom(b); });
      guess.joints.push_back(*longest);
      at = model_.joints()[*longest].child_link;
    }
    if (guess.joints.size() < 2) {
      throw models::ModelError(fmt::format(
          "robot '{}': its arm; got {} joint{} one after the other; expected two or more",
          model_.name().text(), guess.joints.size(), guess.joints.size() == 1 ? "" : "s"));
    }
    if (guess.joints.size() > kMostArmJoints) {
      guess.joints.erase(guess.joints.begin(), guess.joints.end() - kMostArmJoints);
    }
    for (int j = 0; j < model_.num_joints(); ++j) {
      if (!HasPosition(model_.joints()[j])) continue;
      if (std::count(guess.joints.begin(), guess.joints.end(), j) == 0) guess.others.push_back(j);
    }
    guess.tip = FarthestFixedTo(model_, at);
    return guess;
  }

  /// Whether joint j, the last of a chain, is a jaw by its name or by a finger that mimics it.
  bool EndsInJaw(int j) const {
    const auto mimics = [this, j](const Joint& other) {
      return other.mimic.has_value() && other.mimic->joint == j && !Carries(j, other.parent_link);
    };
    return IsNamedJaw(model_.joints()[j]) ||
           std::any_of(model_.joints().begin(), model_.joints().end(), mimics);
  }

 private:
  /// Whether a link is beyond joint j.
  bool Carries(int j, int link) const {
    while (link != 0 && link != model_.joints()[j].child_link) {
      link = model_.joints()[link - 1].parent_link;
    }
    return link != 0;
  }

  /// Of the longest chain that begins with joint j, in joints that have a position.
  int LengthFrom(int j) const {
    const Joint& joint = model_.joints()[j];
    return length_[joint.child_link] + (HasPosition(joint) ? 1 : 0);
  }

  /// The next joints with a position below a link: beyond fixed ones and mimics.
  std::vector<int> Next(int link) const {
    std::vector<int> next;
    std::vector<int> pending{link};
    while (!pending.empty()) {
      const int at = pending.back();
      pending.pop_back();
      for (const int j : below_[at]) {
        if (HasPosition(model_.joints()[j])) {
          next.push_back(j);
        } else {
          pending.push_back(model_.joints()[j].child_link);
        }
      }
    }
    std::sort(next.begin(), next.end());
    return next;
  }

  bool IsHand(const std::vector<int>& next, std::size_t before) const {
    if (before < kLeastBeforeHand) return false;
    const int longest = LengthFrom(*std::max_element(
        next.begin(), next.end(), [this](int a, int b) { return LengthFrom(a) < LengthFrom(b); }));
    if (next.size() > 1) return longest <= kLongestFinger;
    return longest <= 2 && IsJaw(next.front());
  }

  /// What names tell: SO-101's `gripper` turns one jaw, which nothing mimics.
  bool IsNamedJaw(const Joint& joint) const {
    const auto has = [](std::string name, std::initializer_list<const char*> parts) {
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return std::any_of(parts.begin(), parts.end(), [&name](const char* part) {
        return name.find(part) != std::string::npos;
      });
    };
    return has(joint.name.text(), {"grip", "finger", "jaw", "claw"}) ||
           has(model_.links()[joint.child_link].name.text(), {"finger", "jaw", "claw"});
  }

  bool IsJaw(int j) const {
    const Joint& joint = model_.joints()[j];
    if (IsNamedJaw(joint)) return true;
    if (joint.type != robot::JointType::kPrismatic) return IsMimicked(j);
    return joint.upper_limit - joint.lower_limit <= kWidestJaw && !CarriesTurning(j) &&
           !IsTelescope(j);
  }

  bool IsMimicked(int j) const {
    return std::any_of(model_.joints().begin(), model_.joints().end(), [j](const Joint& other) {
      return other.mimic.has_value() && other.mimic->joint == j;
    });
  }

  /// Whether a joint beyond joint j turns: a wrist.
  bool CarriesTurning(int j) const {
    for (const int next : Next(model_.joints()[j].child_link)) {
      if (model_.joints()[next].type != robot::JointType::kPrismatic || CarriesTurning(next)) {
        return true;
      }
    }
    return false;
  }

  /// Whether the next joint with a position before it slides along the same line.
  bool IsTelescope(int j) const {
    const Joint& joint = model_.joints()[j];
    Eigen::Vector3d axis = joint.X_PJ.linear() * joint.axis;  // in the frame of its parent link
    for (int link = joint.parent_link; link != 0;) {          // which joint link - 1 carries
      const Joint& before = model_.joints()[link - 1];
      if (HasPosition(before)) {
        return before.type == robot::JointType::kPrismatic &&
               axis.cross(before.axis).norm() <= kSameLine;
      }
      axis = before.X_PJ.linear() * axis;
      link = before.parent_link;
    }
    return false;
  }

  const RobotModel& model_;
  std::vector<std::vector<int>> below_;  // joints below each link
  std::vector<int> length_;              // of the longest chain below each link
};

}  // namespace

int FarthestFixedTo(const RobotModel& model, int link) {
  const auto links = static_cast<std::size_t>(model.num_links());
  std::vector<std::optional<Eigen::Isometry3d>> X_LA(links);  // of those that are fixed to it
  X_LA[static_cast<std::size_t>(link)] = Eigen::Isometry3d::Identity();
  int farthest = link;
  double away = 0.0;
  for (const Joint& joint : model.joints()) {  // parents first
    const auto& X_LP = X_LA[static_cast<std::size_t>(joint.parent_link)];
    if (joint.movable() || !X_LP) continue;
    const Eigen::Isometry3d X_LC = *X_LP * joint.X_PJ;
    X_LA[static_cast<std::size_t>(joint.child_link)] = X_LC;
    if (X_LC.translation().norm() <= away) continue;
    away = X_LC.translation().norm();
    farthest = joint.child_link;
  }
  return farthest;
}

ArmGuess GuessArm(const RobotModel& model) { return ArmSearch(model).Run(); }

std::vector<int> JointsBesideArm(const RobotModel& model) {
  const ArmSearch search(model);
  try {
    ArmGuess guess = search.Run();
    if (search.EndsInJaw(guess.joints.back())) guess.others.push_back(guess.joints.back());
    return std::move(guess.others);
  } catch (const models::ModelError&) {
    return {};
  }
}

}  // namespace oca::planning
