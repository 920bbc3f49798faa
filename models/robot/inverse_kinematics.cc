// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/inverse_kinematics.h"

#include <ceres/tiny_solver.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/random.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/pose_error.h"

namespace oca::robot {
namespace {

constexpr double kPi = std::numbers::pi;
// How strongly a solution is drawn to the start, in turn (the pose has weight 1).
constexpr double kPostureWeights[] = {0.1, 0.01, 0.001};
constexpr double kClearanceWeight = 0.3;
// Aimed at beyond the wanted clearance (m), for the pull to the start takes a little of it.
constexpr double kClearanceSlack = 1e-3;
// Clearances that differ by less are equal (m).
constexpr double kSameClearance = 1e-4;
constexpr int kSearchIterations = 30;
constexpr int kDrawIterations = 12;

/// What is made small, for ceres::TinySolver, behind each other:
///
///   6  the pose error at the clamped position q, 0 for what is free
///   n  x - q, what lies beyond the limits
///   n  w (q - start), and
///   a row a link for what lacks of the clearance, both only if the weight w is positive
class Residuals {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

  Residuals(const RobotModel& model, int link, const Eigen::Isometry3d& X_WG,
            const Eigen::VectorXd& start, const InverseKinematicsSettings& settings,
            Clearance* surroundings)
      : model_(model),
        link_(link),
        X_WG_(X_WG),
        start_(start),
        turns_freely_(settings.turns_freely),
        aim_(settings.clearance + kClearanceSlack),
        surroundings_(surroundings),
        X_WL_(model.links().size()),
        J_(6, start.size()),
        q_(start.size()),
        row_(start.size()) {}

  void set_posture_weight(double weight) { posture_weight_ = weight; }
  int NumParameters() const { return static_cast<int>(start_.size()); }
  int NumResiduals() const {
    if (posture_weight_ <= 0.0) return 6 + NumParameters();
    return 6 + 2 * NumParameters() + (surroundings_ == nullptr ? 0 : model_.num_links());
  }

  Vector6 ErrorAt(const Eigen::VectorXd& q) const {
    ForwardKinematics(model_, q, X_WL_);
    Vector6 error = PoseError(X_WL_[link_], X_WG_);
    if (turns_freely_) error.tail<3>().setZero();
    return error;
  }

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const Eigen::Index n = start_.size();
    const Eigen::Map<const Eigen::VectorXd> x(parameters, n);
    Eigen::Map<Eigen::VectorXd> r(residuals, NumResiduals());
    q_ = x.cwiseMax(model_.lower_limits()).cwiseMin(model_.upper_limits());
    r.setZero();
    r.head<6>() = ErrorAt(q_);
    r.segment(6, n) = x - q_;
    if (posture_weight_ > 0.0) r.segment(6 + n, n) = posture_weight_ * (q_ - start_);
    if (jacobian == nullptr) {
      AddClearance(r, nullptr);
      return true;
    }
    Eigen::Map<Eigen::MatrixXd> J(jacobian, r.size(), n);
    J.setZero();
    PoseErrorJacobian(model_, X_WL_, link_, X_WG_, J_);
    J.topRows<6>() = J_;
    if (turns_freely_) J.middleRows<3>(3).setZero();
    if (posture_weight_ > 0.0) J.middleRows(6 + n, n).diagonal().setConstant(posture_weight_);
    AddClearance(r, &J);
    for (Eigen::Index j = 0; j < n; ++j) {
      if (x[j] == q_[j]) continue;  // beyond its limit a position changes just what lies beyond
      J.col(j).setZero();
      J(6 + j, j) = 1.0;
    }
    return true;
  }

 private:
  // The row of a link is that of its nearest pair.
  void AddClearance(Eigen::Map<Eigen::VectorXd>& r, Eigen::Map<Eigen::MatrixXd>* J) const {
    if (surroundings_ == nullptr || posture_weight_ <= 0.0) return;
    surroundings_->MoveTo(q_);
    surroundings_->Collect(aim_, pairs_);
    for (const NearPair& pair : pairs_) {
      const Eigen::Index at = 6 + 2 * start_.size() + pair.link;
      const double lack = kClearanceWeight * (aim_ - pair.distance);
      if (lack <= r[at]) continue;
      r[at] = lack;
      if (J == nullptr) continue;
      surroundings_->Gradient(pair, row_);
      J->row(at) = -kClearanceWeight * row_.transpose();
    }
  }

