// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "oca/models/planning/band_optimizer.h"

namespace oca::planning {

/// Which start won: the request itself, the last band, the last band or the request relaxed, a
/// pause, a joint that goes out of the way, all of them at random, or a path of RrtConnect.
enum class BandStart { kRequest, kLast, kPause, kDetour, kRandom, kPath };
inline constexpr std::array kBandStartNames{"request", "last", "pause", "detour", "random", "path"};
inline std::span<const char* const> EnumNames(BandStart) { return kBandStartNames; }

struct BandPlannerSettings {
  BandSettings band{};
  int iterations{12};          ///< steps on the last band
  int start_iterations{30};    ///< steps on another start
  int relaxed_starts{6};       ///< the cheapest of all starts that are worth steps
  int random_starts{24};       ///< beside those of single joints
  int paths{2};                ///< of RrtConnect
  int path_nodes{2000};        ///< each
  long most_evaluations{0};    ///< of configurations, about, that a plan may cost; 0: no bound
  double least_horizon{2.0};   ///< s
  double moving_horizon{3.0};  ///< s; at most, while something moves
  double most_horizon{30.0};   ///< s
  double tail{0.5};            ///< s; after the end of the request
  double fine_span{1.6};       ///< s; from the start, with short intervals if anything moves
};

/// What a band is planned for.
struct BandTask {
  double start{0.0};             ///< s
  Eigen::VectorXd deviation[3];  /// at the start: position, velocity, acceleration
  BandRequest request{};
  double request_end{0.0};  ///< s; from then on it rests
  std::span<const BandBody> bodies{};
  std::uint64_t seed{0};
  std::uint64_t search{0};  ///< how many were made before: each looks at other starts
  bool explore{true};       ///< try other starts if the last band is not clear
  bool fresh{false};        ///< or if it is clear but the request is not
};

struct BandPlan {
  BandCurve curve{};
  BandCheck check{};
  BandStart start{BandStart::kRequest};
  double cost{0.0};
  long evaluations{0};  ///< configurations that were looked at
};

inline constexpr double kMarginWay = 10.0;  ///< rad/m

/// Finds bands: keeps the last one where it can be made clear, else tries many starts.
///
/// 1. The request, if nothing deviates and it is clear.
/// 2. The last band, relaxed; or the way straight back, if that is clear and much cheaper.
/// 3. If that is not clear, or the task is fresh: retreats along the gradient of the distance,
///    pauses before what moves, detours of each joint around the time in question, random ones, and
///    if these are not clear, paths of RrtConnect past what stands; the cheapest few are relaxed,
///    and of those that are clear the one wins whose joints go the shortest way, a missing margin
///    counted at kMarginWay. If none is clear: what lacks least.
///
/// A plan looks at about most_evaluations configurations, if that is above 0: a search then tries
/// some of the starts, the next one (BandTask::search) goes on with others, every third tries one
/// short path. Clear means within the limits too. While something moves, the end of a band is free
/// where the last one cannot be made clear otherwise.
///
/// The work is bounded and the answer a function of the arguments. Allocates.
class BandPlanner {
 public:
  BandPlanner(std::shared_ptr<const robot::RobotModel> model, const BandPlannerSettings& settings,
              bool self_collision = false, const robot::OwnRanges& own = {});

  const robot::RobotModel& model() const { return band_.model(); }
  /// `last` may be null.
  BandPlan Plan(const BandTask& task, const BandCurve* last);

 private:
  struct Start {
    BandStart kind;
    BandCurve curve;
    double cost;
  };
  double HorizonOf(const BandTask& task, bool moving) const;
  std::vector<double> TimesOf(const BandTask& task) const;
  void Prepare(const BandTask& task);
  BandCurve Shaped(const BandTask& task, const std::function<Eigen::VectorXd(double)>& shape) const;
  BandPlan Finish(BandStart kind, BandCurve curve, int iterations);
  BandPlan Bend(const BandTask& task, const BandCheck& trouble, const BandCurve* last);
  void Explore(const BandTask& task, const BandCheck& trouble, const BandCurve& troubled,
               BandPlan& best);
  void AddRetreats(const BandTask& task, const BandCheck& trouble, const BandCurve& from,
                   std::vector<Start>& starts);
  void AddPauses(const BandTask& task, const BandCheck& trouble, std::vector<Start>& starts) const;
  void AddDetours(const BandTask& task, const BandCheck& trouble, std::vector<Start>& starts) const;
  void TryPaths(const BandTask& task, BandPlan& best);
  int StepsLeft(int wanted) const;
  bool Better(const BandPlan& plan, const BandPlan& best) const;
  void Keep(BandPlan plan, BandPlan& best) const;

  const BandPlannerSettings settings_;
  BandOptimizer band_;
  std::unique_ptr<robot::Clearance> standing_;
  BandCurve zero_;
  bool end_fixed_{true};
  long begun_{0};  ///< evaluations before this plan
};

}  // namespace oca::planning
