// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "oca/models/planning/clairvoyant.h"

namespace oca::planning {

/// How a motion gets to the end of its request.
struct MotionWay {
  double length{0.0};            ///< of the joints: the 2-norms of its steps, summed; rad or m
  std::optional<double> time{};  ///< s; from which on it stays at the end of the request
};

/// The way of the request of `task`, to which `curve` is added unless it is empty, in steps of
/// 0.01 s from 0 to the duration. `size` is the number of positions; it is at the end where no
/// joint is farther from it than `arrived`, rad or m.
MotionWay WayOf(const ClairvoyantTask& task, const BandCurve& curve, Eigen::Index size,
                double arrived);

}  // namespace oca::planning
