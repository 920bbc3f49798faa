// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/decomposition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "oca/models/error.h"
#include "oca/models/geometry/collider.h"
#include "oca/models/geometry/distance.h"
#include "oca/models/geometry/mesh_surface.h"
#include "oca/models/robot/urdf.h"
#include "tests/temporary_folder.h"

namespace oca::geometry {
namespace decomposition_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;
namespace fs = std::filesystem;

/// The surface of an angle of two 0.2 m thick boards, 1 m wide and high, as a text STL.
std::string Angle() {
  const std::vector<Eigen::Vector2d> corners{{0, 0},     {1, 0},   {1, 0.2},
                                             {0.2, 0.2}, {0.2, 1}, {0, 1}};
  const std::vector<std::array<int, 3>> side{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  std::string text = "solid angle\n";
  const auto add = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vector3d& p : {a, b, c}) {
      text += "vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
              std::to_string(p.z()) + "\n";
    }
    text += "endloop\nendfacet\n";
  };
  const auto at = [&](int corner, double z) {
    const auto& p = corners[static_cast<std::size_t>(corner)];
    return Vector3d(p.x(), p.y(), z);
  };
  for (const auto& [a, b, c] : side) {
    add(at(a, 0), at(c, 0), at(b, 0));
    add(at(a, 0.5), at(b, 0.5), at(c, 0.5));
  }
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    add(at(i, 0), at(next, 0), at(next, 0.5));
    add(at(i, 0), at(next, 0.5), at(i, 0.5));
  }
  return text + "endsolid angle\n";
}

double DistanceTo(const Compound& compound, const Vector3d& p) {
  const Collider body(compound, "body"), probe(Sphere{0.01}, "probe");
  return Distance(probe, Isometry3d(Eigen::Translation3d(p)), body, Isometry3d::Identity())
      .distance;
}

class DecompositionTest : public ::testing::Test {
 protected:
  DecompositionTest() : mesh_(folder_.Write("angle.stl", Angle())), cache_(folder_.path() / "c") {}
  Compound Load() { return LoadDecomposition(mesh_, Vector3d::Ones(), 0.03, cache_); }
  std::size_t CountFiles() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(cache_)) ++count;
    return count;
  }
  test::TemporaryFolder folder_;
  fs::path mesh_, cache_;
};

TEST_F(DecompositionTest, KeepsTheNookThatAHullFills) {
  const Compound parts = Load();
  EXPECT_GE(parts.parts.size(), 2u);
  EXPECT_LE(parts.parts.size(), 6u);
  const Vector3d nook(0.5, 0.5, 0.25);  // 0.3 m from either board
  EXPECT_NEAR(DistanceTo(parts, nook), 0.29, 0.02);
  const Collider hull(ConvexMesh{LoadMeshHull(mesh_).hull}, "hull"), probe(Sphere{0.01}, "probe");
  EXPECT_LT(Distance(probe, Isometry3d(Eigen::Translation3d(nook)), hull, Isometry3d::Identity())
                .distance,
            0.01);
}

TEST_F(DecompositionTest, HoldsEveryVertexOfTheMesh) {
  const Compound parts = Load();
  for (const Vector3d& p : LoadMesh(mesh_).vertices) {
    EXPECT_LE(DistanceTo(parts, p), -0.01 + 1e-9);
  }
}

TEST_F(DecompositionTest, IsTakenFromTheCacheTheNextTimeAndMadeAnewIfItIsDamaged) {
  const Compound first = Load();
  ASSERT_EQ(CountFiles(), 1u);
  const fs::path kept = fs::directory_iterator(cache_)->path();
  const auto written = fs::last_write_time(kept);
  const Compound second = Load();
  EXPECT_EQ(fs::last_write_time(kept), written);
  EXPECT_EQ(second.parts.size(), first.parts.size());
  const Vector3d p(0.6, 0.7, 0.4);
  EXPECT_NEAR(DistanceTo(second, p), DistanceTo(first, p), 1e-12);
  fs::resize_file(kept, fs::file_size(kept) - 5);
  EXPECT_EQ(Load().parts.size(), first.parts.size());
  std::ofstream(kept) << "something else";
  EXPECT_NEAR(DistanceTo(Load(), p), DistanceTo(first, p), 1e-12);
}

TEST_F(DecompositionTest, IsKeptApartByContentScaleAndConcavity) {
  Load();
  LoadDecomposition(mesh_, Vector3d(2.0, 1.0, 1.0), 0.03, cache_);
  LoadDecomposition(mesh_, Vector3d::Ones(), 0.5, cache_);
  EXPECT_EQ(CountFiles(), 3u);
}

TEST_F(DecompositionTest, WorksWithoutACache) {
  EXPECT_EQ(LoadDecomposition(mesh_, Vector3d::Ones(), 0.03, {}).parts.size(), Load().parts.size());
  folder_.Write("file", "");
  EXPECT_NO_THROW(LoadDecomposition(mesh_, Vector3d::Ones(), 0.03, folder_.path() / "file" / "c"));
}

