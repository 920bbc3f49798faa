// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "oca/models/name.h"
#include "oca/models/robot/motion_metrics.h"
#include "oca/models/robot/proximity.h"
#include "oca/models/robot/travel_bound.h"

namespace oca::robot {

/// What was measured at one instant; what does not exist is empty.
struct MotionSample {
  using Positions = Eigen::Map<const Eigen::VectorXd>;
  double time{0.0};  ///< s
  std::optional<Positions> position{};
  std::optional<Positions> request{};
  std::optional<Positions> goal{};
  std::optional<Positions> delta{};
  const ProximitySet* proximities{nullptr};
  /// The robot that `position` is of, and how far it travels; both or none.
  const RobotModel* model{nullptr};
  const TravelBound* travel{nullptr};
};

/// The sums behind the metrics, sample by sample in the order of time. Nothing allocates after the
/// first samples.
class MotionTally {
 public:
  int samples() const { return samples_; }
  /// How many looks came after the last sample, and when the last look or sample was, s.
  int looks() const { return looks_; }
  double looked_at() const { return looked_at_; }

  void Add(const MotionSample& sample);
  /// Distances alone, between two samples.
  void Look(const MotionSample& sample);
  /// The metrics at `now`, which is not before the last sample; only the final error reads more of
  /// it than the time.
  MotionMetricsValue At(const MotionSample& now) const;
  /// Whether all its numbers are.
  bool finite() const;

 private:
  using Positions = MotionSample::Positions;
  void AddDistance(const MotionSample& sample);

  /// What a proximity leaves for the next sample.
  struct Pair {
    models::Name link;
    models::Name obstacle;
    models::Name own_link;
    double distance;
    double obstacle_speed;
    bool found;  ///< listed in the next sample too
  };
  /// Takes over the capacity too, so that a list that grows later does not allocate.
  struct PairList : std::vector<Pair> {
    PairList() = default;
    // NOLINTNEXTLINE(bugprone-copy-constructor-init): assigning takes the capacity over
    PairList(const PairList& other) : vector() { *this = other; }
    PairList& operator=(const PairList& other);
  };
  void Certify(const MotionSample& sample, double step);
  void CalcTravel(const MotionSample& sample);
  double LeastInStep(const MotionSample& sample, double step);
  Pair* FindPair(const Proximity& proximity, std::size_t& place);
  double TravelOf(const RobotModel& model, models::Name link) const;
  /// Of a link relative to an own link, if there is one, else in the world.
  double TravelOf(const MotionSample& sample, models::Name link, models::Name own_link) const;
  void AddPosition(Positions position, const RobotModel* model, double step);
  void CountViolations(Positions position, const RobotModel& model, double step);
  void AddDelta(Positions delta);
  void AddStandstill(const MotionSample& sample);
  void AddProgress(const MotionSample& sample);
  void NoteWhatBlocks(const MotionSample& sample);
  bool NoteLimit(const MotionSample& sample);

  int samples_{0};
  int looks_{0};           // since the last sample
  double looked_at_{0.0};  // s; the last one, or sample
  double first_time_{0.0};
  double last_time_{0.0};
  std::optional<double> min_distance_;
  models::Name min_distance_link_;
  models::Name min_distance_obstacle_;
  double min_distance_time_{0.0};
  bool looked_{false};   // a sample had a pair that was looked at
  bool certain_{false};  // all of every sample so far was known
  double certified_{0.0};
  double reach_{0.0};                    // max_distance of the last sample
  double fastest_{0.0};                  // of the last sample
  PairList pairs_;                       // of the last sample
  std::vector<double> looked_position_;  // of the last look or sample
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<double> path_;
  std::vector<double> travel_;
  bool in_contact_{false};
  double contact_time_{0.0};
  std::optional<double> first_contact_time_;
  double max_abs_delta_{0.0};
  double reversals_{0.0};
  double position_path_{0.0};
  double request_path_{0.0};
  double path_length_{0.0};
  double max_speed_{0.0};
  double max_acceleration_{0.0};
  double limit_violations_{0.0};
  std::vector<double> still_;  // where the arm has stood since still_since_
  double still_since_{0.0};
  double stuck_time_{0.0};
  models::Name stuck_link_;
  models::Name stuck_obstacle_;
  double stuck_amount_{0.0};
  double nearest_away_{0.0};             // least distance from the goal since the request is there
  double gained_at_{0.0};                // s; when it last fell by more than kStill
  std::optional<double> goal_time_;      // when it came to the goal, if it is there
  std::vector<double> position_;         // of the last sample
  std::vector<double> velocity_;         // between the last two samples
  std::vector<double> request_;          // of the last sample
  std::vector<double> delta_;            // of the last sample
  std::vector<double> delta_direction_;  // sign of the last change of each delta; 0 none yet
};

}  // namespace oca::robot
