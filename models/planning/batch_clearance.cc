// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/batch_clearance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "oca/models/geometry/obstacle.h"
#include "oca/models/planning/batch_kernel.h"

namespace oca::planning {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A compound of more parts is looked at as one ball.
constexpr std::size_t kMostParts = 64;
static_assert(BatchClearance::kLanes == internal::kLanes);
// Of single precision, for a joint, with sine and cosine: see the class comment.
constexpr double kRounding = 2e-6;

float Above(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

std::array<float, 3> ToFloat(const Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

std::array<float, 9> ToFloat(const Eigen::Matrix3d& R) {
  std::array<float, 9> columns;
  for (Eigen::Index i = 0; i < 9; ++i) {
    columns[static_cast<std::size_t>(i)] = static_cast<float>(R(i % 3, i / 3));
  }
  return columns;
}

internal::BatchBall ToFloat(const geometry::Ball& ball, double inner) {
  return {ToFloat(ball.centre), Above(ball.radius), static_cast<float>(inner)};
}

/// Whether the kernel's form of a solid is the solid itself.
bool IsItself(const geometry::Collider& solid) {
  using geometry::Core;
  const Core core = solid.core();
  return core == Core::kPoint || core == Core::kSegment || core == Core::kBox ||
         core == Core::kCylinder || core == Core::kHalfSpace;
}

/// That turns the axis z to `axis`.
Isometry3d Turned(const Vector3d& axis) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis).toRotationMatrix();
  return X;
}

/// How far a slide can carry; its limits are finite or nothing of what it carries is known.
double LongestWay(const robot::RobotModel& model, const robot::KinematicStep& step) {
  const double lower = step.multiplier * model.lower_limits()[step.column] + step.offset;
  const double upper = step.multiplier * model.upper_limits()[step.column] + step.offset;
  return std::max(std::abs(lower), std::abs(upper));
}

}  // namespace

struct BatchClearance::Kernel {
  internal::BatchScene scene{};
  std::vector<internal::LaneArray> motion{};  // one a frame
  internal::BatchWorkspace work{scene};
};

BatchClearance::BatchClearance(robot::Clearance& clearance)
    : clearance_(clearance),
      kernel_(std::make_unique<Kernel>()),
      samples_(clearance.model().num_positions(), kLanes) {
  AddFrames();
  AddLinks();
  error_ = kRounding * (static_cast<double>(movers_.size()) + 2.0) * reach_;
  AddBodies();
  kernel_->motion.resize(movers_.size());
  kernel_->work = internal::BatchWorkspace(kernel_->scene);
}

BatchClearance::~BatchClearance() = default;

int BatchClearance::num_balls() const { return static_cast<int>(kernel_->scene.balls.size()); }

const internal::BatchScene& BatchClearance::scene() const { return kernel_->scene; }

void BatchClearance::AddFrames() {
  const robot::RobotModel& model = clearance_.model();
  frame_of_.assign(static_cast<std::size_t>(model.num_links()), 0);
  X_FL_.assign(frame_of_.size(), Isometry3d::Identity());
  X_FL_[0].linear() = model.X_WB().linear();
  std::vector<double> reach(frame_of_.size(), 0.0);
  for (std::size_t i = 0; i < model.steps().size(); ++i) {
    const robot::KinematicStep& step = model.steps()[i];
    const auto parent = static_cast<std::size_t>(step.parent_link);
    Isometry3d X_PJ = Isometry3d::Identity();
    X_PJ.linear() = step.R_PJ;
    X_PJ.translation() = step.p_PJ;
    const Isometry3d X_FJ = X_FL_[parent] * X_PJ;
    reach[i + 1] = reach[parent] + step.p_PJ.norm();
    if (step.column < 0) {
      frame_of_[i + 1] = frame_of_[parent];
      X_FL_[i + 1] = X_FJ;
      continue;
    }
    const Isometry3d X_CF = Turned(step.axis);
    const Isometry3d X_PF = X_FJ * X_CF;
    const bool slides = step.type == robot::JointType::kPrismatic;
    if (slides) reach[i + 1] += LongestWay(model, step);
    kernel_->scene.frames.push_back({frame_of_[parent], slides,
                                     ToFloat(Eigen::Matrix3d(X_PF.linear())),
                                     ToFloat(Vector3d(X_PF.translation()))});
    movers_.push_back({step.type, step.column, step.multiplier, step.offset});
    frame_of_[i + 1] = static_cast<int>(movers_.size());
    X_FL_[i + 1] = X_CF.inverse();
  }
  for (const robot::LinkCollider& link : clearance_.links()) {
    reach_ = std::max(
        reach_, reach[static_cast<std::size_t>(link.number)] + link.centre.norm() + link.radius);
  }
}

