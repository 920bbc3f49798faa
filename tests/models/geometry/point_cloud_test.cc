// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/point_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "oca/models/error.h"
#include "tests/models/geometry/random_bodies.h"
#include "tests/temporary_folder.h"

namespace oca::geometry {
namespace point_cloud_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class PointCloudTest : public ::testing::Test {
 protected:
  std::filesystem::path File(const std::string& name, const std::string& content) {
    return folder_.Write(name, content);
  }
  std::vector<Vector3d> Points(const std::string& name, const std::string& content) {
    return LoadPointCloud(File(name, content));
  }
  std::string Refusal(const std::string& name, const std::string& content) {
    try {
      LoadPointCloud(File(name, content));
    } catch (const models::ModelError& error) {
      return error.what();
    }
    return "accepted";
  }
  std::string MapRefusal(const std::string& name, const std::string& content, double cell = 1.0) {
    try {
      LoadHeightmap(File(name, content), cell, 1.0);
    } catch (const models::ModelError& error) {
      return error.what();
    }
    return "accepted";
  }
  test::TemporaryFolder folder_;
};

template <class T>
std::string Bytes(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  return bytes;
}

const Vector3d kFirst(1.0, 2.0, 3.0), kSecond(-0.5, 0.25, 1e-3);

TEST_F(PointCloudTest, ReadsTablesWithNamesCommentsAndMoreColumns) {
  EXPECT_THAT(Points("a.csv", "x,y,z,intensity\n1,2,3,9\r\n# seen\n\n-0.5,0.25,1e-3,7\n"),
              ElementsAre(kFirst, kSecond));
  EXPECT_THAT(Points("A.XYZ", "1 2 3\n-0.5\t+0.25 0.001"), ElementsAre(kFirst, kSecond));
}

TEST_F(PointCloudTest, ReadsPly) {
  const std::string head =
      "element vertex 2\nproperty float x\nproperty uchar red\nproperty float y\nproperty double "
      "z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_THAT(Points("a.ply", "ply\nformat ascii 1.0\ncomment c\n" + head +
                                  "1 255 2 3\n-0.5 0 0.25 0.001\n"),
              ElementsAre(kFirst, kSecond));
  const std::string body = Bytes<float>({1.0f}) + '\xff' + Bytes<float>({2.0f}) +
                           Bytes<double>({3.0}) + Bytes<float>({-0.5f}) + '\x00' +
                           Bytes<float>({0.25f}) + Bytes<double>({1e-3});
  EXPECT_THAT(Points("b.ply", "ply\nformat binary_little_endian 1.0\n" + head + body),
              ElementsAre(kFirst, kSecond));
}

TEST_F(PointCloudTest, ReadsPcdAndLeavesOutWhatTheCameraDidNotSee) {
  const std::string head =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 3\n"
      "WIDTH 3\nHEIGHT 1\nPOINTS 3\n";
  EXPECT_THAT(Points("a.pcd", head + "DATA ascii\n1 2 3 0 0 0\nnan nan nan 0 0 0\n0 0 0 1 2 3\n"),
              ElementsAre(kFirst, Vector3d::Zero()));
  const std::string body = Bytes<float>({1.0f, 2.0f, 3.0f}) + "rgb" +
                           Bytes<float>({0.0f, 0.0f, std::numeric_limits<float>::infinity()}) +
                           "rgb" + Bytes<float>({0.0f, 0.0f, 0.0f}) + "rgb";
  EXPECT_THAT(Points("b.pcd", head + "DATA binary\n" + body),
              ElementsAre(kFirst, Vector3d::Zero()));
}