  const RobotModel& model_;
  const int link_;
  const Eigen::Isometry3d X_WG_;
  const Eigen::VectorXd start_;
  const bool turns_freely_;
  const double aim_;
  Clearance* const surroundings_;
  double posture_weight_{0.0};
  // TinySolver calls a const operator; this is its workspace.
  mutable std::vector<Eigen::Isometry3d> X_WL_;
  mutable Matrix6X J_;
  mutable Eigen::VectorXd q_, row_;
  mutable std::vector<NearPair> pairs_;
};

/// One call of SolveInverseKinematics.
class Search {
 public:
  Search(const RobotModel& model, int link, const Eigen::Isometry3d& X_WG,
         const Eigen::VectorXd& start, const InverseKinematicsSettings& settings,
         Clearance* surroundings)
      : model_(model),
        settings_(settings),
        surroundings_(settings.clearance > 0.0 ? surroundings : nullptr),
        start_(Clamped(start)),
        residuals_(model, link, X_WG, start_, settings, surroundings_),
        random_(settings.seed),
        carries_(start.size(), false),
        ranges_(start.size(), false),
        turns_(start.size(), false) {
    for (int at = link; at > 0; at = model.steps()[at - 1].parent_link) {
      if (const int column = model.steps()[at - 1].column; column >= 0) carries_[column] = true;
    }
    for (const Joint& joint : model.joints()) {
      const int j = joint.position_index;
      if (j < 0) continue;
      ranges_[j] = HasOwnRange(model, j);
      if (joint.type == JointType::kPrismatic) continue;
      turns_[j] = model.upper_limits()[j] - model.lower_limits()[j] >= 2.0 * kPi;
    }
    for (int j = 0; j < model.num_joints(); ++j) {  // the follower need not make whole turns too
      if (model.joints()[j].mimic) turns_[model.steps()[j].column] = false;
    }
  }

  PostureSolution Run() {
    PostureSolution best;
    int found = 0;
    int tried = 0;
    while (tried < settings_.starts && found < settings_.solutions) {
      PostureSolution next = Judged(Solve(tried++ == 0 ? start_ : RandomPosture(), 0.0));
      if (next.reached) {
        ++found;
        next = Drawn(next);
      }
      if (tried == 1 || Better(next, best)) best = std::move(next);
    }
    best.starts = tried;
    return best;
  }

 private:
  Eigen::VectorXd Clamped(const Eigen::VectorXd& x) const {
    return x.cwiseMax(model_.lower_limits()).cwiseMin(model_.upper_limits());
  }

  Eigen::VectorXd Solve(Eigen::VectorXd x, double posture_weight) {
    residuals_.set_posture_weight(posture_weight);
    const bool draws = posture_weight > 0.0;
    auto& options = solver_.options;
    options.max_num_iterations = draws ? kDrawIterations : kSearchIterations;
    options.gradient_tolerance = 1e-14;
    options.function_tolerance = 1e-30;
    options.parameter_tolerance = draws ? 1e-4 : 1e-12;
    options.cost_threshold = 1e-20;
    solver_.Solve(residuals_, &x);
    return WithoutTurns(Clamped(x));
  }

  /// The solution drawn to the start and away from things, if that succeeds.
  PostureSolution Drawn(const PostureSolution& from) {
    Eigen::VectorXd q = from.q;
    for (const double weight : kPostureWeights) q = Solve(q, weight);
    PostureSolution drawn = Judged(Solve(q, 0.0));
    return Better(drawn, from) ? drawn : from;
  }

  PostureSolution Judged(Eigen::VectorXd q) {
    PostureSolution result;
    const Vector6 error = residuals_.ErrorAt(q);
    result.position_error = error.head<3>().norm();
    result.rotation_error = error.tail<3>().norm();
    result.reached = result.position_error <= settings_.position_tolerance &&
                     result.rotation_error <= settings_.rotation_tolerance;
    result.change = (q - start_).norm();
    result.clearance = settings_.clearance;
    if (surroundings_ != nullptr) {
      surroundings_->MoveTo(q);
      result.clearance =
          std::min(surroundings_->Nearest(settings_.clearance).distance, settings_.clearance);
    }
    result.q = std::move(q);
    return result;
  }

