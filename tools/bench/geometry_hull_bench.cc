// SPDX-License-Identifier: BSD-3-Clause
//
// Rows geometry/hull/BODY/TRIANGLES: from the triangles of a body, each with corners of its own as
// in STL, to its convex hull and what that adds to the body: all that follows the reading of a
// mesh. Of `points`, which lie anywhere in a cube, three are a triangle. Counter: `seconds` of CPU.

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <random>
#include <vector>

#include "oca/models/geometry/convex_hull.h"
#include "oca/models/geometry/mesh_surface.h"

namespace oca::bench {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

void Add(const std::array<Vector3d, 3>& triangle, TriangleMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Vector3d& p : triangle) mesh.vertices.push_back(p.cast<float>().cast<double>());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// The quadrangles of a grid over (0, 1) x (0, 1), two triangles each.
void AddGrid(int rows, int columns, const std::function<Vector3d(double, double)>& at,
             TriangleMesh& mesh) {
  const auto corner = [&](int i, int j) {
    return at(static_cast<double>(i) / rows, static_cast<double>(j) / columns);
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const Vector3d a = corner(i, j), b = corner(i + 1, j);
      const Vector3d c = corner(i + 1, (j + 1) % columns), d = corner(i, (j + 1) % columns);
      Add({a, b, c}, mesh);
      Add({a, c, d}, mesh);
    }
  }
}

TriangleMesh Ellipsoid(int triangles, const Vector3d& radii) {
  const int rows = static_cast<int>(std::sqrt(triangles / 4.0));
  TriangleMesh mesh;
  AddGrid(
      rows, 2 * rows,
      [&](double s, double t) -> Vector3d {
        const double a = M_PI * s, b = 2.0 * M_PI * t;
        return radii.cwiseProduct(
            Vector3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
      },
      mesh);
  return mesh;
}

TriangleMesh Sphere(int triangles) { return Ellipsoid(triangles, {1.0, 1.0, 1.0}); }
TriangleMesh Oval(int triangles) { return Ellipsoid(triangles, {0.1, 0.5, 1.0}); }

/// Oblique, so that the points of a rim lie in a plane but for rounding.
TriangleMesh Cylinder(int triangles) {
  const int n = triangles / 4;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const auto rim = [&](int k, double z) -> Vector3d {
      return R * Vector3d(std::cos(2.0 * M_PI * k / n), std::sin(2.0 * M_PI * k / n), z);
    };
    const int next = (i + 1) % n;
    Add({rim(i, -1), rim(next, -1), rim(next, 1)}, mesh);
    Add({rim(i, -1), rim(next, 1), rim(i, 1)}, mesh);
    Add({rim(0, -1), rim(next, -1), rim(i, -1)}, mesh);
    Add({rim(0, 1), rim(i, 1), rim(next, 1)}, mesh);
  }
  return mesh;
}

TriangleMesh Cube(int triangles) {
  const int n = static_cast<int>(std::sqrt(triangles / 12.0));
  TriangleMesh mesh;
  for (int side = 0; side < 6; ++side) {
    const double z = side % 2 == 0 ? -1.0 : 1.0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto at = [&](int k, int l) {
          Vector3d p;
          p[side / 2] = z;
          p[(side / 2 + 1) % 3] = z * (2.0 * k / n - 1.0);
          p[(side / 2 + 2) % 3] = 2.0 * l / n - 1.0;
          return p;
        };
        Add({at(i, j), at(i + 1, j), at(i + 1, j + 1)}, mesh);
        Add({at(i, j), at(i + 1, j + 1), at(i, j + 1)}, mesh);
      }
    }
  }
  return mesh;
}

TriangleMesh Points(int triangles) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto point = [&] {
    const double x = uniform(generator), y = uniform(generator);
    return Vector3d(x, y, uniform(generator));
  };
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vector3d a = point(), b = point();
    Add({a, b, point()}, mesh);
  }
  return mesh;
}

void Hull(benchmark::State& state, TriangleMesh (*make)(int triangles)) {
  const TriangleMesh mesh = make(static_cast<int>(state.range(0)));
  const std::clock_t begin = std::clock();
  for (auto _ : state) {
    const auto hull = geometry::MakeConvexHull(mesh.vertices, "bench");
    benchmark::DoNotOptimize(geometry::DescribeHullExcess(mesh, *hull));
  }
  state.counters["seconds"] = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC /
                              static_cast<double>(state.iterations());
}

void Sizes(benchmark::internal::Benchmark* row) {
  row->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(Hull, sphere, Sphere)->Name("geometry/hull/sphere")->Apply(Sizes);
BENCHMARK_CAPTURE(Hull, ellipsoid, Oval)->Name("geometry/hull/ellipsoid")->Apply(Sizes);
BENCHMARK_CAPTURE(Hull, cylinder, Cylinder)->Name("geometry/hull/cylinder")->Apply(Sizes);
BENCHMARK_CAPTURE(Hull, cube, Cube)->Name("geometry/hull/cube")->Apply(Sizes);
BENCHMARK_CAPTURE(Hull, points, Points)->Name("geometry/hull/points")->Apply(Sizes);

}  // namespace
}  // namespace oca::bench