TEST_F(PointCloudTest, RefusesPcdWhosePointsAreNotAsManyAsItSays) {
  const std::string fields = "FIELDS x y z\nSIZE 1 1 1\nTYPE I I I\n";
  EXPECT_THAT(
      Refusal("a.pcd",
              fields + "WIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA binary\n" + std::string(15, '\1')),
      HasSubstr("a.pcd:7: number of points; got 5; expected WIDTH times HEIGHT, 3 times 2"));
  const std::string head = fields + "POINTS 2\nDATA ";
  EXPECT_EQ(Points("a.pcd", head + "binary\n123456\r\n").size(), 2u);
  EXPECT_THAT(Refusal("a.pcd", head + "binary\n123456789"),
              HasSubstr("goes on behind its points; got more points; expected 2"));
  EXPECT_EQ(Points("a.pcd", head + "ascii\n1 2 3\n4 5 6\n\n").size(), 2u);
  EXPECT_THAT(Refusal("a.pcd", head + "ascii\n1 2 3\n4 5 6\n7 8 9\n"),
              HasSubstr("goes on behind its points"));
}

TEST_F(PointCloudTest, RefusesPlyThatEndsWithinWhatIsNoPoint) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n3 0 0 0\n";
  EXPECT_THAT(Refusal("a.ply", text), HasSubstr("ends too early; got 1 of element face"));
  EXPECT_EQ(Points("a.ply", text + "3 0 0 0\n").size(), 1u);
}

std::string CompressedPcd(const std::string& packed, std::uint32_t size) {
  return "FIELDS x rgb _ z y\nSIZE 4 1 1 4 4\nTYPE F U U F F\nCOUNT 1 3 8 1 1\nPOINTS 3\nDATA "
         "binary_compressed\n" +
         Bytes<std::uint32_t>({static_cast<std::uint32_t>(packed.size()), size}) + packed;
}

/// One field after the other, each of all points; padding is left out.
TEST_F(PointCloudTest, ReadsCompressedPcd) {
  const std::string fields = Bytes<float>({1.0f, NAN, -0.5f}) + "rgbrgbrgb" +
                             Bytes<float>({3.0f, 0.0f, 0.125f}) + Bytes<float>({2.0f, 0.0f, 0.25f});
  std::string plain;  // as they are, at most 32 bytes at once
  for (std::size_t at = 0; at < fields.size(); at += 32) {
    const std::string piece = fields.substr(at, 32);
    plain += static_cast<char>(piece.size() - 1) + piece;
  }
  // "rgb" once, and again twice as one repetition of 6 bytes from 3 back.
  const std::string shorter =
      '\x0e' + fields.substr(0, 15) + '\x80' + '\x02' + '\x17' + fields.substr(21);
  for (const std::string& packed : {plain, shorter}) {
    EXPECT_THAT(Points("a.pcd", CompressedPcd(packed, 45)),
                ElementsAre(kFirst, Vector3d(-0.5, 0.25, 0.125)));
    EXPECT_THAT(Refusal("a.pcd", CompressedPcd(packed, 46)),
                HasSubstr("size of the points; got 46 bytes; expected 45 for 3 points of 15"));
    const std::string whole = CompressedPcd(packed, 45);
    EXPECT_THAT(Refusal("a.pcd", whole.substr(0, whole.size() - 1)), HasSubstr("ends too early"));
    EXPECT_THAT(Refusal("a.pcd", CompressedPcd(packed.substr(1), 45)), HasSubstr("damaged data"));
  }
  EXPECT_THAT(Refusal("a.pcd", CompressedPcd("", 45).substr(0, 102)), HasSubstr("ends too early"));
}

TEST_F(PointCloudTest, HoldsAMillionPointsAndNoMore) {
  const auto cloud = [](std::size_t count) {
    return "FIELDS x y z\nSIZE 1 1 1\nTYPE I I I\nPOINTS " + std::to_string(count) +
           "\nDATA binary\n" + std::string(3 * count, '\x01');
  };
  EXPECT_EQ(Points("a.pcd", cloud(kMostCloudPoints)).size(), kMostCloudPoints);
  EXPECT_THAT(Refusal("a.pcd", cloud(kMostCloudPoints + 1)),
              HasSubstr("a.pcd: points; got 1000001; expected at most 1000000"));
}