void BatchClearance::AddLinks() {
  const robot::RobotModel& model = clearance_.model();
  std::vector<int> place(frame_of_.size(), -1);
  const std::vector<robot::LinkCollider>& links = clearance_.links();
  const auto add = [&](std::size_t index) {
    const robot::LinkCollider& link = links[index];
    const auto number = static_cast<std::size_t>(link.number);
    const Isometry3d& X_FL = X_FL_[number];
    const int first = num_balls();
    for (const robot::LinkBall& ball : clearance_.covers()[index]) {
      kernel_->scene.balls.push_back(
          ToFloat({X_FL * ball.ball.centre, ball.ball.radius}, ball.inner));
    }
    place[number] = static_cast<int>(kernel_->scene.links.size());
    numbers_.push_back(link.number);
    kernel_->scene.links.push_back(
        {frame_of_[number], ToFloat({X_FL * link.centre, link.radius}, 0.0), first, num_balls()});
  };
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (model.body(links[i].number) < 0) add(i);
  }
  kernel_->scene.moving = static_cast<int>(kernel_->scene.links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (model.body(links[i].number) >= 0) add(i);
  }
  for (std::size_t i = 0; i < clearance_.own_pairs().size(); ++i) {
    const auto& pair = clearance_.own_pairs()[i];
    kernel_->scene.pairs.push_back({place[static_cast<std::size_t>(pair.second)],
                                    place[static_cast<std::size_t>(pair.first)],
                                    Above(1.0 / clearance_.own_scales()[i])});
  }
  for (const auto& pair : clearance_.ignored()) {
    kernel_->scene.ignored.push_back({place[static_cast<std::size_t>(pair.first)], pair.second});
  }
}

void BatchClearance::AddBodies() {
  Isometry3d X_OW = Isometry3d::Identity();  // to axes of the world about the base
  X_OW.translation() = -clearance_.model().X_WB().translation();
  for (std::size_t i = 0; i < clearance_.bodies().size(); ++i) {
    const robot::PlacedBody& body = clearance_.bodies()[i];
    const double variance = std::max(body.covariance.trace(), 0.0);
    AddSolid(static_cast<int>(i), *body.collider, X_OW * body.X_WO,
             geometry::kConfidence * std::sqrt(variance));
  }
}

void BatchClearance::AddSolid(int body, const geometry::Collider& solid, const Isometry3d& X_OB,
                              double uncertain) {
  using geometry::Core;
  using internal::BatchCore;
  const bool many = solid.core() == Core::kCompound && solid.parts().size() > kMostParts;
  if (solid.core() == Core::kCompound && !many) {
    for (const geometry::Collider::Part& part : solid.parts()) {
      AddSolid(body, *part.collider, X_OB * part.X_SP, uncertain);
    }
    return;
  }
  Vector3d low = -solid.half(), high = solid.half();
  if (solid.hull() != nullptr) {
    low = high = solid.hull()->vertices.front();
    for (const Vector3d& vertex : solid.hull()->vertices) {
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
  }
  if (many) low = high = solid.centre();
  const Vector3d middle = 0.5 * (low + high);
  const Vector3d half = 0.5 * (high - low);
  const Vector3d centre = X_OB * middle;
  const double error = kRounding * centre.norm();
  const double round = many ? solid.bounding_radius() : solid.radius();
  const double radius = round + error + uncertain;
  BatchCore core = BatchCore::kBox;
  if (solid.core() == Core::kCylinder || solid.core() == Core::kCone) core = BatchCore::kCylinder;
  if (solid.core() == Core::kHalfSpace) core = BatchCore::kPlane;
  kernel_->scene.solids.push_back(
      {core,
       body,
       ToFloat(Eigen::Matrix3d(X_OB.linear().transpose())),
       ToFloat(centre),
       {Above(half.x()), Above(half.y()), Above(half.z())},
       Above(radius),
       static_cast<float>(IsItself(solid) ? round - 2.0 * error
                                          : -std::numeric_limits<double>::infinity()),
       Above(core == BatchCore::kPlane ? std::numeric_limits<double>::infinity()
                                       : half.norm() * (1.0 + kRounding) + radius)});
}

internal::BatchAnswer BatchClearance::Ask(const Eigen::Ref<const Eigen::MatrixXd>& q, int count,
                                          double margin) {
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
  looked_at_ += count;
  const unsigned lanes = (1u << count) - 1u;
  return internal::CheckLanes(
      kernel_->scene, {kernel_->motion.data(), Above(margin), Above(error_), lanes}, kernel_->work);
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
    if ((open & bit) != 0 && ExactlyClear(q.col(lane), bit, margin)) clear |= bit;
  }
  return clear;
}

bool BatchClearance::ExactlyClear(const Eigen::Ref<const Eigen::VectorXd>& q, unsigned lane,
                                  double margin) {
  ++undecided_;
  if (!q.allFinite()) return false;
  clearance_.MoveTo(q);
  for (const internal::BatchCandidate& candidate : kernel_->work.found) {
    if ((candidate.lanes & lane) == 0) continue;
    const double distance =
        candidate.body >= 0
            ? clearance_.LinkDistance(numbers_[static_cast<std::size_t>(candidate.link)],
                                      candidate.body, margin)
            : clearance_.OwnPairDistance(static_cast<std::size_t>(candidate.pair), margin);
    if (distance < margin) return false;
  }
  return true;
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
    if (Clear(samples_, filled, margin) != (1u << filled) - 1u) return false;
  }
  return true;
}

}  // namespace oca::planning
