// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "oca/models/error.h"
#include "oca/models/geometry/mesh_surface.h"
#include "tests/models/geometry/mesh_files.h"
#include "tests/temporary_folder.h"

namespace oca::geometry {
namespace mesh_test {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

// By the divergence theorem; negative if the triangles face inwards.
double Volume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  }
  return volume;
}

Vector3d High(const TriangleMesh& mesh) {
  Vector3d high = mesh.vertices.at(0);
  for (const Vector3d& p : mesh.vertices) high = high.cwiseMax(p);
  return high;
}

Vector3d Low(const TriangleMesh& mesh) {
  Vector3d low = mesh.vertices.at(0);
  for (const Vector3d& p : mesh.vertices) low = low.cwiseMin(p);
  return low;
}

void ExpectTetrahedron(const TriangleMesh& mesh, const Vector3d& high) {
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_TRUE(High(mesh).isApprox(high, 1e-6)) << High(mesh).transpose();
  EXPECT_TRUE(Low(mesh).isZero(1e-6)) << Low(mesh).transpose();
  EXPECT_NEAR(Volume(mesh), high.prod() / 6.0, 1e-6 * high.prod());
}

std::string RefusalOf(const std::filesystem::path& file, const Vector3d& scale = Vector3d::Ones()) {
  try {
    LoadMeshHull(file, scale);
  } catch (const models::ModelError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(file.string() + ":"), HasSubstr("; got "),
                                    HasSubstr("; expected ")));
    return error.what();
  }
  return "accepted";
}

TEST(MeshTest, TextAndBinaryStlAndObjAreTheSameBody) {
  const test::TemporaryFolder folder;
  const Vector3d high(1, 2, 3);
  ExpectTetrahedron(LoadMesh(folder.Write("a.stl", TextStl(Tetrahedron()))), high);
  ExpectTetrahedron(LoadMesh(folder.Write("b.stl", BinaryStl(Tetrahedron()))), high);
  ExpectTetrahedron(LoadMesh(folder.Write("c.obj", TextObj())), high);
  ExpectTetrahedron(LoadMesh(folder.Write("D.STL", BinaryStl(Tetrahedron()))), high);
}

TEST(MeshTest, BinaryStlMayBeginWithSolid) {
  const test::TemporaryFolder folder;
  ExpectTetrahedron(LoadMesh(folder.Write("a.stl", BinaryStl(Tetrahedron(), "solid part"))),
                    Vector3d(1, 2, 3));
}

TEST(MeshTest, PolygonsOfAnObjAreCutIntoTriangles) {
  const test::TemporaryFolder folder;
  const auto mesh = LoadMesh(
      folder.Write("box.obj",
                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                   "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"));
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(Volume(mesh), 1.0, 1e-6);
}

TEST(MeshTest, ColladaUnitIsAppliedAndUpAxisIsNot) {
  const test::TemporaryFolder folder;
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    ExpectTetrahedron(LoadMesh(folder.Write("m.dae", Collada("1", up, ""))), Vector3d(1, 2, 3));
    ExpectTetrahedron(LoadMesh(folder.Write("mm.dae", Collada("0.001", up, ""))),
                      Vector3d(1e-3, 2e-3, 3e-3));
  }
}

