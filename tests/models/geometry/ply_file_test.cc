// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/ply_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/geometry/mesh_surface.h"
#include "tests/temporary_folder.h"

namespace oca::geometry::internal {
namespace ply_file_test {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;

/// Appends numbers as they stand in a binary file of either byte order.
template <class T>
void Append(bool big, const std::vector<T>& values, std::string& bytes) {
  for (const T value : values) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big) std::reverse(raw, raw + sizeof(T));  // the tests' machines are little-endian
    bytes.append(raw, sizeof(T));
  }
}

/// A pyramid of 1 m about the origin's corner: its base a quadrangle, its sides triangles; with
/// what else scanners write before, between and behind.
std::string Head(const std::string& format) {
  return "ply\r\nformat " + format +
         " 1.0\r\ncomment by hand\r\nobj_info none\r\nelement material 1\r\nproperty list uchar "
         "short shades\r\nelement vertex 5\r\nproperty float x\r\nproperty uchar red\r\nproperty "
         "double y\r\nproperty int z\r\nelement face 6\r\nproperty uchar flags\r\nproperty list "
         "ushort uint vertex_indices\r\nelement edge 1\r\nproperty int a\r\nend_header\r\n";
}

std::string Text() {
  return Head("ascii") +
         "2 -1 -2\n0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0\n0 9 0 1\n0 4 3 2 1 0\n0 3 0 1 4\n0 3 1 2 "
         "4\n0 3 2 3 4\n0 3 3 0 4\n7 2 0 1\n5\n";
}

std::string Binary(bool big) {
  std::string bytes = Head(big ? "binary_big_endian" : "binary_little_endian");
  bytes += '\x02';
  Append<std::int16_t>(big, {-1, -2}, bytes);
  for (const auto& [x, y, z] : {std::array{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}}) {
    Append<float>(big, {static_cast<float>(x)}, bytes);
    bytes += '\x09';
    Append<double>(big, {static_cast<double>(y)}, bytes);
    Append<std::int32_t>(big, {z}, bytes);
  }
  const std::vector<std::vector<std::uint32_t>> faces{{3, 2, 1, 0}, {0, 1, 4}, {1, 2, 4},
                                                      {2, 3, 4},    {3, 0, 4}, {0, 1}};
  for (const std::vector<std::uint32_t>& face : faces) {
    bytes += '\x07';
    Append<std::uint16_t>(big, {static_cast<std::uint16_t>(face.size())}, bytes);
    Append<std::uint32_t>(big, face, bytes);
  }
  Append<std::int32_t>(big, {5}, bytes);
  return bytes;
}

std::string RefusalOf(const std::string& text, PlyPart part = PlyPart::kMesh) {
  try {
    ReadPly("a.ply", text, part);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PlyFileTest, ReadsTextAndBothByteOrdersAlike) {
  for (const std::string& bytes : {Text(), Binary(false), Binary(true)}) {
    const TriangleMesh mesh = ReadPly("a.ply", bytes, PlyPart::kMesh);
    EXPECT_THAT(mesh.vertices, ElementsAre(Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0),
                                           Vector3d(0, 1, 0), Vector3d(0, 0, 1)));
    EXPECT_THAT(mesh.triangles,
                ElementsAre(std::array{3, 2, 1}, std::array{3, 1, 0}, std::array{0, 1, 4},
                            std::array{1, 2, 4}, std::array{2, 3, 4}, std::array{3, 0, 4}));
    EXPECT_NEAR(EnclosedVolume(mesh).value_or(0.0), 1.0 / 3.0, 1e-12);
    const TriangleMesh points = ReadPly("a.ply", bytes, PlyPart::kVertices);
    EXPECT_EQ(points.vertices, mesh.vertices);
    EXPECT_TRUE(points.triangles.empty());
  }
}

