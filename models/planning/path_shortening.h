// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "oca/models/random.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

/// Replaces pieces between random points of a path by straight motions where those are proved clear
/// (CertifiedMotion), and goes on where it ended. A value; the same calls give the same path.
/// Allocates.
class PathShortening {
 public:
  using Path = std::vector<Eigen::VectorXd>;

  PathShortening() = default;
  /// Everything stays farther apart than `margin` (m, >= 0), as on the path; so many `tries`.
  PathShortening(Path path, double margin, std::uint64_t seed, int tries);

  bool done() const { return left_ == 0 || path_.size() <= 2; }
  /// Looks at motions about `most` times (CertifiedMotion::evaluations); adds how often it did.
  void Continue(robot::Clearance& clearance, long most, long& evaluations);
  /// From now on the path begins at `start`; false if no clear motion leads from there to its
  /// begin.
  bool MoveStart(robot::Clearance& clearance, const Eigen::VectorXd& start, long& evaluations);

  const Path& path() const { return path_; }

 private:
  Path path_;
  double margin_{0.0};
  models::Random random_{0};
  int left_{0};
};

}  // namespace oca::planning
