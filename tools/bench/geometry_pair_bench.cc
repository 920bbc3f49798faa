// SPDX-License-Identifier: BSD-3-Clause
//
// One distance query. Rows geometry/pair/A-B/cold|warm for bodies up to some decimetres apart,
// with their peer geometry/pair/A-B/cold/fcl; geometry/pair/A-B/overlap|deep for bodies that
// overlap by 1 to 6 cm, or by 6 to 14, each also /warm. A round is a walk of many small steps, so
// that `warm`, which keeps a PairCache, sees what a control tick sees.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "oca/models/geometry/distance.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/fcl_bodies.h"

namespace oca::bench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::Shape;

constexpr int kSteps = 1024;

// The lofted housing of a link: `rings` rings of `sides` corners, bulging to one side.
Shape Housing(int rings, int sides) {
  std::vector<Vector3d> points;
  for (int i = 0; i < rings; ++i) {
    const double z = -0.12 + 0.24 * i / (rings - 1);
    const double radius = 0.08 * std::sqrt(1.0 - 9.0 * z * z);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5 * (i % 2)) / sides;
      points.emplace_back(radius * std::cos(angle) + 0.1 * (0.12 - std::abs(z)),
                          radius * std::sin(angle), z);
    }
  }
  return geometry::ConvexMesh{geometry::MakeConvexHull(points, "housing")};
}

struct Named {
  const char* name;
  Shape shape;
};

const std::vector<Named>& Shapes() {
  static const std::vector<Named> shapes{{"sphere", geometry::Sphere{0.1}},
                                         {"capsule", geometry::Capsule{0.07, 0.2}},
                                         {"box", geometry::Box{{0.2, 0.15, 0.25}}},
                                         {"cylinder", geometry::Cylinder{0.08, 0.25}},
                                         {"cone", geometry::Cone{0.1, 0.25}},
                                         {"ellipsoid", geometry::Ellipsoid{{0.08, 0.1, 0.13}}},
                                         {"lean", Housing(7, 9)},
                                         {"hull600", Housing(20, 30)},
                                         {"half_space", geometry::HalfSpace{}}};
  return shapes;
}

Isometry3d RandomPose(std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  Isometry3d X = Isometry3d::Identity();
  X.linear() =
      Eigen::Quaterniond(normal(*random), normal(*random), normal(*random), normal(*random))
          .normalized()
          .toRotationMatrix();
  return X;
}

// Poses of A at rest and of B on a walk around it; the signed distance stays within the limits.
std::vector<Isometry3d> Walk(const geometry::Collider& a, const geometry::Collider& b,
                             const Isometry3d& X_WA, double least, double most) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> gap(least, most);
  std::vector<Isometry3d> poses;
  Isometry3d X = Isometry3d::Identity();
  Vector3d v = Vector3d::Zero(), omega = Vector3d::Zero();
  while (static_cast<int>(poses.size()) < kSteps) {
    if (poses.size() % 32 == 0) {  // another place, then a smooth way through it
      X = RandomPose(&random);
      X.translation() = 0.3 * Vector3d(normal(random), normal(random), normal(random));
      for (int i = 0; i < 4; ++i) {
        const auto found = geometry::Distance(a, X_WA, b, X);
        X.translation() -= (gap(random) - found.distance) * found.normal;
      }
      v = 1e-3 * Vector3d(normal(random), normal(random), normal(random));
      omega = 3e-3 * Vector3d(normal(random), normal(random), normal(random));
    }
    poses.push_back(X);
    X.translation() += v;
    X.linear() = Eigen::AngleAxisd(omega.norm(), omega.normalized()) * X.linear();
  }
  return poses;
}

struct Scene {
  Scene(const Shape& shape_a, const Shape& shape_b, double least, double most)
      : a(geometry::MakeCollider(shape_a, "a")), b(geometry::MakeCollider(shape_b, "b")) {
    std::mt19937_64 random(3);
    X_WA = RandomPose(&random);
    X_WA.translation() = Vector3d(0.1, -0.2, 0.3);
    poses = Walk(*a, *b, X_WA, least, most);
  }
  std::shared_ptr<const geometry::Collider> a, b;
  Isometry3d X_WA;
  std::vector<Isometry3d> poses;
};

void Ours(benchmark::State& state, const Scene& scene, bool warm) {
  geometry::PairCache cache;
  std::size_t i = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(geometry::Distance(*scene.a, scene.X_WA, *scene.b, scene.poses[i],
                                                10.0, warm ? &cache : nullptr));
    i = (i + 1) % scene.poses.size();
  }
}

void Fcl(benchmark::State& state, const Scene& scene) {
  fcl::CollisionObjectd a(ToFcl(scene.a->shape()), scene.X_WA);
  fcl::CollisionObjectd b(ToFcl(scene.b->shape()));
  fcl::DistanceRequestd request(true);
  request.gjk_solver_type = fcl::GST_LIBCCD;
  std::size_t i = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    fcl::DistanceResultd result;
    b.setTransform(scene.poses[i]);
    benchmark::DoNotOptimize(fcl::distance(&a, &b, request, result));
    i = (i + 1) % scene.poses.size();
  }
}

void Register(const Named& first, const Named& second) {
  const std::string row = fmt::format("geometry/pair/{}-{}", first.name, second.name);
  const auto add = [&](const char* kind, double least, double most, auto run) {
    benchmark::RegisterBenchmark((row + kind).c_str(), [=](benchmark::State& state) {
      run(state, Scene(first.shape, second.shape, least, most));
    });
  };
  const auto cold = [](auto& state, const Scene& scene) { Ours(state, scene, false); };
  const auto warm = [](auto& state, const Scene& scene) { Ours(state, scene, true); };
  constexpr double kNear = 0.05, kFar = 0.4, kShallow = -0.01, kDeep = -0.06, kDeepest = -0.14;
  add("/cold", kNear, kFar, cold);
  add("/warm", kNear, kFar, warm);
  add("/overlap", kDeep, kShallow, cold);
  add("/overlap/warm", kDeep, kShallow, warm);
  add("/deep", kDeepest, kDeep, cold);
  add("/deep/warm", kDeepest, kDeep, warm);
  // FCL measures a half-space in collisions only, and its penetration search aborts now and then.
  if (second.shape.index() != Shape(geometry::HalfSpace{}).index()) {
    add("/cold/fcl", kNear, kFar, Fcl);
  }
}

[[maybe_unused]] const bool kPairsRegistered = [] {
  const auto& shapes = Shapes();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t k = i; k < shapes.size(); ++k) {
      if (i + 1 == shapes.size()) continue;  // two half-spaces
      Register(shapes[i], shapes[k]);
    }
  }
  return true;
}();

}  // namespace
}  // namespace oca::bench
