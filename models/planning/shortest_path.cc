// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/shortest_path.h"

#include <chrono>
#include <cstdint>
#include <utility>

#include "oca/models/random.h"

namespace oca::planning {
namespace {

using JointPath = std::vector<Eigen::VectorXd>;

constexpr int kRound = 100;             // shortcuts between two looks at the clock
constexpr double kWorthShorter = 1e-3;  // of the length; a round that gains less was the last but
constexpr int kIdleRounds = 3;          // so many

/// Until rounds of shortcuts gain nothing, or time is over.
template <class Over>
void ShortenFully(robot::Clearance& clearance, RrtOptions options, const Over& over,
                  JointPath& path) {
  const std::uint64_t seed = options.seed;
  options.shortcuts = kRound;
  int idle = 0;
  for (std::uint64_t round = 0; idle < kIdleRounds && path.size() > 2 && !over(); ++round) {
    const double before = PathLength(path);
    options.seed = models::Random::Seed(seed, round);
    Shorten(clearance, options, path);
    idle = PathLength(path) > (1.0 - kWorthShorter) * before ? idle + 1 : 0;
  }
}

}  // namespace

double PathLength(const JointPath& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

std::optional<JointPath> ShortestPath(robot::Clearance& clearance, const Eigen::VectorXd& start,
                                      const Eigen::VectorXd& goal,
                                      const ShortestPathOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(options.seconds));
  const auto over = [end] { return Clock::now() >= end; };
  std::optional<JointPath> best;
  for (int i = 0; i < options.most_tries && (i == 0 || !over()); ++i) {
    RrtOptions rrt = options.rrt;
    rrt.seed = models::Random::Seed(options.rrt.seed, static_cast<std::uint64_t>(i));
    rrt.shortcuts = 0;
    auto path = RrtConnect(clearance, start, goal, rrt);
    if (!path) continue;
    ShortenFully(clearance, rrt, over, *path);
    if (!best || PathLength(*path) < PathLength(*best)) best = std::move(path);
    if (best->size() == 2) break;  // straight: nothing is shorter
  }
  return best;
}

}  // namespace oca::planning