TEST_F(DecompositionTest, SurvivesWritersAtTheSameTime) {
  std::vector<std::size_t> counts(4);
  {
    std::vector<std::jthread> writers;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      writers.emplace_back([&, i] { counts[i] = Load().parts.size(); });
    }
  }
  for (const std::size_t count : counts) EXPECT_EQ(count, counts[0]);
  EXPECT_EQ(Load().parts.size(), counts[0]);
}

TEST_F(DecompositionTest, MakesCompoundsOfARobotsMeshesIfAskedTo) {
  ASSERT_EQ(::setenv("XDG_CACHE_HOME", cache_.c_str(), 1), 0);
  const std::string robot = R"(<robot name="r"><link name="l"><collision><geometry>)"
                            R"(<mesh filename="angle.stl"/></geometry></collision></link></robot>)";
  robot::LoadOptions options;
  const auto shape = [&] {
    return robot::ParseUrdf(robot, "r.urdf", options, folder_.path())
        .links()[0]
        .collisions.at(0)
        .shape;
  };
  EXPECT_TRUE(std::holds_alternative<ConvexMesh>(shape()));
  options.decompose_meshes = true;
  ASSERT_TRUE(std::holds_alternative<Compound>(shape()));
  EXPECT_GE(std::get<Compound>(shape()).parts.size(), 2u);
  EXPECT_TRUE(fs::is_directory(cache_ / "oca"));
}

TEST_F(DecompositionTest, TellsHowFarItIsWhileSomebodyListens) {
  std::vector<double> shares;
  const auto make = [&] { DecomposeMesh(LoadMesh(mesh_), "the angle"); };
  {
    const DecompositionListener listener([&](std::string_view name, double share) {
      EXPECT_EQ(name, "the angle");
      shares.push_back(share);
    });
    make();
  }
  ASSERT_GE(shares.size(), 2u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GE(shares.front(), 0.0);
  EXPECT_EQ(shares.back(), 1.0);
  const std::size_t count = shares.size();
  make();
  EXPECT_EQ(shares.size(), count);
}

// The angle with each triangle cut into many: more than are clustered one by one.
TEST_F(DecompositionTest, OfAMeshOfManyTrianglesKeepsTheNookAndHoldsEveryVertex) {
  TriangleMesh mesh = WeldVertices(LoadMesh(mesh_));
  while (mesh.triangles.size() < 5'000) {
    TriangleMesh finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int first = static_cast<int>(finer.vertices.size());
      const Vector3d &A = mesh.vertices[a], &B = mesh.vertices[b], &C = mesh.vertices[c];
      for (const Vector3d& p :
           {A, B, C, Vector3d((A + B) / 2), Vector3d((B + C) / 2), Vector3d((C + A) / 2)}) {
        finer.vertices.push_back(p);
      }
      for (const auto& t : {std::array{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}) {
        finer.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      }
    }
    mesh = WeldVertices(finer);
  }
  Compound parts;
  for (const auto& hull : DecomposeMesh(mesh, "angle", kDefaultConcavity, 500)) {
    parts.parts.push_back({Isometry3d::Identity(), ConvexMesh{hull}});
  }
  EXPECT_NEAR(DistanceTo(parts, Vector3d(0.5, 0.5, 0.25)), 0.29, 0.05);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 7) {
    ASSERT_LE(DistanceTo(parts, mesh.vertices[i]), -0.01 + 1e-9);
  }
}

TEST_F(DecompositionTest, LooksForItsFolderAsXdgSays) {
  ASSERT_EQ(::setenv("XDG_CACHE_HOME", "/somewhere", 1), 0);
  ASSERT_EQ(::setenv("HOME", "/home/me", 1), 0);
  EXPECT_EQ(DecompositionCache(), "/somewhere/oca");
  ASSERT_EQ(::setenv("XDG_CACHE_HOME", "not/absolute", 1), 0);
  EXPECT_EQ(DecompositionCache(), "/home/me/.cache/oca");
  ASSERT_EQ(::unsetenv("HOME"), 0);
  EXPECT_EQ(DecompositionCache(), "");
}

TEST_F(DecompositionTest, RefusesWhatIsNoMeshAndNoConcavity) {
  for (const double concavity : {0.0, 1.0, -1.0, std::nan("")}) {
    EXPECT_THROW(LoadDecomposition(mesh_, Vector3d::Ones(), concavity, {}), models::ModelError);
  }
  EXPECT_THROW(LoadDecomposition(folder_.path() / "none.stl"), models::ModelError);
  EXPECT_THROW(DecomposeMesh({}, "nothing"), models::ModelError);
}

}  // namespace decomposition_test
}  // namespace oca::geometry
