// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/batch_clearance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "oca/models/planning/batch_kernel.h"

namespace oca::planning {
namespace {

static_assert(BatchClearance::kLanes == internal::kLanes);
constexpr double kPathRounding = 1e-5;  // of a path, and what it carries

}  // namespace

BatchClearance::~BatchClearance() = default;

int BatchClearance::num_balls() const { return static_cast<int>(kernel_->scene.balls.size()); }

const internal::BatchScene& BatchClearance::scene() const { return kernel_->scene; }

void BatchClearance::Load(const Eigen::Ref<const Eigen::MatrixXd>& q, int count) {
  assert(count > 0 && count <= kLanes && q.cols() >= count && q.rows() == samples_.rows());
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const Mover& mover = movers_[i];
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::Index column = std::min(lane, count - 1);
      double moved = mover.multiplier * q(mover.column, column) + mover.offset;
      const bool turns = mover.type != robot::JointType::kPrismatic;
      if (turns && !(std::abs(moved) <= std::numbers::pi)) {
        moved = std::remainder(moved, 2.0 * std::numbers::pi);
      }
      kernel_->motion[i][static_cast<std::size_t>(lane)] = static_cast<float>(moved);
    }
  }
}

internal::BatchAnswer BatchClearance::AskKernel(const internal::LaneArray* paths, int count,
                                                double margin) {
  looked_at_ += count;
  const unsigned lanes = (1u << count) - 1u;
  return internal::CheckLanes(kernel_->scene,
                              {kernel_->motion.data(), paths, nullptr, internal::Above(margin),
                               internal::Above(error_), lanes, false},
                              kernel_->work);
}

void BatchClearance::LoadMovers(std::span<const MovingBall> balls, int count) {
  const std::size_t movers = kernel_->scene.movers.size();
  const Eigen::Vector3d base = clearance_.model().X_WB().translation();
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto column = static_cast<std::size_t>(std::min(lane, count - 1));
    for (std::size_t m = 0; m < movers; ++m) {
      const MovingBall& ball = balls[column * movers + m];
      const Eigen::Vector3d centre = ball.centre - base;
      const auto at = static_cast<std::size_t>(lane);
      for (std::size_t i = 0; i < 3; ++i) {
        movers_at_[4 * m + i][at] = static_cast<float>(centre[static_cast<Eigen::Index>(i)]);
      }
      movers_at_[4 * m + 3][at] =
          internal::Above(ball.radius + internal::kRounding * centre.norm());
    }
  }
}

std::span<const BatchClearance::Candidate> BatchClearance::Near(
    const Eigen::Ref<const Eigen::MatrixXd>& q, int count, double margin,
    std::span<const MovingBall> balls) {
  Load(q, count);
  LoadMovers(balls, count);
  looked_at_ += count;
  internal::CheckLanes(
      kernel_->scene,
      {kernel_->motion.data(), nullptr, movers_at_.empty() ? nullptr : movers_at_.data(),
       internal::Above(margin), internal::Above(error_), (1u << count) - 1u, true},
      kernel_->work);
  candidates_.clear();
  for (const internal::BatchCandidate& found : kernel_->work.found) {
    const int link = found.body < 0 ? -1 : numbers_[static_cast<std::size_t>(found.link)];
    candidates_.push_back({{link, found.body, found.pair}, found.lanes});
  }
  // Solids are found before what moves; links ascend in the model's order.
  std::stable_sort(
      candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        const bool own = a.pair.body < 0, other = b.pair.body < 0;
        if (own || other) return own < other;
        return std::pair(a.pair.link, a.pair.body) < std::pair(b.pair.link, b.pair.body);
      });
  return candidates_;
}

internal::BatchAnswer BatchClearance::Ask(const Eigen::Ref<const Eigen::MatrixXd>& q, int count,
                                          double margin) {
  Load(q, count);
  return AskKernel(nullptr, count, margin);
}

internal::BatchAnswer BatchClearance::AskAround(const Eigen::Ref<const Eigen::MatrixXd>& q,
                                                const Eigen::Ref<const Eigen::MatrixXd>& path,
                                                int count, double margin) {
  Load(q, count);
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const double share = (1.0 + kPathRounding) * std::abs(movers_[i].multiplier);
    for (int lane = 0; lane < kLanes; ++lane) {
      kernel_->paths[i][static_cast<std::size_t>(lane)] =
          internal::Above(share * path(movers_[i].column, std::min(lane, count - 1)));
    }
  }
  return AskKernel(kernel_->paths.data(), count, margin);
}

