// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "oca/models/robot/clearance.h"

namespace oca::planning {
namespace internal {
struct BatchAnswer;
struct BatchKernel;
struct BatchScene;
using LaneArray = std::array<float, 8>;
}  // namespace internal

/// Tells of many configurations which are clear, eight at once: first by balls that contain the
/// links against bodies, or what contains these, in single precision; then exactly, where that
/// cannot decide, the pairs in question alone.
///
/// Balls that the links contain prove contact the same way. What it calls clear is clear. What the
/// balls alone call clear is too: their thresholds are widened by what single precision may err,
/// 2e-6 (n + 2) of the arm's reach and 2e-6 of how far a body's middle is from the base. All
/// processors give the same bits.
///
/// Bodies, own pairs and what is ignored are those of the Clearance when this was made (compare its
/// version()); it must outlive this, and is left at some position. No heap once made.
/// source Thomason, Kingston, Kavraki, Motions in Microseconds via Vectorized Sampling-Based
///        Planning, 2024: configurations in lanes, balls, all of an edge at once
class BatchClearance {
 public:
  static constexpr int kLanes = 8;

  /// Of `moving` (numbers of bodies, ascending) is not looked at where the clearance has them: Near
  /// alone asks for them.
  explicit BatchClearance(robot::Clearance& clearance, std::span<const int> moving = {});
  ~BatchClearance();

  /// A ball around a body that moves; centre in the world, m.
  struct MovingBall {
    Eigen::Vector3d centre;
    double radius;
  };
  /// A pair that may be near, and a bit for each configuration at which it may.
  struct Candidate {
    robot::PairPlace pair;
    unsigned lanes;
  };
  /// All pairs that may be nearer than `margin` at the first `count` columns of q, in the order of
  /// Clearance::Collect: no other is. Of column c, body moving[m] is within balls[c * moving + m].
  std::span<const Candidate> Near(const Eigen::Ref<const Eigen::MatrixXd>& q, int count,
                                  double margin, std::span<const MovingBall> balls);

  /// A bit for each of the first `count` (at most kLanes) columns of q (num_positions() rows) at
  /// which nothing is nearer than `margin` (m, >= 0).
  unsigned Clear(const Eigen::Ref<const Eigen::MatrixXd>& q, int count, double margin);

  /// The same by the balls alone, to prove what they are good for: a bit is 0 also where they
  /// cannot decide.
  unsigned SurelyClear(const Eigen::Ref<const Eigen::MatrixXd>& q, int count, double margin);

  /// How many of the first columns are clear, up to the first of `count` that is not.
  int CountClear(const Eigen::Ref<const Eigen::MatrixXd>& q, int count, double margin);

  /// What is known of configurations, a bit each.
  struct Around {
    unsigned clear;    ///< nothing is nearer than the margin, wherever the joints go
    unsigned contact;  ///< something is nearer at the configuration itself; not all such are found
  };
  /// The same of all that can be reached from the columns of q by motions of which no joint goes
  /// farther, either way, than the column of `path` says (as q; >= 0, rad or m): with a
  /// robot::TravelBound of the ball around each link.
  Around ClearAround(const Eigen::Ref<const Eigen::MatrixXd>& q,
                     const Eigen::Ref<const Eigen::MatrixXd>& path, int count, double margin);

  /// Whether all of `count` positions evenly spread on the straight motion from q_0 to q_1 are
  /// clear, q_1 included and q_0 not; the ends of halves are looked at first.
  bool SamplesClear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                    const Eigen::Ref<const Eigen::VectorXd>& q_1, int count, double margin);

  /// How many configurations were looked at, and for how many the balls could not decide.
  std::int64_t looked_at() const { return looked_at_; }
  std::int64_t undecided() const { return undecided_; }
  int num_balls() const;
  const internal::BatchScene& scene() const;

 private:
  void AddFrames();
  void AddLinks();
  void AddBodies(std::span<const int> moving);
  /// `uncertain`: by how much nearer, m, the body counts at most.
  void AddSolid(int body, const geometry::Collider& solid, const Eigen::Isometry3d& X_OB,
                double uncertain);
  internal::BatchAnswer Ask(const Eigen::Ref<const Eigen::MatrixXd>& q, int count, double margin);
  internal::BatchAnswer AskAround(const Eigen::Ref<const Eigen::MatrixXd>& q,
                                  const Eigen::Ref<const Eigen::MatrixXd>& path, int count,
                                  double margin);
  void Load(const Eigen::Ref<const Eigen::MatrixXd>& q, int count);
  internal::BatchAnswer AskKernel(const internal::LaneArray* paths, int count, double margin);
  void LoadMovers(std::span<const MovingBall> balls, int count);
  enum class Exactly { kClear, kNear, kContact };
  /// Of the pairs that the last question left open; near: as far as the link may travel.
  Exactly LookExactly(const Eigen::Ref<const Eigen::VectorXd>& q, int lane, double margin,
                      bool travels);
  double TravelOf(int link, int frame, int lane) const;

  robot::Clearance& clearance_;
  struct Mover {
    robot::JointType type;
    int column;
    double multiplier, offset;
  };
  std::vector<Mover> movers_;            // one a frame
  std::vector<int> frame_of_;            // of each link of the model
  std::vector<Eigen::Isometry3d> X_FL_;  // of each link in its frame
  std::vector<int> numbers_;             // in the model, of the scene's links
  double reach_{0.0};                    // of any point of the robot from the base, m
  double error_{0.0};                    // m
  std::unique_ptr<internal::BatchKernel> kernel_;
  Eigen::MatrixXd samples_;  // n x kLanes
  std::vector<internal::LaneArray> movers_at_;
  std::vector<Candidate> candidates_;
  std::int64_t looked_at_{0}, undecided_{0};
};

}  // namespace oca::planning