TEST_F(PointCloudTest, ReadsTablesByTheirNamesAndMarks) {
  EXPECT_THAT(Points("a.csv",
                     "\xEF\xBB\xBF"
                     "1,2,3\n-0.5,0.25,1e-3\n"),
              ElementsAre(kFirst, kSecond));
  EXPECT_THAT(Points("a.csv", "id,z,y,x\n7,3,2,1\n8,nan,0,0\n"), ElementsAre(kFirst));
  EXPECT_THAT(Refusal("a.csv", "2,0,x\n1,2,3\n"), HasSubstr("a.csv:1: column 3: not a number"));
  EXPECT_THAT(Refusal("a.csv", "2,5;0,1;0,3\n"), HasSubstr("with a decimal point"));
  EXPECT_THAT(Refusal("a.csv", "id,x,y\n1,2,3\n"), HasSubstr("a.csv:1: names of columns: no 'z'"));
}

TEST_F(PointCloudTest, RefusesHeadersWhoseNumbersDoNotFit) {
  const auto pcd = [this](const std::string& fields, const std::string& sizes,
                          const std::string& types, const std::string& counts) {
    return Refusal("a.pcd", "FIELDS x y z" + fields + "\nSIZE 4 4 4" + sizes + "\nTYPE F F F" +
                                types + "\nCOUNT 1 1 1" + counts + "\nPOINTS 1\nDATA binary\n" +
                                std::string(12, '\0'));
  };
  EXPECT_EQ(pcd("", "", "", ""), "accepted");
  // 2^32 bytes and those of x, y and z before: a record of 12 bytes in 32 bits.
  std::string fields, sizes, types, counts;
  for (int i = 0; i < 53'688; ++i) {
    fields += " a";
    sizes += " 8";
    types += " U";
    counts += " 10000";
  }
  EXPECT_THAT(pcd(fields, sizes, types, counts), HasSubstr("record of a point; got more than"));
  EXPECT_THAT(pcd(" a", " 8", " U", " 18446744073709551615"), HasSubstr("field 'a'"));
  EXPECT_THAT(pcd(" a", " 8", " U", " 1.5"), HasSubstr("field 'a'"));
  EXPECT_THAT(pcd(" x", " 4", " F", " 1"), HasSubstr("each coordinate once"));
  EXPECT_THAT(Refusal("a.pcd", "FIELDS x y z\nSIZES 4 4 4\nDATA ascii\n"),
              HasSubstr("a.pcd:2: header; got SIZES"));
  EXPECT_THAT(Refusal("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\npropery float x\n"),
              HasSubstr("a.ply:4: header; got propery"));
  EXPECT_THAT(Refusal("a.pcd", "FIELDS x y z\nPOINTS 18446744073709551616\n"),
              HasSubstr("a.pcd:2: number of points; got 18446744073709551616"));
}

TEST_F(PointCloudTest, RefusesRowsOfTextThatDoNotFitTheirHeader) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n";
  EXPECT_THAT(Refusal("a.pcd", head + "2,5 0,1 0,3\n"), HasSubstr("no point; got 2,5"));
  EXPECT_THAT(Refusal("a.pcd", head + "1 2 3 4\n"), HasSubstr("no point; got 4 values"));
}

