// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "oca/models/planning/band_optimizer.h"
#include "oca/models/planning/path_search.h"
#include "oca/models/planning/plan_work.h"

namespace oca::planning {

/// What a band was made of: the request, the last band, the request with a pause, a joint that goes
/// out of the way, all of them at random, a path past what stands, or an escape.
enum class BandStart { kRequest, kLast, kPause, kDetour, kRandom, kPath, kEscape };
inline constexpr std::array kBandStartNames{"request", "last", "pause", "detour",
                                            "random",  "path", "escape"};
inline std::span<const char* const> EnumNames(BandStart) { return kBandStartNames; }

/// Where a band ends: where it is to, or wherever that is cheapest.
enum class BandEnd { kGoal, kFree };

struct BandPlannerSettings {
  BandSettings band{};
  int iterations{12};           ///< steps on the last band
  int start_iterations{30};     ///< steps on another start
  int relaxed_starts{6};        ///< the cheapest of all starts that are worth steps
  int random_starts{24};        ///< beside those of single joints
  int most_paths{2};            ///< of RrtConnect, where no PathSearch goes on
  int path_nodes{2000};         ///< each
  long path_evaluations{1000};  ///< looks of a PathSearch, besides most_evaluations
  long most_evaluations{0};     ///< of configurations, about, that a plan may cost; 0: no bound
  PlanPrices prices{};          ///< of its work, beside BandTask::most_time
  double least_horizon{2.0};    ///< s
  double moving_horizon{3.0};   ///< s; at most, while something moves
  double most_horizon{30.0};    ///< s
  double tail{0.5};             ///< s; after the end of the request
  double fine_span{1.6};        ///< s; from the start, with short intervals if anything moves
};

/// What leaves a band less than the margin, where it comes nearest to something.
enum class BandLack { kNone, kStart, kGoal, kPassage, kOwnLinks };
inline constexpr std::array kBandLackNames{"none", "start", "goal", "passage", "own links"};

/// What a band is planned for.
struct BandTask {
  double start{0.0};  ///< s
  /// s; that the plan may cost, about: what can be left out is when its work has cost so much
  double most_time{std::numeric_limits<double>::infinity()};
  Eigen::VectorXd deviation[3];  /// at the start: position, velocity, acceleration
  BandRequest request{};
  double request_end{0.0};  ///< s; from then on it rests
  Eigen::VectorXd end{};    ///< where the deviation is to end; empty: at zero
  std::span<const BandBody> bodies{};
  std::uint64_t seed{0};
  std::uint64_t plans_before{0};     ///< each looks at other starts
  bool explore{true};                ///< try other starts if the last band is not wide,
  bool fresh{false};                 ///< or if it is, but the request is not
  PathSearch* path_search{nullptr};  ///< past what stands; goes on in this plan. Null: none
};

struct BandPlan {
  BandCurve curve{};
  BandCheck check{};
  BandStart start{BandStart::kRequest};
  double cost{0.0};
  bool reaches{true};     ///< ends where it is to end
  bool certified{false};  ///< clear between the points of the grid too
  int level{0};           ///< 0: wide; from 1: the first of kClearShares that what stands is kept
  BandLack lack{BandLack::kNone};
  double goal_room{0.0};                  ///< m; that the end leaves, at most clear_distance
  models::Name goal_link{}, goal_body{};  ///< the pair
  models::Name rest_link{}, rest_body{};  ///< of an exhausted search: what is near where it ended,
  double rest_room{0.0};                  ///< and how near, m
  PlanWork work{};                        ///< that it took
};

/// Bands that are clear but not wide are of several degrees: what stands is kept as far away as one
/// of these shares of clear_distance all along, where start and goal leave it; else of the last.
inline constexpr std::array kClearShares{4.0 / 9.0, 2.0 / 9.0, 1.0 / 9.0};

/// Finds bands: keeps the last one where it can be made clear, else tries many starts.
///
/// 1. The request, if the arm rests on it and it keeps the margin, or is wide and nothing was
///    planned before; or to stay where it is, if it has arrived.
/// 2. The last band, relaxed; or the way straight back, if that is clear and much cheaper. While
///    something moves and the last band is not clear either: escapes, straight motions at once to
///    where the arm is out of reach, which are tested rather than relaxed: where everything closes
///    in, a gradient leads nowhere.
/// 3. If that is not clear, or the task is fresh: retreats along the gradient of the distance,
///    pauses before what moves, detours of each joint around the time in question, random ones, and
///    if these are not clear, paths of RrtConnect past what stands; the cheapest few are relaxed,
///    and of those that are clear the one wins whose joints go the shortest way, a missing margin
///    counted at 10 rad a metre. If none is clear: one that evades what moves (BandCheck::evades),
///    then what lacks least.
///
/// A plan looks at about most_evaluations configurations, if that is above 0: it then tries some of
/// the starts, and the next one (BandTask::plans_before) goes on with others. Clear means within
/// the limits too. The end of a band is free where none that ends where it is to end is clear:
/// while something moves, where the last one cannot be made clear.
///
/// Of bands that are clear one that ends where it is to end is better than one that does not (where
/// something moves, after one that is wide), then one of a wider degree (kClearShares), then one of
/// a shorter way. Where nothing moves the last band as it is counts as well; while that is wide,
/// and no plan is fresh, only what costs much less replaces it. What stands and own links are
/// proved to keep hard_distance between the points of the grid too (BandCertificate), else a band
/// is not clear. BandTask::path_search goes on in every plan that is not clear, or of which a wider
/// degree may be found.
///
/// The work is bounded and the answer a function of the arguments. Allocates.
class BandPlanner {
 public:
  /// For a robot as `arm` looks at it, which is copied; what contains its links is shared.
  BandPlanner(const robot::Clearance& arm, const BandPlannerSettings& settings,
              const robot::OwnRanges& own = {});
  BandPlanner(std::shared_ptr<const robot::RobotModel> model, const BandPlannerSettings& settings,
              bool self_collision = false, const robot::OwnRanges& own = {})
      : BandPlanner(robot::Clearance(std::move(model), self_collision), settings, own) {}