TEST(MeshTest, StlCountThatOverflowsIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* head : {"binary", "solid"}) {
    std::string bytes = BinaryStl(Tetrahedron(), head);
    bytes[83] = '\x80';  // 2^31 triangles more, 25 * 2^32 bytes
    try {
      LoadMesh(folder.Write("many.stl", bytes));
      ADD_FAILURE() << head;
    } catch (const models::ModelError& error) {
      EXPECT_NE(std::string(error.what())
                    .find("ends too early; got 284 bytes; expected "
                          "107374182684 for its 2147483652 triangles"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(MeshTest, ColladaNodeTransformsAreApplied) {
  const test::TemporaryFolder folder;
  const auto moved =
      LoadMesh(folder.Write("t.dae", Collada("0.5", "Z_UP", "<translate>10 20 30</translate>")));
  EXPECT_TRUE(Low(moved).isApprox(Vector3d(5, 10, 15), 1e-6)) << Low(moved).transpose();
  const auto mirrored =
      LoadMesh(folder.Write("s.dae", Collada("1", "Z_UP", "<scale>-1 1 1</scale>")));
  EXPECT_NEAR(Low(mirrored).x(), -1.0, 1e-6);
  EXPECT_NEAR(Volume(mirrored), 1.0, 1e-6);
}

TEST(MeshTest, ScaleStretchesEachAxisAndAMirrorKeepsTheOutside) {
  const test::TemporaryFolder folder;
  const auto file = folder.Write("a.stl", BinaryStl(Tetrahedron()));
  ExpectTetrahedron(LoadMesh(file, Vector3d(2, 1, 0.5)), Vector3d(2, 2, 1.5));
  for (const Vector3d& scale : {Vector3d(-1, 1, 1), Vector3d(-1, -1, 1), Vector3d(-1, -1, -1)}) {
    EXPECT_NEAR(Volume(LoadMesh(file, scale)), 1.0, 1e-6);
    EXPECT_NEAR(LoadMeshHull(file, scale).hull->volume, 1.0, 1e-6);
  }
}

TEST(MeshTest, HullIsNamedAfterTheFileAndContainsTheMesh) {
  const test::TemporaryFolder folder;
  const auto file = folder.Write("a.stl", BinaryStl(Tetrahedron()));
  const auto hull = LoadMeshHull(file).hull;
  EXPECT_EQ(hull->name, file.string());
  EXPECT_EQ(hull->vertices.size(), 4u);
}

TEST(MeshTest, VerticesThatNoTriangleUsesAreLeftOut) {
  const test::TemporaryFolder folder;
  const auto mesh = LoadMesh(folder.Write("a.obj",
                                          "v 99 99 99\nv 0 0 0\nv 1 0 0\nv 0 2 0\n"
                                          "v 0 0 3\nf 2 4 3\nf 2 3 5\nf 2 5 4\nf 3 4 5\n"));
  ExpectTetrahedron(mesh, Vector3d(1, 2, 3));
}

TEST(MeshTest, RefusesAFileThatIsMissingEmptyOrAFolder) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(RefusalOf(folder.path() / "no.stl"), HasSubstr("cannot be read; got no such file"));
  EXPECT_THAT(RefusalOf(folder.Write("e.stl", "")), HasSubstr("got 0 bytes"));
  std::filesystem::create_directory(folder.path() / "d.stl");
  EXPECT_THAT(RefusalOf(folder.path() / "d.stl"), HasSubstr("not a regular file"));
}

TEST(MeshTest, RefusesAnUnknownExtension) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(RefusalOf(folder.Write("a.3ds", "x")), HasSubstr("got extension '.3ds'"));
  EXPECT_THAT(RefusalOf(folder.Write("a", "x")), HasSubstr("expected .stl, .obj, .dae, .ply"));
}

TEST(MeshTest, RefusesAFileAboveAHundredMegabytes) {
  const test::TemporaryFolder folder;
  const auto file = folder.Write("big.stl", "solid");
  std::filesystem::resize_file(file, 100'000'001);
  EXPECT_THAT(RefusalOf(file),
              HasSubstr("too large; got 100000001 bytes; expected at most 100000000"));
}

TEST(MeshTest, RefusesBinaryJunkOfEveryKind) {
  const test::TemporaryFolder folder;
  std::mt19937 random(5);
  for (const char* extension : {".stl", ".obj", ".dae"}) {
    for (const int size : {1, 3, 83, 84, 134, 5'000, 300'000}) {
      std::string junk(size, ' ');
      for (char& c : junk) c = static_cast<char>(random());
      EXPECT_NE(RefusalOf(folder.Write(std::string("junk") + extension, junk)), "accepted")
          << extension << " of " << size << " bytes";
    }
  }
}

TEST(MeshTest, RefusesTruncatedFiles) {
  const test::TemporaryFolder folder;
  const std::string stl = BinaryStl(Tetrahedron());
  const std::string dae = Collada("1", "Z_UP", "");
  for (const double part : {0.2, 0.5, 0.7}) {
    EXPECT_NE(RefusalOf(folder.Write("t.stl", stl.substr(0, part * stl.size()))), "accepted");
    EXPECT_NE(RefusalOf(folder.Write("t.dae", dae.substr(0, part * dae.size()))), "accepted");
  }
}

TEST(MeshTest, RefusesAMeshWithoutTriangles) {
  const test::TemporaryFolder folder;
  EXPECT_NE(RefusalOf(folder.Write("p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n")), "accepted");
  EXPECT_NE(RefusalOf(folder.Write("t.stl", "solid part\nendsolid part\n")), "accepted");
  EXPECT_NE(RefusalOf(folder.Write("b.stl", BinaryStl({}))), "accepted");
}

TEST(MeshTest, RefusesFacesWithoutTheirVertices) {
  const test::TemporaryFolder folder;
  EXPECT_NE(RefusalOf(folder.Write("f.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999999\n")),
            "accepted");
}

TEST(MeshTest, TakesAFlatMeshAndRefusesAPoint) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(RefusalOf(folder.Write("one.stl", BinaryStl({Tetrahedron()[0]}))), "accepted");
  EXPECT_THAT(RefusalOf(folder.Write("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n")),
              HasSubstr("point.obj: too few points for a convex hull"));
}

TEST(MeshTest, RefusesVerticesThatAreNotFinite) {
  const test::TemporaryFolder folder;
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    auto triangles = Tetrahedron();
    triangles[2][1][1] = bad;
    EXPECT_NE(RefusalOf(folder.Write("nan.stl", BinaryStl(triangles))), "accepted");
  }
}

