// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/obj_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "oca/models/error.h"
#include "oca/models/geometry/polygon.h"

namespace oca::geometry::internal {
namespace obj_file_test {

using Eigen::Vector3d;
using testing::ElementsAre;

std::string RefusalOf(const std::string& text) {
  try {
    ReadObj("a.obj", text);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

constexpr char kVertices[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// What all triangles cover, those that overlap twice.
double Area(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d& p = mesh.vertices[a];
    area += (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm() / 2.0;
  }
  return area;
}

TEST(ObjFileTest, ReadsVerticesInEachFormThatNumbersHave) {
  const TriangleMesh mesh =
      ReadObj("a.obj", "v .5 -.25 1.\r\nv\t1e-1 +2 3E1 # corner\nv 2 4 6 2\nv 0 0 1 0.9 0.1 0.1\n");
  EXPECT_THAT(mesh.vertices, ElementsAre(Vector3d(0.5, -0.25, 1), Vector3d(0.1, 2, 30),
                                         Vector3d(1, 2, 3), Vector3d(0, 0, 1)));
}

TEST(ObjFileTest, ReadsCornersInEachFormThatTheyHave) {
  using Triangle = std::array<int, 3>;
  const std::string text = kVertices;
  for (const char* face : {"f 1 2 3", "f 1/4 2/5 3/6", "f 1//7 2//8 3//9", "f 1/4/7 2/5/8 3/6/9",
                           "f -3 -2 -1", "f 1 \\\n2 \\\r\n 3", " f\t1  2 3 # end"}) {
    EXPECT_THAT(ReadObj("a.obj", text + face).triangles, ElementsAre(Triangle{0, 1, 2})) << face;
  }
  EXPECT_THAT(ReadObj("a.obj", "f 1 2 3\n" + text).triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(ReadObj("a.obj", text + "f -3 -2 -1\nv 9 9 9\nf -1 -2 -3\n").triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{3, 2, 1}));
}

TEST(ObjFileTest, PassesOverWhatIsNoSurfaceOfFaces) {
  const std::string text = std::string("vp 1\ncstype bezier\nmtllib a.mtl\no v\nusemtl f\n") +
                           kVertices + "vt 0 0\nvn 0 0 1\nl 1 2\np 1\nf 1 2\nf 1 2 3\n";
  EXPECT_EQ(ReadObj("a.obj", text).triangles.size(), 1u);
}

TEST(ObjFileTest, NamesTheLineThatIsWrong) {
  const std::string text = kVertices;
  EXPECT_EQ(RefusalOf(text + "f 1 2 4\n"),
            "a.obj:4: corner of a face; got 4; expected one of the 3 vertices, from 1 on, or from "
            "-1 back to -3");
  EXPECT_EQ(RefusalOf("f 1 2 3\n"),
            "a.obj:1: corner of a face; got 1; expected one of the 0 vertices, from 1 on");
  for (const char* corner : {"0", "-4", "99999999999999999999", "-9223372036854775808", "1.5", "x",
                             "/1", "0x1", "1,2"}) {
    EXPECT_THAT(RefusalOf(text + "f 1 \\\n2 " + corner), testing::StartsWith("a.obj:4: corner"))
        << corner;
  }
  EXPECT_EQ(RefusalOf("\nv 0 0\n"), "a.obj:2: vertex; got 2 numbers; expected 3, x, y and z");
  EXPECT_EQ(RefusalOf("v 0 0,5 0\n"), "a.obj:1: vertex; got 0,5; expected a finite number");
  EXPECT_EQ(RefusalOf("v 0 nan 0\n"), "a.obj:1: vertex; got nan; expected a finite number");
  EXPECT_EQ(RefusalOf("v 1 1 1 0\n"),
            "a.obj:1: weight of a vertex; got 0; expected another number");
  EXPECT_EQ(RefusalOf(std::string("v\0 ", 3)),
            "a.obj: is no OBJ file; got a zero byte; expected text");
}

TEST(ObjFileTest, PolygonsWithOneCornerInwardsAreCoveredAndNoMore) {
  // An arrow head, its notch at each place of the list, and an L.
  for (const char* face : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3", "f 4 3 2 1"}) {
    const TriangleMesh arrow =
        ReadObj("a.obj", std::string("v 0 0 0\nv 2 -1 0\nv 0 3 0\nv -2 -1 0\n") + face);
    EXPECT_NEAR(Area(arrow), 6.0, 1e-12) << face;
  }
  const TriangleMesh angle =
      ReadObj("a.obj", "v 0 0 5\nv 2 0 5\nv 2 1 5\nv 1 1 5\nv 1 2 5\nv 0 2 5\nf 1 2 3 4 5 6\n");
  EXPECT_NEAR(Area(angle), 3.0, 1e-12);
}

// Its words would take eight times its room.
TEST(ObjFileTest, RefusesALineTooLong) {
  EXPECT_EQ(RefusalOf(kVertices + ("f" + std::string(10'000'000, ' '))),
            "a.obj:4: a line too long; got 10000001 characters; expected at most 10000000");
}

TEST(ObjFileTest, APolygonTakesTimeInProportionToItsCorners) {
  // 300,000 corners, for which a search for ears takes minutes.
  constexpr int kCorners = 300'000;
  TriangleMesh disc;
  std::vector<int> corners(kCorners);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    disc.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    corners[i] = i;
  }
  AddPolygon(corners, disc);
  EXPECT_EQ(disc.triangles.size(), kCorners - 2u);
  EXPECT_NEAR(Area(disc), std::numbers::pi, 1e-6);
}

}  // namespace obj_file_test
}  // namespace oca::geometry::internal