TEST(PlyFileTest, IsAMeshFileLikeAnyOther) {
  const test::TemporaryFolder folder;
  const auto file = folder.Write("Part.PLY", Binary(true));
  const TriangleMesh mesh = LoadMesh(file, Vector3d(-2, 1, 1));
  EXPECT_NEAR(EnclosedVolume(mesh).value_or(0.0), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(LoadMeshHull(file).hull->volume, 1.0 / 3.0, 1e-12);
  double signed_volume = 0.0;  // of a mirrored surface that kept its outside
  for (const auto& [a, b, c] : mesh.triangles) {
    signed_volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  }
  EXPECT_GT(signed_volume, 0.0);
}

TEST(PlyFileTest, FacesMayComeBeforeTheirVertices) {
  const TriangleMesh mesh = ReadPly("a.ply",
                                    "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar "
                                    "int vertex_index\nelement vertex 3\nproperty float x\n"
                                    "property float y\nproperty float z\nend_header\n3 0 1 2\n"
                                    "0 0 0\n1 0 0\n0 1 0\n",
                                    PlyPart::kMesh);
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_THAT(mesh.triangles, ElementsAre(std::array{0, 1, 2}));
}

TEST(PlyFileTest, RefusesHeadersThatAreNoneSayingWhere) {
  const std::string start = "ply\nformat ascii 1.0\n";
  EXPECT_THAT(RefusalOf("plx\n"), HasSubstr("a.ply:1: is no PLY file"));
  EXPECT_THAT(RefusalOf("ply\nformat ascii"), HasSubstr("a.ply:2: ends in its header"));
  EXPECT_THAT(RefusalOf("ply\nformat text 1.0\n"), HasSubstr("a.ply:2: format; got text"));
  EXPECT_THAT(RefusalOf(start + "property float x\n"), HasSubstr("a.ply:3: property; got 3 words"));
  EXPECT_THAT(RefusalOf(start + "element vertex -1\n"),
              HasSubstr("a.ply:3: number of elements; got -1"));
  EXPECT_THAT(RefusalOf(start + "element vertex 10000001\n"),
              HasSubstr("number of elements; got 10000001; expected 0 to 10000000"));
  EXPECT_THAT(RefusalOf(start + "element vertex\n"), HasSubstr("number of elements; got none"));
  const std::string element = start + "element vertex 1\n";
  EXPECT_THAT(RefusalOf(element + "property real x\n"), HasSubstr("a.ply:4: type of a property"));
  EXPECT_THAT(RefusalOf(element + "property list float int a\n"),
              HasSubstr("type of a list's count; got float"));
  EXPECT_THAT(RefusalOf(element + "property float x\nproperty float x\n"),
              HasSubstr("a.ply:5: properties; got x; expected each name once"));
  EXPECT_THAT(RefusalOf(element + "property float x\nend_header\n1\n", PlyPart::kVertices),
              HasSubstr("has no coordinates"));
  EXPECT_THAT(RefusalOf(start + "element vertex 0\nelement vertex 0\nend_header\n"),
              HasSubstr("elements; got vertex; expected each name once"));
  EXPECT_THAT(RefusalOf(start + "element face 0\nend_header\n"), HasSubstr("no element vertex"));
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(RefusalOf(start + "element vertex 0\n" + xyz + "end_header\n"),
              HasSubstr("is no mesh; got no element face"));
  EXPECT_THAT(RefusalOf(start + "element vertex 0\n" + xyz +
                        "element face 0\nproperty int vertex_indices\nend_header\n"),
              HasSubstr("has no corners of faces"));
}

TEST(PlyFileTest, RefusesBodiesThatDoNotFitTheirHeaderSayingWhere) {
  const auto with = [](std::string bytes, const std::string& from, const std::string& to) {
    const std::size_t at = bytes.rfind(from);
    EXPECT_NE(at, std::string::npos);
    return bytes.replace(at, from.size(), to);
  };
  EXPECT_THAT(RefusalOf(with(Text(), "0 3 2 3 4", "0 3 2 5 4")),
              HasSubstr("face 3: vertex; got 5; expected one of the 5, from 0 on"));
  EXPECT_THAT(RefusalOf(with(Text(), "0 3 2 3 4", "0 3 2 -1 4")), HasSubstr("vertex; got -1"));
  EXPECT_THAT(RefusalOf(with(Text(), "0 3 2 3 4", "0 3 2 1.5 4")), HasSubstr("vertex; got 1.5"));
  EXPECT_THAT(RefusalOf(with(Text(), "0 3 2 3 4", "0 3 2 3")),
              HasSubstr("face 3: wrong length; got 4 values; expected more"));
  EXPECT_THAT(RefusalOf(with(Text(), "0 3 2 3 4", "0 3 2 3 4 4")),
              HasSubstr("face 3: wrong length; got 6 values; expected 5"));
  EXPECT_THAT(RefusalOf(with(Text(), "0 9 1 0", "0 9 a 0")),
              HasSubstr("a.ply:22: vertex 3: no number; got a"));
  EXPECT_THAT(RefusalOf(with(Text(), "0 3 2 3 4", "0 -3 2 3 4")), HasSubstr("length of a list"));
  const std::string binary = Binary(false);
  const std::size_t body = Head("binary_little_endian").size();
  for (std::size_t size = body; size < binary.size(); ++size) {
    ASSERT_THAT(RefusalOf(binary.substr(0, size)), HasSubstr("ends too early; got ")) << size;
  }
  std::string wrong = binary;
  wrong[wrong.size() - 5] = '\x7f';  // the last corner
  EXPECT_THAT(RefusalOf(wrong), HasSubstr("behind the header: face 5: vertex; got 2130706433"));
}

// What a header announces takes no memory before it is there.
TEST(PlyFileTest, BelievesNoHeader) {
  EXPECT_THAT(RefusalOf("ply\nformat binary_little_endian 1.0\nelement vertex 10000000\nproperty "
                        "char x\nproperty char y\nproperty char z\nelement face 10000000\nproperty "
                        "list uint int vertex_indices\nend_header\nab"),
              HasSubstr("ends too early; got 0 of element vertex; expected 10000000"));
  EXPECT_THAT(RefusalOf("ply\nformat ascii 1.0\nelement nothing 10000000\nelement vertex 1\n"
                        "property char x\nproperty char y\nproperty char z\nend_header\n1 2 3\n",
                        PlyPart::kVertices),
              "accepted");
}

}  // namespace ply_file_test
}  // namespace oca::geometry::internal