TEST(MeshTest, RefusesAScaleOfZeroOrNaN) {
  const test::TemporaryFolder folder;
  const auto file = folder.Write("a.stl", BinaryStl(Tetrahedron()));
  for (const double bad : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(RefusalOf(file, Vector3d(1, bad, 1)), HasSubstr("scale; got (1, "));
  }
}

TEST(MeshTest, RefusesAColladaOfNothingButOpeningTags) {
  const test::TemporaryFolder folder;
  std::string bomb = "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\">";
  for (int i = 0; i < 1'000'000; ++i) bomb += "<node>";
  EXPECT_THAT(RefusalOf(folder.Write("bomb.dae", bomb)), HasSubstr("nested too deep"));
}

/// A triangle of `count` numbers in its array, of which an accessor reads `points` points.
std::string Collada(const std::string& count, const std::string& points) {
  return "<COLLADA version=\"1.4.1\"><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
         "<!-- <float_array id='pa' count='99'> --><float_array id=\"pa\"" +
         count +
         ">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source=\"#pa\" count=\"" +
         points +
         "\" stride='3'><param name='X' type='float'/><param name='Y' type='float'/><param "
         "name='Z' "
         "type='float'/></accessor></technique_common></source><vertices id='v'><input "
         "semantic='POSITION' source='#p'/></vertices><triangles count='1'><input "
         "semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry>"
         "</library_geometries><library_visual_scenes><visual_scene id='s'><node id='n'>"
         "<instance_geometry url='#g'/></node></visual_scene></library_visual_scenes><scene>"
         "<instance_visual_scene url='#s'/></scene></COLLADA>";
}

TEST(MeshTest, ReadsNoMoreNumbersOfAColladaArrayThanItHas) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(LoadMesh(folder.Write("a.dae", Collada(" count=\"9\"", "3"))).triangles.size(), 1u);
  const auto refusal = [&](const std::string& count, const std::string& points) {
    return RefusalOf(folder.Write("b.dae", Collada(count, points)));
  };
  EXPECT_THAT(refusal(" count=\"9\"", "4"),
              HasSubstr("accessor of 'pa'; got an array of 9 numbers; expected 12"));
  EXPECT_THAT(refusal("", "3"), HasSubstr("got an array of 0 numbers; expected 9"));
  std::string endless = Collada(" count=\"9\"", "3");
  endless.replace(endless.find("0 1 2</p>"), 1, "0\xFF");
  EXPECT_THAT(RefusalOf(folder.Write("c.dae", endless)),
              HasSubstr("<p>; got 0?; expected whole numbers from 0 to 2"));
  endless.replace(endless.find("0\xFF"), 2, "<![CDATA[x]]>");
  EXPECT_THAT(RefusalOf(folder.Write("c.dae", endless)),
              HasSubstr("<p>; got another tag among its numbers"));
  EXPECT_THAT(refusal(" count=\"9\"", "4294967295"), HasSubstr("expected 12884901885"));
  EXPECT_THAT(refusal(" count=\"-9\"", "3"), HasSubstr("count; got -9; expected a whole number"));
}

}  // namespace mesh_test
}  // namespace oca::geometry