TEST_F(PointCloudTest, RefusesWhatIsNoCloudSayingWhere) {
  EXPECT_THAT(Refusal("a.csv", "1,2,3\n1,x,3\n"),
              HasSubstr("a.csv:2: column 2: not a number; got 'x'"));
  EXPECT_THAT(Refusal("a.csv", "1,2,3\n1,2\n"), HasSubstr("a.csv:2: wrong length"));
  EXPECT_THAT(Refusal("a.csv", "1,2\n"), HasSubstr("a.csv:1: no point; got 2 values"));
  EXPECT_THAT(Refusal("a.csv", "x,y,z\n"), HasSubstr("holds no point"));
  EXPECT_THAT(Refusal("a.txt", "1,2,3\n"), HasSubstr("extension; got '.txt'"));
  const std::string ply =
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_THAT(Refusal("a.ply", "ply\nformat ascii 1.0\n" + ply + "1 2 3\n"),
              HasSubstr("ends too early; got 1 of element vertex; expected 2"));
  EXPECT_THAT(Refusal("a.ply", "ply\nformat binary_little_endian 1.0\n" + ply + "12345678901"),
              HasSubstr("ends too early; got 0 of element vertex"));
  EXPECT_THAT(Refusal("a.pcd", "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3"),
              HasSubstr("unequal length"));
  EXPECT_THAT(Refusal("a.pcd", "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3"),
              HasSubstr("field 'z'"));
  EXPECT_THAT(Refusal("a.pcd",
                      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA "
                      "binary_squeezed\n"),
              HasSubstr("DATA; got binary_squeezed"));
  EXPECT_THROW(LoadPointCloud(folder_.path() / "absent.csv"), models::ModelError);
  EXPECT_THROW(LoadPointCloud("/dev/zero"), models::ModelError);
}

TEST_F(PointCloudTest, MeasuresTheDistanceToTheNearestBallOfACloud) {
  const std::vector<Vector3d> points{kFirst, kSecond, Vector3d(0.0, 0.0, 5.0)};
  const Collider cloud(MakeCloud(points, 0.1), "cloud");
  const Collider ball(Sphere{0.2}, "ball");
  const auto found = Distance(ball, Isometry3d(Eigen::Translation3d(0.0, 0.0, 7.0)), cloud,
                              Isometry3d::Identity());
  EXPECT_NEAR(found.distance, 1.7, 1e-12);
  EXPECT_NEAR((found.normal - Vector3d::UnitZ()).norm(), 0.0, 1e-12);
}

// The tree may only skip what is not the nearest: bodies of all kinds against a cloud, beside a
// look at every ball.
TEST_F(PointCloudTest, EqualsALookAtEveryBall) {
  RandomBodies random(23);
  int beyond = 0, inside = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<Vector3d> points(400);
    const double size = random.Uniform(0.05, 1.0);
    for (Vector3d& p : points) p = random.Uniform(0.0, size) * random.Direction();
    const Collider cloud(MakeCloud(points, 0.02), "cloud");
    const Collider ball(Sphere{0.02}, "ball");
    const auto body = random.Body(random.Integer(RandomBodies::kKinds));
    const Isometry3d X_WC = random.Pose(1.0), X_WB = random.Pose(1.0);
    const double limit = i % 2 == 0 ? 0.3 : std::numeric_limits<double>::infinity();
    double least = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : points) {
      least = std::min(least, Distance(*body, X_WB, ball, X_WC * Eigen::Translation3d(p)).distance);
    }
    const auto found = Distance(*body, X_WB, cloud, X_WC, limit);
    const auto turned = Distance(cloud, X_WC, *body, X_WB, limit);
    if (least > limit) {
      ++beyond;
      EXPECT_EQ(found.status, DistanceStatus::kBeyond) << i;
      continue;
    }
    if (least < 0.0) ++inside;
    ASSERT_NEAR(found.distance, least, 1e-9) << i;
    ASSERT_NEAR(turned.distance, least, 1e-9) << i;
    EXPECT_NEAR((found.normal + turned.normal).norm(), 0.0, 1e-9) << i;
  }
  EXPECT_GT(beyond, 10);
  EXPECT_GT(inside, 10);
}

