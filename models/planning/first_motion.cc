// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/first_motion.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "oca/models/error.h"
#include "oca/models/random.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/kinematics.h"

namespace oca::planning {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kPostures = 400;
constexpr int kPathSteps = 16;
constexpr Index kTurningJoints = 3;  // of the arm, from its base, that may make the motion
constexpr double kMiddle = 0.7;      // share of a range that postures are drawn from
// Of the reach, how large a motion is, where nothing larger is found.
constexpr double kSizes[] = {1.0, 0.5, 0.25};
// Shares of the size.
constexpr double kRadius = 1.0 / 12.0;
constexpr double kApart = 0.005, kFarApart = 0.05;  // own links, at least, and as far as it counts
constexpr double kHandShare = 0.3;  // of the way from the tip back to the last joint

/// What a motion has to keep.
struct Rules {
  bool above;                // no link is below the base
  double nearest, farthest;  // the tip, from the first joint; shares of the reach
  double way;                // of the tip, end to end; share of the size
  double room;               // from the ball, at the ends; share of the size
};
/// First what a person would ask for, then what arms can that hang, or are short on a long rail.
constexpr Rules kRules[] = {{true, 0.35, 0.85, 0.45, 1.0 / 8.0},
                            {false, 0.35, 0.85, 0.45, 1.0 / 8.0},
                            {true, 0.02, 1.0, 0.25, 1.0 / 16.0},
                            {false, 0.02, 1.0, 0.25, 1.0 / 16.0}};

/// One call of ProposeMotions.
class MotionSearch {
 public:
  MotionSearch(const std::shared_ptr<const robot::RobotModel>& model, int tip, std::uint64_t seed,
               const VectorXd& ways)
      : model_(*model),
        tip_(tip),
        ways_(ways),
        reach_(ReachOf(*model, tip)),
        clearance_(model, true),
        random_(seed) {
    for (Index i = 0; i < model_.num_positions(); ++i) {
      if (const auto range = robot::DrawnRange(model_, i)) {
        ranges_.push_back(*range);
        continue;
      }
      throw models::ModelError("joint '" +
                               model_.position_names()[static_cast<std::size_t>(i)].text() +
                               "': has no range to draw postures from; got none; expected limits");
    }
  }

  std::vector<FirstMotion> Run(std::size_t count,
                               const std::function<bool(double share)>& progress) {
    for (const double share : kSizes) {
      size_ = share * reach_;
      ball_ = geometry::MakeCollider(geometry::Sphere{kRadius * size_}, "ball");
      for (const Rules& rules : kRules) {
        rules_ = rules;
        if (found_.empty() && !TryPostures(progress)) return {};
      }
    }
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Scored& a, const Scored& b) { return a.score > b.score; });
    std::vector<FirstMotion> motions;
    for (Scored& one : found_) {
      if (motions.size() < count) motions.push_back(std::move(one.motion));
    }
    return motions;
  }

 private:
  struct Scored {
    FirstMotion motion;
    double score;
  };

  /// false: it is told to end.
  bool TryPostures(const std::function<bool(double share)>& progress) {
    for (int i = 0; i < kPostures; ++i) {
      if (progress && !progress(1.0 * i / kPostures)) return false;
      TryPosture(Posture());
    }
    return true;
  }

  VectorXd Posture() {
    VectorXd q(model_.num_positions());
    for (Index i = 0; i < q.size(); ++i) {
      const auto [lower, upper] = ranges_[static_cast<std::size_t>(i)];
      const bool turns = upper - lower > 2.0 * std::numbers::pi;
      const double half = 0.5 * kMiddle * (turns ? 2.0 * std::numbers::pi : upper - lower);
      const double middle = 0.5 * (lower + upper);
      q[i] = random_.Uniform(middle - half, middle + half);
    }
    return q;
  }

  Vector3d Tip() const { return clearance_.X_WL()[tip_].translation(); }
  /// Where the tip's own joint is, or the foot of the first joint.
  Vector3d OriginOf(int body) const { return clearance_.X_WL()[body].translation(); }

  void TryPosture(const VectorXd& q) {
    clearance_.MoveTo(q);
    const double stretch = (Tip() - OriginOf(model_.bodies().front())).norm() / reach_;
    if (stretch < rules_.nearest || stretch > rules_.farthest) return;
    for (Index j = 0; j < std::min(kTurningJoints, q.size()); ++j) {
      const auto [lower, upper] = ranges_[static_cast<std::size_t>(j)];
      const double range = upper - lower;
      const bool turns =
          model_.joints()[model_.FindJoint(Name(j))].type != robot::JointType::kPrismatic;
      double widest = turns ? std::min(0.9 * range, 5.0 * std::numbers::pi / 9.0) : 0.8 * range;
      if (ways_.size() > 0) widest = std::min(widest, ways_[j]);
      FirstMotion motion{q, q};
      const double middle = std::clamp(q[j], lower + 0.025 * range + 0.5 * widest,
                                       upper - 0.025 * range - 0.5 * widest);
      motion.from[j] = middle - 0.5 * widest;
      motion.to[j] = middle + 0.5 * widest;
      if (random_.Unit() < 0.5) motion.from.swap(motion.to);
      TryMotion(motion);
    }
  }

  const std::string& Name(Index position) const {
    return model_.position_names()[static_cast<std::size_t>(position)].text();
  }

  double OwnDistance() const { return clearance_.Nearest(kFarApart * size_).distance; }

  void TryMotion(FirstMotion& motion) {
    clearance_.SetBodies({});
    clearance_.MoveTo(motion.from);
    const Vector3d start = Tip();
    clearance_.MoveTo(motion.to);
    if ((Tip() - start).norm() < rules_.way * size_) return;
    double lowest = robot::kUnlimited;
    double apart = kFarApart * size_;
    for (int step = 0; step <= kPathSteps; ++step) {
      const double s = static_cast<double>(step) / kPathSteps;
      clearance_.MoveTo(motion.from + s * (motion.to - motion.from));
      apart = std::min(apart, OwnDistance());
      if (apart < kApart * size_) return;
      lowest = std::min(lowest, Lowest());
    }
    if (rules_.above && lowest < 0.0) return;
    PlaceBall(motion, lowest, apart);
  }

  /// Of the links beyond the first two that move, m above the base's foot.
  double Lowest() const {
    double lowest = robot::kUnlimited;
    const Eigen::Isometry3d X_BW = model_.X_WB().inverse();
    for (std::size_t i = 2; i < model_.bodies().size(); ++i) {
      lowest = std::min(lowest, (X_BW * OriginOf(model_.bodies()[i])).z());
    }
    return std::min(lowest, (X_BW * Tip()).z());
  }

  void PlaceBall(FirstMotion& motion, double lowest, double apart) {
    clearance_.MoveTo(0.5 * (motion.from + motion.to));
    const int hand = model_.body(tip_);
    motion.ball = Tip() + kHandShare * (OriginOf(hand) - Tip());
    motion.size = size_;
    motion.radius = kRadius * size_;
    Eigen::Matrix3Xd J(3, model_.num_positions());
    robot::PointJacobian(model_, clearance_.X_WL(), tip_, Tip(), J);
    const double least_move = J.jacobiSvd().singularValues().minCoeff();
    Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
    X_WO.translation() = motion.ball;
    clearance_.SetBodies({{ball_, X_WO}});
    motion.depth = -clearance_.Nearest(size_).distance;
    if (motion.depth < 0.3 * motion.radius) return;
    motion.room = robot::kUnlimited;
    for (const VectorXd& end : {motion.from, motion.to}) {
      clearance_.MoveTo(end);
      for (const double distance : Distances()) motion.room = std::min(motion.room, distance);
    }
    if (motion.room < rules_.room * size_) return;
    const double score = std::min(least_move / size_, 0.3) + std::clamp(lowest / size_, 0.0, 0.2) +
                         std::min(motion.room / size_, 0.3) + 3.0 * apart / size_;
    found_.push_back({motion, score});
  }

  /// Of each link to the ball.
  std::vector<double> Distances() const {
    std::vector<double> least(model_.links().size());
    clearance_.LinkDistances(size_, least);
    return least;
  }

  const robot::RobotModel& model_;
  const int tip_;
  const VectorXd& ways_;
  const double reach_;
  double size_{0.0};
  std::shared_ptr<const geometry::Collider> ball_;
  robot::Clearance clearance_;
  Rules rules_{kRules[0]};
  models::Random random_;
  std::vector<std::pair<double, double>> ranges_;
  std::vector<Scored> found_;
};

