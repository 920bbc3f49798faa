// SPDX-License-Identifier: BSD-3-Clause
// What BatchClearance gives its kernel to look at.
#include <algorithm>
#include <cmath>
#include <limits>

#include "oca/models/geometry/obstacle.h"
#include "oca/models/planning/batch_clearance.h"
#include "oca/models/planning/batch_kernel.h"

namespace oca::planning {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using internal::Above;
using internal::kRounding;

// A compound of more parts is looked at as one ball.
constexpr std::size_t kMostParts = 64;

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

BatchClearance::BatchClearance(robot::Clearance& clearance, std::span<const int> moving)
    : clearance_(clearance),
      kernel_(std::make_unique<internal::BatchKernel>()),
      samples_(clearance.model().num_positions(), kLanes) {
  AddFrames();
  AddLinks();
  error_ = kRounding * (static_cast<double>(movers_.size()) + 2.0) * reach_;
  AddBodies(moving);
  kernel_->motion.resize(movers_.size());
  kernel_->paths.resize(movers_.size());
  kernel_->work = internal::BatchWorkspace(kernel_->scene);
  movers_at_.resize(4 * moving.size());
  candidates_.reserve(kernel_->work.found.capacity());
}

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
    const int link = clearance_.own_pairs()[i].second, other = clearance_.own_pairs()[i].first;
    int frame = frame_of_[static_cast<std::size_t>(link)];
    for (int last = frame_of_[static_cast<std::size_t>(other)]; frame != last;) {
      int& later = frame > last ? frame : last;  // parents come before their children
      later = kernel_->scene.frames[static_cast<std::size_t>(later) - 1].parent;
    }
    kernel_->scene.pairs.push_back({place[static_cast<std::size_t>(link)],
                                    place[static_cast<std::size_t>(other)], frame,
                                    Above(1.0 / clearance_.own_scales()[i])});
  }
  for (const auto& pair : clearance_.ignored()) {
    kernel_->scene.ignored.push_back({place[static_cast<std::size_t>(pair.first)], pair.second});
  }
}

void BatchClearance::AddBodies(std::span<const int> moving) {
  for (const int body : moving) kernel_->scene.movers.push_back({body});
  Isometry3d X_OW = Isometry3d::Identity();  // to axes of the world about the base
  X_OW.translation() = -clearance_.model().X_WB().translation();
  for (std::size_t i = 0; i < clearance_.bodies().size(); ++i) {
    if (std::count(moving.begin(), moving.end(), static_cast<int>(i)) > 0) continue;
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

}  // namespace oca::planning
