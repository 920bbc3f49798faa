// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "oca/models/planning/band_optimizer.h"

namespace oca::planning::test {

/// An LWR 4 that shall turn joint 1 by 157.5 degrees in 10 s, and boxes of 0.1 to 0.4 m on its way.
struct BandScene {
  std::shared_ptr<const robot::RobotModel> model;
  std::vector<BandBody> bodies;
  BandRequest request;
};
BandScene MakeBandScene(std::uint64_t seed);
/// No deviation, in intervals of 0.4 s.
BandCurve StraightBand();

struct CeresAnswer {
  double before{0.0};  ///< cost as BandOptimizer counts it
  double after{0.0};
  int steps{0};
};

/// Relaxes a band of such intervals, whose end is fixed, by Ceres' Levenberg-Marquardt method: the
/// cost of BandOptimizer, put together anew from its class comment as residuals with analytic rows,
/// at the middles of four equal parts of each interval. Ends after `most` steps or with one that
/// gains less than the share `least_gain` of the cost.
CeresAnswer RelaxByCeres(const BandScene& scene, const BandSettings& settings, int most,
                         double least_gain, BandCurve& curve);

}  // namespace oca::planning::test
