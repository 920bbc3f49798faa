// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/stl_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <string>

#include "oca/models/error.h"
#include "tests/models/geometry/mesh_files.h"

namespace oca::geometry::internal {
namespace stl_file_test {

using Eigen::Vector3d;
using testing::HasSubstr;
using testing::StartsWith;

std::string RefusalOf(const std::string& bytes) {
  try {
    ReadStl("a.stl", bytes);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

constexpr char kFacet[] =
    "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 .5\nvertex 1.5e0 0 0\nvertex 0 +2 0\n"
    "endloop\nendfacet\nendsolid a b\n";

void ExpectFacet(const std::string& text) {
  const TriangleMesh mesh = ReadStl("a.stl", text);
  ASSERT_EQ(mesh.triangles.size(), 1u) << text;
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][0]], Vector3d(0, 0, 0.5)) << text;
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][1]], Vector3d(1.5, 0, 0)) << text;
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][2]], Vector3d(0, 2, 0)) << text;
}

std::string Replaced(std::string text, const std::string& old, const std::string& by) {
  return text.replace(text.find(old), old.size(), by);
}

TEST(StlFileTest, ReadsTextAsProgramsWriteIt) {
  const std::string text = kFacet;
  ExpectFacet(text);
  ExpectFacet("\xEF\xBB\xBF" + text);
  ExpectFacet("\r\n \n" + text);
  ExpectFacet(Replaced(text, "solid a b", "solid"));
  ExpectFacet(Replaced(text, "normal 0 0 1", "normal nan -nan(ind) 0"));
  std::string capitals = text, windows;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  ExpectFacet(capitals);
  for (const char c : text) windows += c == '\n' ? std::string("\r\n\t ") : std::string(1, c);
  ExpectFacet(windows);
  EXPECT_EQ(ReadStl("a.stl", text + text).triangles.size(), 2u);
}

TEST(StlFileTest, NamesTheLineOfTextThatIsWrong) {
  const std::string text = kFacet;
  EXPECT_EQ(RefusalOf(Replaced(text, "1.5e0", "1,5")),
            "a.stl:5: text STL; got 1,5; expected a coordinate, a finite number");
  EXPECT_THAT(RefusalOf(Replaced(text, "1.5e0", "nan")), StartsWith("a.stl:5: text STL; got nan"));
  EXPECT_THAT(RefusalOf(Replaced(text, "1.5e0", "1e999")), HasSubstr("got 1e999"));
  EXPECT_EQ(RefusalOf(Replaced(text, "vertex 0 +2 0\n", "")),
            "a.stl:6: text STL; got endloop; expected vertex");
  EXPECT_EQ(RefusalOf(Replaced(text, "endloop", "vertex 0 0 0")),
            "a.stl:7: text STL; got vertex; expected endloop");
  EXPECT_EQ(RefusalOf(Replaced(text, " 0\nendloop", "\nendloop")),
            "a.stl:7: text STL; got endloop; expected a coordinate, a finite number");
  EXPECT_EQ(RefusalOf(Replaced(text, "endsolid a b\n", "")),
            "a.stl:9: text STL; got its end; expected facet or endsolid");
  EXPECT_EQ(RefusalOf(text + "more"), "a.stl:10: text STL; got more; expected solid");
}

TEST(StlFileTest, EveryBeginningOfATextIsRefused) {
  const std::string text = kFacet;
  for (std::size_t size = 0; size < text.find("endsolid") + 8; ++size) {
    EXPECT_NE(RefusalOf(text.substr(0, size)), "accepted") << size;
  }
}

TEST(StlFileTest, BinaryFilesMayEndWithLessThanATriangleMore) {
  const std::string bytes = BinaryStl(Tetrahedron());
  EXPECT_EQ(ReadStl("a.stl", bytes + std::string(49, '\1')).triangles.size(), 4u);
  EXPECT_EQ(RefusalOf(bytes + std::string(50, '\1')),
            "a.stl: binary STL goes on behind its triangles; got 334 bytes; expected 284 for its 4 "
            "triangles");
  EXPECT_THAT(RefusalOf(bytes.substr(0, 283)), HasSubstr("ends too early; got 283 bytes"));
  EXPECT_THAT(RefusalOf(bytes.substr(0, 83)), HasSubstr("is neither text nor binary STL"));
  EXPECT_EQ(ReadStl("a.stl", BinaryStl(Tetrahedron(), "solid") + "xyz").triangles.size(), 4u);
}

}  // namespace stl_file_test
}  // namespace oca::geometry::internal