TEST_F(PointCloudTest, BuildsHeightmapsOfColumns) {
  // Two rows of 3 cells, 0.5 m wide; the upper row is one step, the lower one has a tower.
  const auto file = File("map.csv", "1,1,1\n0,0,3\n");
  const Collider map(LoadHeightmap(file, 0.5, 0.1), "map");
  EXPECT_EQ(map.parts().size(), 3u);  // equal neighbours share a box
  const Collider ball(Sphere{0.1}, "ball");
  const auto above = [&](double x, double y) {
    return Distance(ball, Isometry3d(Eigen::Translation3d(x, y, 1.0)), map, Isometry3d::Identity(),
                    5.0)
        .point_b.z();
  };
  EXPECT_NEAR(above(-0.5, 0.25), 0.1, 1e-12);
  EXPECT_NEAR(above(0.6, -0.25), 0.3, 1e-12);
  EXPECT_NEAR(above(-0.7, -0.45), 0.0, 1e-12);
}

TEST_F(PointCloudTest, ReadsHeightsFromGreyValues) {
  for (const std::string& image :
       {std::string("P2\n# two by one\n2 1\n100\n50 100\n"),
        std::string("P5 2 1 255\n") + "\x33" + "\xff",
        std::string("P5 2 1 1000\n") + std::string("\x01\xf4\x03\xe8", 4)}) {
    const Compound map = LoadHeightmap(File("map.pgm", image), 1.0, 2.0);
    ASSERT_EQ(map.parts.size(), 2u);
    EXPECT_NEAR(std::get<Box>(map.parts[1].shape).size.z(), 1.0 + 2.0, 1e-12);
    EXPECT_LT(std::get<Box>(map.parts[0].shape).size.z(), 1.0 + 1.01);
  }
}

TEST_F(PointCloudTest, RefusesWhatIsNoHeightmap) {
  EXPECT_THAT(MapRefusal("map.csv", "1,2\n1\n"),
              HasSubstr("map.csv:2: wrong length; got 1 values"));
  EXPECT_THAT(MapRefusal("map.csv", "1,-2\n"), HasSubstr("map.csv:1: column 2: height; got -2"));
  EXPECT_THAT(MapRefusal("map.csv", "1,nan\n"), HasSubstr("map.csv:1: column 2: not a number"));
  EXPECT_THAT(MapRefusal("map.csv", "1,a\n"),
              HasSubstr("map.csv:1: column 2: not a number; got 'a'"));
  EXPECT_THAT(MapRefusal("map.csv", ""), HasSubstr("holds no height"));
  EXPECT_THAT(MapRefusal("map.csv", "1\n", 0.0), HasSubstr("cell and scale"));
  EXPECT_THAT(MapRefusal("map.png", "1\n"), HasSubstr("extension"));
  EXPECT_THAT(MapRefusal("map.pgm", "P6 1 1 255\nx"), HasSubstr("kind of PGM; got P6"));
  EXPECT_THAT(MapRefusal("map.pgm", "P5 2 2 255\nxxx"), HasSubstr("ends too early"));
  EXPECT_THAT(MapRefusal("map.pgm", "P2 2 1 9\n4 10\n"), HasSubstr("grey value; got 10"));
  EXPECT_THAT(MapRefusal("map.pgm", "P2 2 1 0\n0 0\n"),
              HasSubstr("largest grey value; got 0; expected 1 to 65535"));
  EXPECT_THAT(MapRefusal("map.pgm", "P5 2 1 100\n\x64\x65"), HasSubstr("got 101 as pixel 1"));
  EXPECT_THAT(MapRefusal("map.pgm", "P5 10000 10000 255\nx"), HasSubstr("cells; got 100000000"));
  std::string steps;
  for (int i = 0; i < 1'001'000; ++i) steps += i % 2 == 0 ? '\x01' : '\x02';
  EXPECT_THAT(
      MapRefusal("map.pgm", "P5 1001 1000 255\n" + steps),
      HasSubstr("map.pgm: boxes of unequal heights; got 1001000; expected at most 1000000"));
  EXPECT_THAT(MapRefusal("map.pgm", "P5 4294967297 1 255\nx"), HasSubstr("width; got"));
  EXPECT_THAT(MapRefusal("map.pgm", "P2 -2 1 9\n4\n"), HasSubstr("width; got -2"));
}

}  // namespace point_cloud_test
}  // namespace oca::geometry