/// The slides of a chain, from its end on.
class SlideGroups {
 public:
  /// The joint before those that were added.
  void Add(const robot::Joint& joint) {
    if (joint.type == robot::JointType::kPrismatic) {
      const double range = joint.upper_limit - joint.lower_limit;
      if (!std::isfinite(range)) {
        throw models::ModelError("joint '" + joint.name.text() +
                                 "': slides without end; got no limits; expected a range");
      }
      if (groups_.empty() || turned_) groups_.emplace_back();
      turned_ = false;
      groups_.back().push_back({joint.axis, range});
    } else if (joint.movable()) {
      turned_ = true;
    }
    if (groups_.empty()) return;
    for (Slide& slide : groups_.back()) slide.axis = joint.X_PJ.linear() * slide.axis;
  }

  /// m; how far they go together, each at most `most` (0: its range). Those with a joint that turns
  /// between them can come to lie along one line; of others that the squares of ways add up where
  /// they are across each other, and their lengths where they are along one line.
  double Reach(double most) const {
    double reach = 0.0;
    for (const std::vector<Slide>& group : groups_) {
      double square = 0.0;
      for (const Slide& a : group) {
        for (const Slide& b : group) {
          square += std::fabs(a.axis.dot(b.axis)) * Capped(a.range, most) * Capped(b.range, most);
        }
      }
      reach += std::sqrt(square);
    }
    return reach;
  }

 private:
  struct Slide {
    Vector3d axis;  // in the frame of the joint at hand's parent
    double range;   // m
  };
  static double Capped(double range, double most) {
    return most > 0.0 ? std::min(range, most) : range;
  }

  std::vector<std::vector<Slide>> groups_;
  bool turned_{false};  // since the last slide
};

}  // namespace

double ReachOf(const robot::RobotModel& model, int link) {
  double lengths = 0.0;
  SlideGroups slides;
  double offset = 0.0;  // fixed frames between the last joint that moves and the one at hand
  for (int at = link; at > 0;) {
    const robot::Joint& joint = model.joints()[at - 1];
    if (joint.movable()) {
      lengths += offset;
      offset = 0.0;
    }
    slides.Add(joint);
    offset += joint.X_PJ.translation().norm();
    at = joint.parent_link;
  }
  const double reach = lengths + slides.Reach(lengths);
  if (!(reach > 0.0)) {
    throw models::ModelError("link '" + model.links()[static_cast<std::size_t>(link)].name.text() +
                             "': its reach; got 0 m, for it lies where the joint is that moves it; "
                             "expected a frame at the end of the arm");
  }
  return reach;
}

std::vector<FirstMotion> ProposeMotions(const std::shared_ptr<const robot::RobotModel>& model,
                                        int tip, std::size_t count, std::uint64_t seed,
                                        const std::function<bool(double share)>& progress,
                                        const VectorXd& ways) {
  return MotionSearch(model, tip, seed, ways).Run(count, progress);
}

}  // namespace oca::planning
