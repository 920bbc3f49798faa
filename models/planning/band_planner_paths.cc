// SPDX-License-Identifier: BSD-3-Clause
// Bands of BandPlanner that follow paths past what stands.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/path_timing.h"
#include "oca/models/planning/rrt_connect.h"
#include "oca/models/planning/smooth_step.h"
#include "oca/models/random.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr int kShortcuts = 150;         // of what a PathSearch found
constexpr std::uint64_t kPathTurn = 3;  // one of so many plans looks for paths, if anything moves
constexpr double kPathRoom = 1.3;       // times what a band keeps, so that it may bend
constexpr double kNarrowRoom = 0.015;   // m; where there is no way with that
constexpr double kEndRoom = 1.02;       // times what must be kept: as much is left at an end
constexpr std::array kPathIntervals{0.25, 0.15, 0.1};  // s; of bands along a path, one try each,
constexpr double kSlower = 1.4;                        // of which each takes so much longer
constexpr double kEndShare = 0.9;  // of what the ends of a path leave, if that is less

}  // namespace

BandCurve BandPlanner::Along(const BandTask& task, const std::vector<VectorXd>& path) const {
  const std::vector<double> lengths = TimesAlong(model(), path);
  const double begin = task.start + std::min(0.2, 0.1 * (zero_.end() - task.start));
  const double end = zero_.end() - std::min(0.5, 0.2 * (zero_.end() - task.start));
  VectorXd request(zero_.size());
  return Shaped(task, [&](double time) -> VectorXd {
    const double at = lengths.back() * SmoothStep((time - begin) / (end - begin));
    const auto above = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, at);
    const auto k = static_cast<std::size_t>(above - lengths.begin());
    const double span = lengths[k] - lengths[k - 1];
    const double share = span > 0.0 ? (at - lengths[k - 1]) / span : 0.0;
    task.request(time, 0, request);
    return path[k - 1] + share * (path[k] - path[k - 1]) - request;
  });
}

void BandPlanner::TryPaths(const BandTask& task, BandEnd end, BandPlan& best) {
  if (!anything_stands_) return;
  VectorXd here(zero_.size()), goal(zero_.size());
  task.request(task.start, 0, here);
  here += task.deviation[0];
  task.request(zero_.end(), 0, goal);
  for (int i = 0; i < settings_.most_paths; ++i) {
    RrtOptions options;
    options.seed = models::Random::Seed(task.seed, static_cast<std::uint64_t>(i));
    options.most_nodes = settings_.path_nodes;
    std::optional<std::vector<VectorXd>> path;
    for (const double margin : {kPathRoom * settings_.band.clear_distance, kNarrowRoom}) {
      options.margin = margin;
      path = RrtConnect(*standing_, here, goal, options);
      if (path) break;
    }
    if (!path) continue;
    Keep(task, Finish({BandStart::kPath, end, Along(task, *path)}, 2 * settings_.start_iterations),
         best);
  }
}

SearchLevels BandPlanner::LevelsFor(const VectorXd& here, const VectorXd& goal) {
  const auto room = [&](const VectorXd& q) {
    standing_->MoveTo(q);
    return standing_->Nearest(2.0 * settings_.band.clear_distance).distance;
  };
  const double goal_room = room(goal);
  const double left = std::min(room(here), goal_room > 0.0 ? goal_room : robot::kUnlimited);
  // So that the first step from either end need not be tiny, but not less than must be kept.
  const double hard = settings_.band.hard_distance;
  const double most = std::max(0.5 * left, left > kEndRoom * hard ? hard : kEndShare * left);
  SearchLevels levels;
  levels.shortcuts = kShortcuts;
  const auto add = [&](double margin) {
    margin = std::min(margin, most);
    if (levels.margins.empty() || margin < levels.margins.back()) levels.margins.push_back(margin);
  };
  add(kPathRoom * settings_.band.clear_distance);
  for (const double share : kClearShares) add(share * settings_.band.clear_distance);
  add(kPathRoom * settings_.band.hard_distance);
  return levels;
}

