// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/scene_problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/planning/rrt_connect.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/scenes/scene_families.h"

namespace oca::scenes {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kWayMargin = 0.004;  // m
constexpr int kWayNodes = 6000;       // of a search
constexpr int kWaySearches = 2;
constexpr double kUsualStretch = 0.9;  // m; at scale 1
// Of the tip from what it reaches for, m at scale 1: room for a gripper, or hardly any.
constexpr double kLeastStandOff = 0.03;
constexpr double kMostStandOff = 0.1;

/// The tip at a point, its z along `z`, turned about it by `roll`.
Isometry3d TipPose(const Vector3d& p_WT, const Vector3d& z, double roll) {
  Isometry3d X_WT = Isometry3d::Identity();
  X_WT.translation() = p_WT;
  X_WT.linear() = (Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), z) *
                   Eigen::AngleAxisd(roll, Vector3d::UnitZ()))
                      .toRotationMatrix();
  return X_WT;
}

/// How far the tip gets from the second joint, the shoulder: the most of some postures.
double StretchOf(const robot::RobotModel& model, int tip) {
  constexpr int kPostures = 2000;
  models::Random random(0);
  VectorXd q(model.num_positions());
  std::vector<Isometry3d> X_WL(static_cast<std::size_t>(model.num_links()));
  const auto& bodies = model.bodies();
  const auto shoulder =
      static_cast<std::size_t>(bodies[std::min<std::size_t>(1, bodies.size() - 1)]);
  double most = 0.0;
  for (int i = 0; i < kPostures; ++i) {
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const auto range = robot::DrawnRange(model, j).value_or(std::pair(0.0, 0.0));
      q[j] = random.Uniform(range.first, range.second);
    }
    robot::ForwardKinematics(model, q, X_WL);
    most = std::max(
        most,
        (X_WL[static_cast<std::size_t>(tip)].translation() - X_WL[shoulder].translation()).norm());
  }
  return most;
}

/// One call of MakeSceneProblem.
class ProblemMaker {
 public:
  ProblemMaker(std::shared_ptr<const robot::RobotModel> model, int tip, std::uint64_t seed)
      : model_(std::move(model)),
        tip_(tip),
        scale_(StretchOf(*model_, tip) / kUsualStretch),
        random_(seed),
        clearance_(model_, true),
        rest_(Rest()) {}

  std::optional<SceneProblem> Try(std::string_view family) {
    const FurnishedScene scene = Furnish(family, scale_, random_);
    Surround(scene);
    const auto start = scene.starts_below ? Below(scene) : std::optional(rest_);
    if (!start || !Clear(*start)) return std::nullopt;
    const auto goal = Grasp(scene, *start);
    if (!goal || !HasWay(*start, *goal)) return std::nullopt;
    return SceneProblem{scene.objects, *start, *goal};
  }

 private:
  /// In front of the arm, the hand down: the first of some places that it reaches.
  VectorXd Rest() {
    VectorXd middle = VectorXd::Zero(model_->num_positions());
    middle = middle.cwiseMax(model_->lower_limits()).cwiseMin(model_->upper_limits());
    for (const double share : {0.45, 0.4, 0.5, 0.35, 0.55}) {
      const auto found = robot::SolveInverseKinematics(
          *model_, tip_, TipPose(scale_ * Vector3d(share, 0.0, share), -Vector3d::UnitZ(), 0.0),
          middle, {.solutions = 20, .clearance = 0.03}, &clearance_);
      if (found.reached && Clear(found.q)) return found.q;
    }
    throw models::ModelError(
        fmt::format("robot '{}': posture of rest; got none; expected one with its tip down, half "
                    "its reach in front of it",
                    model_->name().text()));
  }

  void Surround(const FurnishedScene& scene) {
    std::vector<robot::PlacedBody> bodies;
    for (const SceneObject& object : scene.objects) {
      const auto& shape = std::get<geometry::Shape>(object.bodies.front().shape);
      bodies.push_back({geometry::MakeCollider(shape, object.id), object.X_FO});
    }
    clearance_.SetBodies(std::move(bodies));
  }

  bool Clear(const VectorXd& q) {
    clearance_.MoveTo(q);
    return !clearance_.NearerThan(kProblemClearance);
  }

  std::optional<VectorXd> Reach(const Isometry3d& X_WT, const VectorXd& from) {
    robot::InverseKinematicsSettings settings;
    settings.solutions = 6;
    settings.starts = 40;
    settings.clearance = 1.5 * kProblemClearance;
    settings.seed = random_.Bits();
    const auto found =
        robot::SolveInverseKinematics(*model_, tip_, X_WT, from, settings, &clearance_);
    if (!found.reached || !Clear(found.q)) return std::nullopt;
    return found.q;
  }

