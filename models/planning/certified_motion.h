// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "oca/models/planning/batch_clearance.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/travel_bound.h"

namespace oca::planning {

/// Proves that a robot stays clear of bodies at rest on a straight motion of its joints.
///
/// From a position at which every pair is `d` apart the joints may go on until a bound of the
/// links' travel has used up `d - clearance`; there the distances are taken anew. So what is found
/// clear is clear everywhere, not at samples only.
/// Of a motion that is not short, samples are looked at first, eight at once, and what lies behind
/// one that is not clear needs no proof.
/// source conservative advancement: Mirtich 1996; the bound: TravelBound
class CertifiedMotion {
 public:
  /// Every pair has to stay more than `margin` (m) apart, as the clearance counts it. The clearance
  /// must outlive this.
  CertifiedMotion(robot::Clearance& clearance, double margin);

  /// Whether the position itself is clear.
  bool Clear(const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Whether the motion from q_0 to q_1 is.
  bool Clear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
             const Eigen::Ref<const Eigen::VectorXd>& q_1);
  /// The share of the motion from q_0 to q_1, from its start, that is proved clear; 0 to 1.
  double ClearShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                    const Eigen::Ref<const Eigen::VectorXd>& q_1);

  /// At how many configurations distances were looked at so far.
  long evaluations() const { return evaluations_; }

 private:
  /// The share of the motion before the first sample that is not clear.
  double SampledShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                      const Eigen::Ref<const Eigen::VectorXd>& q_1);
  double ProvedShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                     const Eigen::Ref<const Eigen::VectorXd>& q_1);
  /// How far the joints may go on along `path` (one entry a position), as a share of it.
  double FreeShare();

  robot::Clearance& clearance_;
  const double margin_;
  long evaluations_{0};
  const robot::TravelBound bound_;
  Eigen::VectorXd q_, path_;
  std::optional<BatchClearance> batch_;
  long batch_version_{0};
  Eigen::MatrixXd samples_;  // n x lanes
  std::vector<double> distances_, own_distances_, travel_, approach_;
};

}  // namespace oca::planning
