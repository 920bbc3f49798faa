// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/ball_cover.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/geometry/convex_hull.h"
#include "oca/models/geometry/core_forms.h"

namespace oca::geometry {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// A part of a polyhedron, with the ball around it.
struct Piece {
  std::shared_ptr<const ConvexHull> hull;
  Ball ball;
  Eigen::Vector3d axis;  // its longest
  double excess;         // by which the ball sticks out, m
};

Piece MakePiece(std::shared_ptr<const ConvexHull> hull) {
  const Points& points = hull->vertices;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& p : points) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const auto& p : points) {
    const Eigen::Vector3d along = axes.eigenvectors().transpose() * p;
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  Eigen::Index longest = 0;
  (high - low).maxCoeff(&longest);
  Ball ball = EnclosingBall(points);
  const double excess = ball.radius - 0.5 * (high - low).minCoeff();
  return {std::move(hull), ball, axes.eigenvectors().col(longest), excess};
}

/// The half of a polyhedron beyond `at` along `axis`; nothing where that is too thin to be one.
std::optional<Piece> HalfOf(const ConvexHull& hull, const Eigen::Vector3d& axis, double at) {
  Points points;
  for (const auto& p : hull.vertices) {
    if (axis.dot(p) >= at) points.push_back(p);
  }
  for (const auto& triangle : hull.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(triangle[i])];
      const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(triangle[(i + 1) % 3])];
      const double s = axis.dot(a) - at, t = axis.dot(b) - at;
      if (s < 0.0 && t > 0.0) points.push_back(a + s / (s - t) * (b - a));
    }
  }
  try {
    return MakePiece(MakeConvexHull(points, hull.name));
  } catch (const models::ModelError&) {
    return std::nullopt;
  }
}

/// Cuts a piece in two at the middle of its longest axis; false where it cannot be cut.
bool Cut(Piece& piece, std::vector<Piece>& pieces) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& p : piece.hull->vertices) {
    low = std::min(low, piece.axis.dot(p));
    high = std::max(high, piece.axis.dot(p));
  }
  const double middle = 0.5 * (low + high);
  auto upper = HalfOf(*piece.hull, piece.axis, middle);
  auto lower = HalfOf(*piece.hull, -piece.axis, -middle);
  if (!upper || !lower) return false;
  piece = std::move(*upper);
  pieces.push_back(std::move(*lower));
  return true;
}

std::vector<Ball> CoverPolyhedron(std::shared_ptr<const ConvexHull> hull, int most, double slack) {
  std::vector<Piece> pieces{MakePiece(std::move(hull))};
  while (std::ssize(pieces) < most) {
    const auto worst =
        std::max_element(pieces.begin(), pieces.end(),
                         [](const Piece& a, const Piece& b) { return a.excess < b.excess; });
    if (worst->excess <= slack) break;
    if (!Cut(*worst, pieces)) worst->excess = 0.0;  // it stays as it is
  }
  std::vector<Ball> balls;
  for (const Piece& piece : pieces) balls.push_back(piece.ball);
  return balls;
}

std::vector<Ball> CoverCapsule(double radius, double length, int most, double slack) {
  // Balls with a distance d between them stick out by hypot(r, d / 2) - r.
  const double apart = 2.0 * std::sqrt(slack * (slack + 2.0 * radius));
  const double wanted = std::ceil(length / std::max(apart, 1e-9 * length));
  const int intervals = static_cast<int>(std::clamp(wanted, 1.0, std::max(most - 1.0, 1.0)));
  const double outer = std::hypot(radius, 0.5 * length / intervals);
  std::vector<Ball> balls;
  for (int i = 0; i <= intervals; ++i) {
    balls.push_back({{0.0, 0.0, (1.0 * i / intervals - 0.5) * length}, outer});
  }
  return balls;
}

}  // namespace

Ball EnclosingBall(const std::vector<Eigen::Vector3d>& points) {
  constexpr int kSteps = 200;  // the radius is then within 1 % of the least
  if (points.empty()) return {};
  Eigen::Vector3d centre = points.front();
  const auto farthest = [&] {
    return *std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
      return (a - centre).squaredNorm() < (b - centre).squaredNorm();
    });
  };
  for (int i = 1; i <= kSteps; ++i) centre += (farthest() - centre) / (i + 1.0);
  return {centre, (1.0 + 1e-12) * (farthest() - centre).norm()};
}

double InnerRadius(const Collider& solid, const Eigen::Vector3d& point) {
  if (solid.core() == Core::kCompound) return 0.0;
  return std::max(solid.radius() - internal::OutsideOf(solid, point).distance, 0.0);
}

std::vector<Ball> CoverWithBalls(const Collider& solid, int most, double slack) {
  std::vector<Ball> balls;
  switch (solid.core()) {
    case Core::kHalfSpace:
      return balls;
    case Core::kPoint:
      return {{solid.centre(), solid.radius()}};
    case Core::kSegment:
      return CoverCapsule(solid.radius(), 2.0 * solid.half().z(), most, slack);
    case Core::kCompound:
      for (const Collider::Part& part : solid.parts()) {
        for (const Ball& ball : CoverWithBalls(*part.collider, most, slack)) {
          balls.push_back({part.X_SP * ball.centre, ball.radius});
        }
      }
      return balls;
    default:
      break;
  }
  try {
    balls = CoverPolyhedron(MakeConvexHull(internal::CornersAround(solid), "cover"), most, slack);
    for (Ball& ball : balls) ball.radius += solid.radius();
  } catch (const models::ModelError&) {  // thinner than a polyhedron may be
    balls = {{solid.centre(), solid.bounding_radius()}};
  }
  return balls;
}

}  // namespace oca::geometry
