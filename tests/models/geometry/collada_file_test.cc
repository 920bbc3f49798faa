// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/collada_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <string>

#include "oca/models/error.h"

namespace oca::geometry::internal {
namespace collada_file_test {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

using Triangle = std::array<int, 3>;

constexpr char kTriangles[] =
    "<triangles count='1'><input semantic='NORMAL' source='#n' offset='0'/><input "
    "semantic='VERTEX' source='#v' offset='1'/>\n<p>9 0 9 1 9 2</p></triangles>";

/// A unit square of which `primitives` are the faces, on line 4; behind it `libraries`, and `nodes`
/// in the scene.
std::string Text(const std::string& primitives = kTriangles,
                 const std::string& nodes = "<instance_geometry url='#g'/>",
                 const std::string& libraries = "") {
  return "<COLLADA><library_geometries><geometry id='g'><mesh><source id='p'><float_array id='pa' "
         "count='12'>0 0 0 1 0 0\n1 1 0 0 1 0</float_array><technique_common><accessor "
         "source='#pa' count='4' stride='3'/></technique_common></source>\n<vertices "
         "id='v'><input semantic='POSITION' source='#p'/></vertices>\n" +
         primitives + "</mesh></geometry></library_geometries>\n" + libraries +
         "\n<library_visual_scenes><visual_scene id='s'><node id='n'>" + nodes +
         "</node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url='#s'/></scene></COLLADA>\n";
}

std::string RefusalOf(const std::string& text) {
  try {
    ReadCollada("a.dae", text);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

std::string Primitive(const std::string& kind, const std::string& content) {
  return "<" + kind + "><input semantic='VERTEX' source='#v' offset='0'/>" + content + "</" + kind +
         ">";
}

TEST(ColladaFileTest, ReadsEveryKindOfPrimitive) {
  const auto triangles = [](const std::string& primitives) {
    return ReadCollada("a.dae", Text(primitives)).triangles;
  };
  EXPECT_THAT(triangles(kTriangles), ElementsAre(Triangle{0, 1, 2}));
  const Triangle first{0, 1, 2}, second{0, 2, 3};
  EXPECT_THAT(triangles(Primitive("polylist", "<vcount>4 3 2</vcount><p>0 1 2 3 0 1 2 0 1</p>")),
              ElementsAre(first, second, first));
  EXPECT_THAT(triangles(Primitive("polygons", "<p>0 1 2</p><ph><p>0 1 2 3</p><h>1 2 3</h></ph>")),
              ElementsAre(first, first, second));
  EXPECT_THAT(triangles(Primitive("trifans", "<p>0 1 2 3</p>")), ElementsAre(first, second));
  EXPECT_THAT(triangles(Primitive("tristrips", "<p>0 1 3 2</p><p>0 1 2</p>")),
              ElementsAre(Triangle{0, 1, 3}, Triangle{1, 2, 3}, first));
  EXPECT_TRUE(triangles(Primitive("lines", "<p>0 1</p>")).empty());
}

TEST(ColladaFileTest, TransformsActInTheirOrder) {
  const std::string node =
      "<translate>1 2 3</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale>"
      "<node><matrix>1 0 0 0 0 1 0 0 0 0 1 5 0 0 0 1</matrix><instance_geometry url='#g'/></node>";
  const TriangleMesh mesh = ReadCollada("a.dae", Text(kTriangles, node));
  ASSERT_GE(mesh.vertices.size(), 3u);
  EXPECT_TRUE(mesh.vertices[0].isApprox(Vector3d(1, 2, 8), 1e-12));
  EXPECT_TRUE(mesh.vertices[1].isApprox(Vector3d(1, 4, 8), 1e-12));
  EXPECT_TRUE(mesh.vertices[2].isApprox(Vector3d(0, 4, 8), 1e-12));
  // From 10 m on the x axis to the origin, z up: the frame looks along -z, its y is up.
  const TriangleMesh seen = ReadCollada(
      "a.dae",
      Text(kTriangles, "<lookat>10 0 0 0 0 0 0 0 1</lookat><instance_geometry url='#g'/>"));
  EXPECT_TRUE(seen.vertices[1].isApprox(Vector3d(10, 1, 0), 1e-12));
  EXPECT_TRUE(seen.vertices[2].isApprox(Vector3d(10, 1, 1), 1e-12));
}

TEST(ColladaFileTest, InstancesShowNodesAgainAndSkinsAtRest) {
  const std::string libraries =
      "<library_nodes><node id='twice' name='by name'><instance_geometry url='#g'/>"
      "<instance_geometry url='#g'/></node></library_nodes><library_controllers><controller "
      "id='c'><skin source='#m'/></controller><controller id='m'><morph source='#g'/></controller>"
      "</library_controllers>";
  const auto count = [&](const std::string& node) {
    return ReadCollada("a.dae", Text(kTriangles, node, libraries)).triangles.size();
  };
  EXPECT_EQ(count("<instance_node url='#twice'/><instance_node url='#twice'/>"), 4u);
  EXPECT_EQ(count("<instance_node url='#by name'/>"), 2u);
  EXPECT_EQ(count("<instance_controller url='#c'/>"), 1u);
}

TEST(ColladaFileTest, OfTwoSourcesOfOneIdTheNearerIsMeant) {
  const std::string other =
      "<library_geometries><geometry id='g2'><mesh><source id='p'><float_array id='pa' count='9'>0 "
      "0 7 1 0 7 0 1 7</float_array><technique_common><accessor source='#pa' count='3' "
      "stride='3'/></technique_common></source><vertices id='v'><input semantic='POSITION' "
      "source='#p'/></vertices><triangles><input semantic='VERTEX' source='#v'/><p>0 1 2</p>"
      "</triangles></mesh></geometry></library_geometries>";
  const TriangleMesh mesh =
      ReadCollada("a.dae", Text(kTriangles, "<instance_geometry url='#g2'/>", other));
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0], Vector3d(0, 0, 7));
}

TEST(ColladaFileTest, RefusesNodesThatContainThemselves) {
  EXPECT_EQ(RefusalOf(Text(kTriangles, "<instance_node url='#n'/>")),
            "a.dae:7: <instance_node>; got 'n', which it is within; expected a node that does not "
            "contain itself");
  EXPECT_THAT(RefusalOf(Text(kTriangles, "<node id='a'><instance_node url='#b'/></node>",
                             "<library_nodes><node id='b'><instance_node url='#a'/></node>"
                             "</library_nodes>")),
              HasSubstr("which it is within"));
  EXPECT_THAT(RefusalOf(Text(kTriangles, "<instance_controller url='#c'/>",
                             "<controller id='c'><skin source='#d'/></controller>"
                             "<controller id='d'><skin source='#c'/></controller>")),
              HasSubstr("controllers of controllers; got more; expected at most 8"));
  std::string self = Text();
  self.replace(self.find("source='#p'"), 11, "source='#v'");
  EXPECT_EQ(RefusalOf(self),
            "a.dae:3: <input> source; got #v; expected # and the id of a <source> of this file");
}

/// A node of a library that instances the next one ten times; `levels` of them, the last with
/// `content`.
std::string Levels(int levels, const std::string& content) {
  std::string text = "<library_nodes>";
  for (int i = 0; i < levels; ++i) {
    text += "<node id='k" + std::to_string(i) + "'>";
    for (int k = 0; k < 10; ++k) text += "<instance_node url='#k" + std::to_string(i + 1) + "'/>";
    text += "</node>";
  }
  return text + "<node id='k" + std::to_string(levels) + "'>" + content + "</node></library_nodes>";
}

TEST(ColladaFileTest, CountsWhatInstancesRepeat) {
  const std::string start = "<instance_node url='#k0'/>";
  EXPECT_EQ(RefusalOf(Text(kTriangles, start, Levels(4, ""))), "accepted");
  EXPECT_THAT(RefusalOf(Text(kTriangles, start, Levels(13, ""))),
              HasSubstr("nodes and what their instances repeat; got more; expected at most 20000"));
  std::string many;
  for (int i = 0; i < 1001; ++i) many += "<instance_geometry url='#g'/>";
  EXPECT_THAT(
      RefusalOf(Text(kTriangles, start, Levels(3, many))),
      HasSubstr("triangles with what instances repeat; got more; expected at most 4000000"));
  std::string extras;
  for (int i = 0; i < 20'000; ++i) extras += "<extra/>";
  EXPECT_THAT(RefusalOf(Text(kTriangles, start, Levels(4, extras))),
              HasSubstr("elements and what refers to them; got more"));
}

TEST(ColladaFileTest, NamesTheLineThatIsWrong) {
  const auto of_faces = [](const std::string& kind, const std::string& content) {
    return RefusalOf(Text(Primitive(kind, content)));
  };
  EXPECT_EQ(of_faces("triangles", "\n<p>0 1\n-7</p>"),
            "a.dae:6: <p>; got -7; expected whole numbers from 0 to 3");
  EXPECT_THAT(of_faces("triangles", "<p>0 1 4</p>"), StartsWith("a.dae:4: <p>; got 4"));
  EXPECT_THAT(of_faces("triangles", "<p>0 1</p>"), HasSubstr("got 2 corners; expected 3 for each"));
  EXPECT_THAT(of_faces("polylist", "<vcount>4</vcount><p>0 1 2</p>"),
              HasSubstr("<polylist>; got 3 corners; expected 4, which its <vcount> adds up to"));
  EXPECT_THAT(of_faces("triangles", "<input semantic='NORMAL' offset='1'/><p>0 1 2</p>"),
              HasSubstr("<p>; got 3 numbers; expected 2 for each corner"));
  EXPECT_THAT(of_faces("triangles", "<p>0 1 2</q>"), HasSubstr("got </q>; expected </p>"));
  const auto of_node = [](const std::string& content) {
    return RefusalOf(Text(kTriangles, content));
  };
  EXPECT_EQ(of_node("<matrix>1 0 0 0 0 1 0 0 0 0 1 0</matrix>"),
            "a.dae:7: <matrix>; got 12 numbers; expected 16");
  EXPECT_THAT(of_node("<translate>0 0 inf</translate>"), HasSubstr("got inf"));
  EXPECT_THAT(of_node("<skew>0 0 0 0 0 0 0</skew>"), HasSubstr("transform; got <skew>"));
  EXPECT_THAT(of_node("<instance_geometry url='b.dae#g'/>"), HasSubstr("got b.dae#g; expected #"));
  EXPECT_THAT(of_node("<instance_node url='#none'/>"), HasSubstr("got #none; expected #"));
  EXPECT_THAT(RefusalOf("<COLLADA>"), HasSubstr("ends within <COLLADA>"));
  EXPECT_THAT(RefusalOf("<sdf/>"), HasSubstr("is no Collada; got <sdf>"));
  EXPECT_THAT(RefusalOf("<COLLADA/>"), HasSubstr("shows nothing"));
  EXPECT_THAT(RefusalOf("<COLLADA><asset><unit meter='0'/></asset></COLLADA>"),
              HasSubstr("<unit> meter; got 0; expected a number above 0"));
}

}  // namespace collada_file_test
}  // namespace oca::geometry::internal
