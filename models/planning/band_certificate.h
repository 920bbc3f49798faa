// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "oca/models/planning/band_curve.h"
#include "oca/models/planning/band_optimizer.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/travel_bound.h"

namespace oca::planning {

/// Proves that a band keeps its distance from bodies at rest and between own links at every time,
/// not at samples only.
///
/// Between two times at which a pair is d_0 and d_1 apart its distance is nowhere less than
///
///     (d_0 + d_1 - travel) / 2,   travel a TravelBound of the joints' paths between them;
///
/// a span for which that does not suffice is halved. The path of a joint is |q_1 - q_0|, and where
/// it may turn round A dt^2 / 4 more, A twice the largest acceleration at ends and middle.
/// A pair that start or goal leave less than the hard distance is asked for half of what they
/// leave; a link that starts in contact is not looked at.
class BandCertificate {
 public:
  /// The clearance holds the bodies; it must outlive this. `own_reference` is that of its KeepOwn:
  /// own links are asked for their range if that is less.
  BandCertificate(robot::Clearance& clearance, double hard_distance, double own_reference);

  /// The first time, from `from` on, up to which the motion request + curve is proved;
  /// BandCheck::kNever if that is all of it.
  double Until(const BandRequest& request, const BandCurve& curve, double from);

  long evaluations() const { return evaluations_; }

 private:
  struct Look {
    double time;
    Eigen::VectorXd q, v, a;
    double nearest{0.0};             ///< of all
    std::vector<double> links, own;  ///< empty: not asked for yet
  };
  Look At(double time);
  void Measure(Look& look);
  void SetNeeds(const Look& start, const Look& goal);
  bool Proved(Look& first, Look& second, int depth);
  bool Suffices(Look& first, Look& second);

  robot::Clearance& clearance_;
  const double hard_;
  const double own_reference_;
  const robot::TravelBound bound_;
  const BandRequest* request_{nullptr};
  const BandCurve* curve_{nullptr};
  double failed_{0.0};
  double most_need_{0.0};
  std::vector<double> link_needs_, own_needs_, travel_;
  std::vector<Eigen::Isometry3d> X_WL_;
  Eigen::VectorXd path_;
  long evaluations_{0};
};

}  // namespace oca::planning