  std::optional<VectorXd> Grasp(const FurnishedScene& scene, const VectorXd& from) {
    const bool down = scene.approach.z() < -0.8;
    const double half = down ? 0.5 * scene.target_height : scene.target_radius;
    const double stand_off = scale_ * random_.Uniform(kLeastStandOff, kMostStandOff);
    const Vector3d p_WT = scene.target - (half + stand_off) * scene.approach;
    const double roll = random_.Uniform(-std::numbers::pi, std::numbers::pi);
    return Reach(TipPose(p_WT, scene.approach, roll), from);
  }

  std::optional<VectorXd> Below(const FurnishedScene& scene) {
    const Vector3d p_FT(random_.Uniform(-0.55, -0.3) * scale_, random_.Uniform(-0.4, 0.4) * scale_,
                        scene.table - random_.Uniform(0.12, 0.3) * scale_);
    const Vector3d z_F = Vector3d(1.0, random_.Uniform(-0.5, 0.5), random_.Uniform(-0.5, 0.5));
    return Reach(TipPose(scene.X_WF * p_FT, scene.X_WF.linear() * z_F.normalized(),
                         random_.Uniform(-std::numbers::pi, std::numbers::pi)),
                 rest_);
  }

  bool HasWay(const VectorXd& start, const VectorXd& goal) {
    for (int i = 0; i < kWaySearches; ++i) {
      const planning::RrtOptions options{
          .seed = random_.Bits(), .margin = kWayMargin, .most_nodes = kWayNodes, .shortcuts = 0};
      if (planning::RrtConnect(clearance_, start, goal, options)) return true;
    }
    return false;
  }

  const std::shared_ptr<const robot::RobotModel> model_;
  const int tip_;
  const double scale_;
  models::Random random_;
  robot::Clearance clearance_;
  const VectorXd rest_;
};

std::string ListOf(const Eigen::Ref<const VectorXd>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(fmt::format("{}", number));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string NamesOf(const robot::RobotModel& model) {
  std::vector<std::string> names;
  for (const models::Name& name : model.position_names()) names.push_back(name.text());
  return fmt::format("[{}]", fmt::join(names, ", "));
}

std::string PrimitiveOfText(const geometry::Shape& shape) {
  if (const auto* const box = std::get_if<geometry::Box>(&shape)) {
    return fmt::format("{{type: box, dimensions: {}}}", ListOf(box->size));
  }
  const auto& cylinder = std::get<geometry::Cylinder>(shape);
  return fmt::format("{{type: cylinder, dimensions: [{}, {}]}}", cylinder.length, cylinder.radius);
}

}  // namespace

SceneProblem MakeSceneProblem(const std::shared_ptr<const robot::RobotModel>& model, int tip,
                              std::string_view family, std::uint64_t seed, int most_tries) {
  ProblemMaker maker(model, tip, models::Random::Seed(seed, family));
  for (int i = 1; i <= most_tries; ++i) {
    if (auto problem = maker.Try(family)) {
      problem->tries = i;
      return std::move(*problem);
    }
  }
  throw models::ModelError(fmt::format(
      "robot '{}': a task in '{}'; got none in {} scenes; expected one with start and goal {} m "
      "from everything, and a way",
      model->name().text(), family, most_tries, kProblemClearance));
}

std::string SceneYaml(const robot::RobotModel& model, const SceneProblem& problem) {
  std::string text = fmt::format(
      "robot_model_name: {}\nrobot_state:\n  joint_state:\n    name: {}\n    position: {}\n"
      "world:\n  collision_objects:\n",
      model.name().text(), NamesOf(model), ListOf(problem.start));
  for (const SceneObject& object : problem.objects) {
    const auto& shape = std::get<geometry::Shape>(object.bodies.front().shape);
    const Eigen::Quaterniond q(object.X_FO.linear());
    text += fmt::format(
        "    - id: {}\n      primitives:\n        - {}\n      primitive_poses:\n"
        "        - position: {}\n          orientation: {}\n",
        object.id, PrimitiveOfText(shape), ListOf(object.X_FO.translation()), ListOf(q.coeffs()));
  }
  return text;
}

std::string RequestYaml(const robot::RobotModel& model, const SceneProblem& problem) {
  std::string text = fmt::format(
      "start_state:\n  joint_state:\n    name: {}\n    position: {}\n"
      "goal_constraints:\n  - joint_constraints:\n",
      NamesOf(model), ListOf(problem.start));
  for (int i = 0; i < model.num_positions(); ++i) {
    text +=
        fmt::format("      - {{joint_name: {}, position: {}}}\n",
                    model.position_names()[static_cast<std::size_t>(i)].text(), problem.goal[i]);
  }
  return text;
}

}  // namespace oca::scenes