unsigned BatchClearance::SurelyClear(const Eigen::Ref<const Eigen::MatrixXd>& q, int count,
                                     double margin) {
  return ((1u << count) - 1u) & ~Ask(q, count, margin).open;
}

unsigned BatchClearance::Clear(const Eigen::Ref<const Eigen::MatrixXd>& q, int count,
                               double margin) {
  const internal::BatchAnswer answer = Ask(q, count, margin);
  const unsigned open = answer.open & ~answer.surely;
  unsigned clear = ((1u << count) - 1u) & ~answer.open;
  for (int lane = 0; lane < count; ++lane) {
    const unsigned bit = 1u << lane;
    if ((open & bit) == 0) continue;
    if (LookExactly(q.col(lane), lane, margin, false) == Exactly::kClear) clear |= bit;
  }
  return clear;
}

int BatchClearance::CountClear(const Eigen::Ref<const Eigen::MatrixXd>& q, int count,
                               double margin) {
  const internal::BatchAnswer answer = Ask(q, count, margin);
  for (int lane = 0; lane < count; ++lane) {
    const unsigned bit = 1u << lane;
    if ((answer.open & bit) == 0) continue;
    if ((answer.surely & bit) != 0) return lane;
    if (LookExactly(q.col(lane), lane, margin, false) != Exactly::kClear) return lane;
  }
  return count;
}

BatchClearance::Around BatchClearance::ClearAround(const Eigen::Ref<const Eigen::MatrixXd>& q,
                                                   const Eigen::Ref<const Eigen::MatrixXd>& path,
                                                   int count, double margin) {
  const internal::BatchAnswer answer = AskAround(q, path, count, margin);
  Around around{((1u << count) - 1u) & ~answer.open, answer.surely};
  for (int lane = 0; lane < count; ++lane) {
    const unsigned bit = 1u << lane;
    if ((answer.open & ~answer.surely & bit) == 0) continue;
    switch (LookExactly(q.col(lane), lane, margin, true)) {
      case Exactly::kClear:
        around.clear |= bit;
        break;
      case Exactly::kContact:
        around.contact |= bit;
        break;
      case Exactly::kNear:
        break;
    }
  }
  return around;
}

double BatchClearance::TravelOf(int link, int frame, int lane) const {
  return kernel_->work.travels[static_cast<std::size_t>(link) * (movers_.size() + 1) +
                               static_cast<std::size_t>(frame)][static_cast<std::size_t>(lane)];
}

BatchClearance::Exactly BatchClearance::LookExactly(const Eigen::Ref<const Eigen::VectorXd>& q,
                                                    int lane, double margin, bool travels) {
  ++undecided_;
  if (!q.allFinite()) return Exactly::kContact;
  clearance_.MoveTo(q);
  for (const internal::BatchCandidate& candidate : kernel_->work.found) {
    if ((candidate.lanes & (1u << lane)) == 0) continue;
    double distance = 0.0, limit = margin;
    if (candidate.body >= 0) {
      if (travels) limit += TravelOf(candidate.link, 0, lane);
      distance = clearance_.LinkDistance(numbers_[static_cast<std::size_t>(candidate.link)],
                                         candidate.body, limit);
    } else {
      const auto number = static_cast<std::size_t>(candidate.pair);
      const internal::BatchPair& pair = kernel_->scene.pairs[number];
      if (travels) {
        limit += clearance_.own_scales()[number] *
                 (TravelOf(pair.link, pair.frame, lane) + TravelOf(pair.other, pair.frame, lane));
      }
      distance = clearance_.OwnPairDistance(number, limit);
    }
    if (distance < margin) return Exactly::kContact;
    if (distance < limit) return Exactly::kNear;
  }
  return Exactly::kClear;
}

bool BatchClearance::SamplesClear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                                  const Eigen::Ref<const Eigen::VectorXd>& q_1, int count,
                                  double margin) {
  // Batch b looks at samples b + 1, b + 1 + batches, ...: each at places all along the motion.
  const int batches = (count + kLanes - 1) / kLanes;
  for (int batch = 0; batch < batches; ++batch) {
    int filled = 0;
    for (int sample = count - batch; sample > 0; sample -= batches) {
      samples_.col(filled++) = q_0 + static_cast<double>(sample) / count * (q_1 - q_0);
    }
    const internal::BatchAnswer answer = Ask(samples_, filled, margin);
    if (answer.surely != 0) return false;
    for (int lane = 0; lane < filled; ++lane) {
      if ((answer.open & (1u << lane)) == 0) continue;
      if (LookExactly(samples_.col(lane), lane, margin, false) != Exactly::kClear) return false;
    }
  }
  return true;
}

}  // namespace oca::planning