  static bool Better(const PostureSolution& a, const PostureSolution& b) {
    if (a.reached != b.reached) return a.reached;
    if (!a.reached) {
      return std::hypot(a.position_error, a.rotation_error) <
             std::hypot(b.position_error, b.rotation_error);
    }
    if (std::fabs(a.clearance - b.clearance) > kSameClearance) return a.clearance > b.clearance;
    return a.change < b.change;
  }

  /// The same posture with joints turned by whole turns towards the start, as the limits allow.
  Eigen::VectorXd WithoutTurns(Eigen::VectorXd q) const {
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      if (!turns_[j]) continue;
      q[j] += 2.0 * kPi * std::round((start_[j] - q[j]) / (2.0 * kPi));
      if (q[j] > model_.upper_limits()[j]) q[j] -= 2.0 * kPi;
      if (q[j] < model_.lower_limits()[j]) q[j] += 2.0 * kPi;
    }
    return q;
  }

  Eigen::VectorXd RandomPosture() {
    Eigen::VectorXd q = start_;
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      if (!carries_[j]) continue;
      const double lower = model_.lower_limits()[j];
      const double upper = model_.upper_limits()[j];
      const bool bounded = ranges_[j] && !turns_[j];
      q[j] = bounded ? random_.Uniform(lower, upper) : random_.Uniform(q[j] - kPi, q[j] + kPi);
    }
    return Clamped(WithoutTurns(q));
  }

  const RobotModel& model_;
  const InverseKinematicsSettings settings_;
  Clearance* const surroundings_;
  const Eigen::VectorXd start_;
  Residuals residuals_;
  models::Random random_;
  std::vector<bool> carries_;  // the link, one a position
  std::vector<bool> ranges_;   // has limits to draw between
  std::vector<bool> turns_;    // has whole turns to spare
  ceres::TinySolver<Residuals> solver_;
};

[[noreturn]] void Refuse(const char* what, double got, const char* expected) {
  throw models::ModelError(
      fmt::format("inverse kinematics: {}; got {}; expected {}", what, got, expected));
}

void CheckSettings(const InverseKinematicsSettings& settings) {
  const auto positive = [](const char* what, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) Refuse(what, value, "a number > 0");
  };
  positive("position_tolerance", settings.position_tolerance);
  positive("rotation_tolerance", settings.rotation_tolerance);
  positive("starts", settings.starts);
  positive("solutions", settings.solutions);
  if (!(settings.clearance >= 0.0) || !std::isfinite(settings.clearance)) {
    Refuse("clearance", settings.clearance, "a number >= 0");
  }
}

}  // namespace

int TipLink(const RobotModel& model) {
  std::vector<bool> carries(model.links().size(), false);
  for (const Joint& joint : model.joints()) {
    if (!model.links()[joint.child_link].attached) carries[joint.parent_link] = true;
  }
  std::vector<std::string> names;
  int tip = 0;
  for (int link = 0; link < model.num_links(); ++link) {
    if (carries[link] || model.links()[link].attached) continue;
    tip = link;
    names.push_back(model.links()[link].name.text());
  }
  if (names.size() == 1) return tip;
  throw models::ModelError(
      fmt::format("robot '{}': its tip; got {}; expected one of them to be named",
                  model.name().text(), fmt::join(names, ", ")));
}

PostureSolution SolveInverseKinematics(const RobotModel& model, int link,
                                       const Eigen::Isometry3d& X_WG,
                                       const Eigen::Ref<const Eigen::VectorXd>& start,
                                       const InverseKinematicsSettings& settings,
                                       Clearance* surroundings) {
  assert(link >= 0 && link < model.num_links());
  assert(surroundings == nullptr || &surroundings->model() == &model);
  CheckPositions(model, start);
  CheckSettings(settings);
  if (!X_WG.matrix().allFinite()) {
    throw models::ModelError(
        "inverse kinematics: pose; got a NaN or an infinity; expected finite numbers");
  }
  return Search(model, link, X_WG, start, settings, surroundings).Run();
}

}  // namespace oca::robot
