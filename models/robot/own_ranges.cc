// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/own_ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/robot/clearance.h"

namespace oca::robot {
namespace {

constexpr double kLeftShare = 1.0 / 3.0;
constexpr double kTouching = 3e-4;        // m; below it two links count as in contact
constexpr double kLookStep = 0.05;        // rad, m; of the joint that goes farthest
constexpr int kFewestLooks = 4;           // in a segment, which need not go straight
constexpr int kMostLooks = 64;            // in a segment
constexpr std::size_t kMostOfAll = 2000;  // along a request of many segments

/// Where along a request to look, s; both ends are among them.
std::vector<double> TimesAlong(const motion::Trajectory& request) {
  const std::vector<double>& points = request.times();
  const std::size_t stride = 1 + points.size() * kFewestLooks / kMostOfAll;
  std::vector<double> times{points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); i = std::min(i + stride, points.size() - 1)) {
    const double begin = points[i];
    const double end = points[std::min(i + stride, points.size() - 1)];
    const double way =
        (request.Evaluate(end, 0) - request.Evaluate(begin, 0)).cwiseAbs().maxCoeff();
    const double looks =
        std::clamp(std::ceil(way / kLookStep), double{kFewestLooks}, double{kMostLooks});
    for (int k = 1; k <= looks; ++k) times.push_back(begin + k / looks * (end - begin));
  }
  return times;
}

/// The most that is asked for where `along` is the least distance on the way and `ends` that of its
/// ends, m.
double RangeOf(double along, double ends, double self_distance) {
  const double left = along > kTouching ? along : ends;
  if (left <= kTouching || left >= self_distance / kLeftShare) return self_distance;
  return std::min(self_distance, kLeftShare * left);
}

}  // namespace

OwnRanges OwnRangesAlong(const std::shared_ptr<const RobotModel>& model,
                         const motion::Trajectory* request, double self_distance) {
  if (self_distance == 0.0) return {};
  OwnRanges ranges(model->num_links(), self_distance);
  if (request == nullptr) return ranges;
  if (request->size() != model->num_positions()) {
    throw models::ModelError(fmt::format("request: length; got {} joints; expected {}",
                                         request->size(), model->num_positions()));
  }
  Clearance clearance(model, true);
  const auto& pairs = clearance.own_pairs();
  const double farthest = self_distance / kLeftShare;
  std::vector<double> along(pairs.size(), farthest), ends = along, here = along;
  const std::vector<double> times = TimesAlong(*request);
  for (std::size_t t = 0; t < times.size(); ++t) {
    clearance.MoveTo(request->Evaluate(times[t], 0));
    clearance.OwnDistances(farthest, here);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      along[i] = std::min(along[i], here[i]);
      if (t == 0 || t + 1 == times.size()) ends[i] = std::min(ends[i], here[i]);
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ranges.Set(pairs[i].first, pairs[i].second, RangeOf(along[i], ends[i], self_distance));
  }
  return ranges;
}

}  // namespace oca::robot