  /// Leaves two own links out from now on, by their numbers.
  void IgnoreOwn(int link, int other) {
    band_.IgnoreOwn(link, other);
    standing_->IgnoreOwn(link, other);
  }

  const robot::RobotModel& model() const { return band_.model(); }
  /// `last` may be null.
  BandPlan Plan(const BandTask& task, const BandCurve* last);

 private:
  struct Start {
    BandStart kind;
    BandEnd end;
    BandCurve curve;
    double cost{0.0};
  };
  /// What the grid of a band is to be like, besides what the task says.
  struct Grid {
    double least_horizon{0.0};  ///< s
    double interval{0.4};       ///< s; the longest
    bool returns{false};        ///< the arm is to be back soon: short intervals first
  };
  static constexpr double kMarginWay = 10.0;   ///< rad/m
  static constexpr int kFewestSteps = 5;       ///< on a start; less is no trial
  static constexpr double kMuchCheaper = 0.7;  ///< of the cost of a band that is clear
  static constexpr double kSameState = 1e-9;   ///< of a last band and a task's start or end
  static constexpr double kStopWithin = 0.15;  ///< s; an arm that stops goes on as fast, about
  double HorizonOf(const BandTask& task, bool moving) const;
  std::vector<double> TimesOf(const BandTask& task, const Grid& grid) const;
  static Grid GridOf(const BandTask& task, const BandCurve* last, bool moving);
  void Prepare(const BandTask& task, const Grid& grid);
  void PrepareStanding(const BandTask& task);
  /// What the end of the grid leaves, s, and whether bands may end where they are to.
  void LookAtGoal(const BandTask& task, double end);
  std::optional<BandPlan> KeepLast(const BandTask& task, const BandCurve* last);
  /// Whether a wide band costs so much less than to go on with the last one, on the grid at hand.
  bool MuchCheaper(const BandPlan& plan, const BandTask& task, const BandCurve* last);
  int LevelOf(const BandCheck& check) const;
  Eigen::VectorXd GoalAt(const BandTask& task, double time) const;
  void Certify(const BandTask& task, BandPlan& plan);
  /// zero_ with the deviation to `shape`, which says positions less the request, within the limits.
  BandCurve Shaped(const BandTask& task, const std::function<Eigen::VectorXd(double)>& shape) const;
  /// Brings a start to its end, and tells the band.
  void SetEnd(Start& start);
  BandPlan Unrelaxed(Start start);
  /// The last band on the grid at hand.
  BandCurve Followed(const BandTask& task, const BandCurve* last) const;
  /// Whether the last band left its end free, which now could be the goal.
  bool EndsElsewhere(const BandCurve* last) const;
  /// Where the last band, whose grid goes on beyond moving_horizon, meets something: a shorter
  /// grid.
  void LookLessFarInNeed(const BandTask& task, const BandCurve* last);
  /// The last band, relaxed; as it is, if only that is clear; escapes, if neither is.
  BandPlan GoOnWith(const BandTask& task, const BandCurve* last);
  /// Relaxed by so many steps, or what is left of them, but not less than kFewestSteps.
  BandPlan Finish(Start start, int iterations);
  void Judge(BandEnd end, BandPlan& plan);
  /// Whether the arm stands where it is to end, the request rests and nothing moves.
  bool HasArrived(const BandTask& task) const;
  BandPlan PlanAnew(const BandTask& task, const BandCurve* last);
  /// Whether the band is to go back to the request at once, where nothing is near that. Where
  /// something moves, who is back early has evaded it once more for nothing: only if the way
  /// straight back, and the request as far as is foreseen, keep the margin, and would if what moves
  /// turned round for a third of a second.
  bool MayReturn(const BandTask& task, const BandCheck& trouble);
  BandPlan Bend(const BandTask& task, const BandCheck& trouble, const BandCurve* last);
  void Explore(const BandTask& task, const BandCheck& trouble, const BandCurve& troubled,
               BandEnd end, BandPlan& best);
  void AddRetreats(const BandTask& task, const BandCheck& trouble, const BandCurve& from,
                   std::vector<Start>& starts);
  void AddPauses(const BandTask& task, const BandCheck& trouble, std::vector<Start>& starts) const;
  void AddDetours(const BandTask& task, const BandCheck& trouble, std::vector<Start>& starts) const;
  /// Straight motions from the start to positions, drawn at random, that evade all at the end of
  /// the grid and on the way.
  void TryEscapes(const BandTask& task, BandPlan& best);
  /// Where nothing moves: a band that goes on as near to the request as is clear, and ends there.
  void Wait(const BandTask& task, BandPlan& best);
  void TryPaths(const BandTask& task, BandEnd end, BandPlan& best);
  /// Whether a search for paths may find a better one.
  bool MayFindMore(const BandTask& task, const BandPlan& best) const;
  void GoOnSearching(const BandTask& task, BandPlan& best);
  SearchLevels LevelsFor(const Eigen::VectorXd& here, const Eigen::VectorXd& goal);
  models::Name StandingName(const BandTask& task, const robot::NearPair& pair) const;
  /// Makes a band of the path that was found, on a grid that is long and fine enough for it; unless
  /// it is tried again in the next plan the search is over.
  void TryPath(const BandTask& task, PathSearch& search, BandPlan& best);
  BandCurve Along(const BandTask& task, const std::vector<Eigen::VectorXd>& path) const;
  PlanWork Work() const;
  long LooksLeft(double price, long most) const;
  int StepsLeft(int wanted) const;
  bool Better(const BandPlan& plan, const BandPlan& best) const;
  void Keep(const BandTask& task, BandPlan plan, BandPlan& best);

  const BandPlannerSettings settings_;
  BandOptimizer band_;
  const robot::OwnRanges own_;
  std::unique_ptr<robot::Clearance> standing_;
  bool anything_stands_{false};
  BandCurve zero_;
  BandEnd end_{BandEnd::kGoal};  ///< where bands of the grid at hand may end
  BandOptimizer::Room end_room_{};
  bool moving_{false};     ///< something does
  double begin_{0.0};      ///< s; of this plan
  double most_time_{0.0};  ///< s; that it may cost
  struct Begun {
    long evaluations{0}, exact{0}, batches{0};
  };
  Begun begun_{};            ///< what the band had counted before this plan
  long certified_looks_{0};  ///< besides those of the band
  long path_looks_{0};       ///< of the search for paths, which has a bound of its own
};

}  // namespace oca::planning
