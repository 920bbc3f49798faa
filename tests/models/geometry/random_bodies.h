// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "oca/models/geometry/collider.h"
#include "oca/models/geometry/distance.h"

namespace oca::geometry {

/// Random shapes and poses for tests; the same seed gives the same sequence.
class RandomBodies {
 public:
  static constexpr int kKinds = 7;  // all that end and are convex

  explicit RandomBodies(unsigned seed, double scale = 1.0) : generator_(seed), scale_(scale) {}

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int Integer(int count) { return std::uniform_int_distribution<int>(0, count - 1)(generator_); }

  Eigen::Vector3d Direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(generator_), normal(generator_), normal(generator_)).normalized();
  }

  Eigen::Isometry3d Pose(double radius) {
    std::normal_distribution<double> normal;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.linear() = Eigen::Quaterniond(normal(generator_), normal(generator_), normal(generator_),
                                    normal(generator_))
                     .normalized()
                     .toRotationMatrix();
    X.translation() = scale_ * Uniform(0.0, radius) * Direction();
    return X;
  }

  /// Quarter turns and a coarse grid: faces, edges and axes of two such bodies coincide often.
  Eigen::Isometry3d GridPose() {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.rotate(Eigen::AngleAxisd(Integer(4) * M_PI / 2.0, Eigen::Vector3d::Unit(Integer(3))));
    X.linear() = X.linear().array().round().matrix().eval();
    X.translation() =
        scale_ * 0.0625 * Eigen::Vector3d(Integer(9) - 4, Integer(9) - 4, Integer(9) - 4);
    return X;
  }

  Shape RandomShape(int kind) {
    const double s = scale_;
    switch (kind) {
      case 0:
        return Sphere{s * Uniform(0.03, 0.2)};
      case 1:
        return Capsule{s * Uniform(0.03, 0.15), s * Uniform(0.05, 0.5)};
      case 2:
        return Box{s * Eigen::Vector3d(Uniform(0.05, 0.4), Uniform(0.05, 0.4), Uniform(0.05, 0.4))};
      case 3:
        return Cylinder{s * Uniform(0.03, 0.2), s * Uniform(0.05, 0.5)};
      case 5:
        return Cone{s * Uniform(0.03, 0.2), s * Uniform(0.05, 0.5)};
      case 6:
        return Ellipsoid{
            s * Eigen::Vector3d(Uniform(0.03, 0.2), Uniform(0.03, 0.2), Uniform(0.03, 0.2))};
      default:
        return RandomMesh();
    }
  }

  std::shared_ptr<const Collider> Body(int kind) {
    return MakeCollider(RandomShape(kind), "random body");
  }

 private:
  Shape RandomMesh() {
    std::vector<Eigen::Vector3d> points(4 + Integer(60));
    for (Eigen::Vector3d& p : points) {
      p = scale_ * (Uniform(0.7, 1.0) * Direction().cwiseProduct(Eigen::Vector3d(0.2, 0.15, 0.3)) +
                    Eigen::Vector3d(0.05, 0.02, -0.03));
    }
    return ConvexMesh{MakeConvexHull(points, "random mesh")};
  }

  std::mt19937_64 generator_;
  double scale_;
};

inline std::string KindName(const Collider& collider) {
  static const char* const kNames[] = {"sphere", "box",       "cylinder",   "capsule", "mesh",
                                       "cone",   "ellipsoid", "half-space", "compound"};
  return kNames[collider.shape().index()];
}

/// Farthest point of a posed body along a unit direction, from the support function alone.
inline Eigen::Vector3d Farthest(const Collider& collider, const Eigen::Isometry3d& X,
                                const Eigen::Vector3d& direction) {
  const Eigen::Vector3d local = X.linear().transpose() * direction;
  return X * (collider.Support(local) + collider.radius() * local.normalized());
}

/// Width of the slab across unit `normal` that separates A (ahead) from B; negative in overlap.
/// For every direction this is a lower bound of the signed distance, for one it is equal.
inline double SlabWidth(const Collider& a, const Eigen::Isometry3d& X_WA, const Collider& b,
                        const Eigen::Isometry3d& X_WB, const Eigen::Vector3d& normal) {
  return normal.dot(Farthest(a, X_WA, -normal) - Farthest(b, X_WB, normal));
}

}  // namespace oca::geometry