bool BandPlanner::MayFindMore(const BandTask& task, const BandPlan& best) const {
  if (!moving_) return !best.check.clear() || !best.reaches || best.level > 0;
  if (task.plans_before % kPathTurn != kPathTurn - 1) return false;
  const bool goal_taken = !best.reaches && best.goal_room <= 0.0;
  return best.check.clear() ? goal_taken : best.check.touch_hard < BandCheck::kNever;
}

void BandPlanner::GoOnSearching(const BandTask& task, BandPlan& best) {
  PathSearch& search = *task.path_search;
  if (!anything_stands_ || !MayFindMore(task, best)) return;
  VectorXd here(zero_.size());
  task.request(task.start, 0, here);
  here += task.deviation[0];
  const VectorXd goal = GoalAt(task, std::max(zero_.end(), task.request_end));
  standing_->MoveTo(here);
  const double room = standing_->Nearest(settings_.band.clear_distance).distance;
  // First out of contact, and to where paths keep what they must, if that is where the band goes.
  if (!(room > (best.check.clear() ? settings_.band.hard_distance : 0.0))) return;
  SearchLevels levels = LevelsFor(here, goal);
  // What a start that was left made it keep less than must be kept is no way to go.
  const double must = std::min(settings_.band.hard_distance, levels.margins.back());
  if (!search.IsFor(goal) || room < search.margin() || search.margin() < kEndShare * must) {
    standing_->MoveTo(goal);
    const bool goal_clear = standing_->Nearest(0.0).distance > 0.0;
    search.Begin(here, goal, goal_clear, std::move(levels), task.seed);
  }
  if (best.check.clear() && best.reaches && search.margin() <= best.check.kept) {
    search.Reset();
    return;
  }
  long looks = 0;
  standing_->KeepOwn(own_, search.margin());
  search.MoveStart(*standing_, here, looks);
  search.Continue(*standing_, LooksLeft(settings_.prices.batch, settings_.path_evaluations), looks);
  path_looks_ += looks;
  if (search.state() == PathSearch::State::kFound) {
    standing_->KeepOwn(own_, settings_.band.clear_distance);
    TryPath(task, search, best);
  } else if (search.state() == PathSearch::State::kExhausted) {
    standing_->MoveTo(search.nearest());
    const robot::NearPair pair = standing_->Nearest();
    if (pair.link >= 0) {
      best.rest_link = model().links()[static_cast<std::size_t>(pair.link)].name;
      best.rest_body = StandingName(task, pair);
      best.rest_room = pair.distance / pair.scale;
    }
  }
  standing_->KeepOwn(own_, settings_.band.clear_distance);
}

models::Name BandPlanner::StandingName(const BandTask& task, const robot::NearPair& pair) const {
  if (pair.body < 0) return model().links()[static_cast<std::size_t>(pair.other_link)].name;
  int place = 0;
  for (const BandBody& body : task.bodies) {
    if (body.stands && place++ == pair.body) return body.name;
  }
  return {};
}

void BandPlanner::TryPath(const BandTask& task, PathSearch& search, BandPlan& best) {
  const std::vector<VectorXd>& path = search.path();
  // A path of straight pieces needs time and points: the more, the nearer the band is to it.
  const double least = std::max(
      std::min(DurationAlong(model(), path, settings_.band.limit_share), settings_.most_horizon),
      task.request_end - task.start);
  while (search.tries() < std::ssize(kPathIntervals)) {
    const int tries = search.tries();
    search.CountTry();
    Prepare(task, {least * std::pow(kSlower, tries) + settings_.tail,
                   kPathIntervals[static_cast<std::size_t>(tries)]});
    const Start along{BandStart::kPath, end_, Along(task, path)};
    Keep(task, Unrelaxed(along), best);
    Keep(task, Finish(along, settings_.start_iterations), best);
    if (best.check.clear() || moving_) break;
    if (StepsLeft(kFewestSteps) < kFewestSteps) return;  // the next plan goes on
  }
  search.Reset();
}

}  // namespace oca::planning
