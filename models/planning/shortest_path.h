// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "oca/models/planning/rrt_connect.h"

namespace oca::planning {

/// Length of a path of straight joint motions: the sum of the 2-norms, rad or m.
double PathLength(const std::vector<Eigen::VectorXd>& path);

struct ShortestPathOptions {
  RrtOptions rrt{.margin = 0.001};
  double seconds{1.0};        ///< of the wall clock, that the search goes on for; >= 0
  int most_tries{1'000'000};  ///< of paths, each shortened until that does not pay; >= 1
};

/// The shortest of the paths that RrtConnect finds with one seed after the other: a yardstick for
/// paths of others, not a bound. At least one try is made, which may take longer. With a time that
/// suffices for most_tries the answer is a function of the arguments. Allocates.
std::optional<std::vector<Eigen::VectorXd>> ShortestPath(robot::Clearance& clearance,
                                                         const Eigen::VectorXd& start,
                                                         const Eigen::VectorXd& goal,
                                                         const ShortestPathOptions& options = {});

}  // namespace oca::planning
