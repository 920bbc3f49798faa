// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/signals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <variant>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/signals/signal_texts.h"
#include "tests/temporary_folder.h"

namespace oca::systems {
namespace signals_test {

using test::kObstacle;
using test::Refusal;
using test::WriteText;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kProximity =
    R"([{"link":"l","obstacle":"o","distance":-0.25,"point_on_link":[1,0,0],)"
    R"("point_on_obstacle":[0,1,0],"normal":[0,0,1]}])";
constexpr const char* kForce =
    R"([{"link":"l","obstacle":"o","force":[1.0,2.0,3.0],"point":[0.1,0.2,0.3]}])";
constexpr const char* kWrench =
    R"([{"link":"l","force":[1.0,2.0,3.0],"torque":[2.0,-1.0,0.0],"origin":[0.0,0.0,1.0]}])";
constexpr const char* kLinks =
    R"([{"link":"l","pose":{"xyz":[1.0,2.0,3.0],"quaternion":[0.0,0.0,0.0,1.0]}}])";

TEST(SignalsTest, WritesTheTextItReads) {
  EXPECT_EQ(WriteText(Signal<ObstacleSet>::ReadJson(kObstacle)), kObstacle);
  EXPECT_EQ(WriteText(Signal<ProximitySet>::ReadJson(kProximity)), kProximity);
  EXPECT_EQ(WriteText(Signal<LinkForceSet>::ReadJson(kForce)), kForce);
  EXPECT_EQ(WriteText(Signal<WrenchSet>::ReadJson(kWrench)), kWrench);
  EXPECT_EQ(WriteText(Signal<LinkPoses>::ReadJson(kLinks)), kLinks);
}

TEST(SignalsTest, WritesAnEmptySetAsAnEmptyList) {
  EXPECT_EQ(WriteText(ObstacleSet{}), "[]");
  EXPECT_EQ(WriteText(LinkPoses{}), "[]");
  EXPECT_TRUE(Signal<ProximitySet>::ReadJson("[]").proximities.empty());
}

TEST(SignalsTest, ReadsEveryFieldOfAnObstacle) {
  const ObstacleSet set = Signal<ObstacleSet>::ReadJson(kObstacle);
  ASSERT_EQ(set.obstacles.size(), 1u);
  const Obstacle& obstacle = set.obstacles[0];
  EXPECT_EQ(obstacle.body->id, models::Name("box"));
  EXPECT_EQ(std::get<geometry::Box>(obstacle.body->collider->shape()).size,
            Eigen::Vector3d(0.2, 0.3, 0.4));
  EXPECT_EQ(obstacle.X_WO.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(obstacle.linear, Eigen::Vector3d(0.1, 0.0, 0.0));
  EXPECT_EQ(obstacle.angular, Eigen::Vector3d(0.0, 0.0, 0.5));
}

TEST(SignalsTest, TakesAnObstacleWithoutTwistAsStanding) {
  const auto set = Signal<ObstacleSet>::ReadJson(
      R"([{"id":"s","shape":{"type":"sphere","radius":0.1},"pose":{"xyz":[0,0,0]}}])");
  EXPECT_EQ(set.obstacles[0].linear, Eigen::Vector3d::Zero());
  EXPECT_EQ(set.obstacles[0].angular, Eigen::Vector3d::Zero());
}

TEST(SignalsTest, ReadsEachShape) {
  const auto shape = [](const std::string& fields) {
    return Signal<ObstacleSet>::ReadJson(R"([{"id":"s","shape":{)" + fields +
                                         R"(},"pose":{"xyz":[0,0,0]}}])")
        .obstacles[0]
        .body->collider->shape();
  };
  EXPECT_EQ(std::get<geometry::Sphere>(shape(R"("type":"sphere","radius":0.1)")).radius, 0.1);
  const auto cylinder =
      std::get<geometry::Cylinder>(shape(R"("type":"cylinder","radius":0.1,"length":0.5)"));
  EXPECT_EQ(cylinder.radius, 0.1);
  EXPECT_EQ(cylinder.length, 0.5);
  const auto capsule =
      std::get<geometry::Capsule>(shape(R"("type":"capsule","radius":0.2,"length":0.6)"));
  EXPECT_EQ(capsule.radius, 0.2);
  EXPECT_EQ(capsule.length, 0.6);
  const auto cone = std::get<geometry::Cone>(shape(R"("type":"cone","radius":0.1,"length":0.5)"));
  EXPECT_EQ(cone.radius, 0.1);
  EXPECT_EQ(cone.length, 0.5);
  const auto ellipsoid =
      std::get<geometry::Ellipsoid>(shape(R"("type":"ellipsoid","radii":[0.1,0.2,0.3])"));
  EXPECT_EQ(ellipsoid.radii, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(std::holds_alternative<geometry::HalfSpace>(shape(R"("type":"half_space")")));
}

TEST(SignalsTest, ACompoundComesBackAsItWasWritten) {
  const std::string parts =
      R"({"type":"compound","parts":[{"shape":{"type":"box","size":[0.1,0.2,0.3]},)"
      R"("pose":{"xyz":[0.0,0.0,0.5],"quaternion":[0.0,0.0,0.0,1.0]}},)"
      R"({"shape":{"type":"cone","radius":0.1,"length":0.2},)"
      R"("pose":{"xyz":[1.0,0.0,0.0],"quaternion":[0.0,0.0,0.0,1.0]}}]})";
  const auto set = Signal<ObstacleSet>::ReadJson(R"([{"id":"s","shape":)" + parts +
                                                 R"(,"pose":{"xyz":[0,0,0]}}])");
  const auto& compound = std::get<geometry::Compound>(set.obstacles[0].body->collider->shape());
  ASSERT_EQ(compound.parts.size(), 2u);
  EXPECT_EQ(compound.parts[0].X_SP.translation().z(), 0.5);
  EXPECT_THAT(WriteText<ObstacleSet>(set), HasSubstr(parts));
}

TEST(SignalsTest, ACloudComesBackAsItsFileNotAsItsPoints) {
  const test::TemporaryFolder folder;
  const std::string file = folder.Write("points.csv", "0,0,0\n1,2,3\n").string();
  const std::string shape = R"({"type":"cloud","radius":0.01,"file":")" + file + R"("})";
  const auto set = Signal<ObstacleSet>::ReadJson(R"([{"id":"s","shape":)" + shape +
                                                 R"(,"pose":{"xyz":[0,0,0]}}])");
  const std::string text = WriteText<ObstacleSet>(set);
  EXPECT_THAT(text, HasSubstr(R"("type":"cloud")"));
  EXPECT_THAT(text, HasSubstr(file));
  EXPECT_THAT(text, testing::Not(HasSubstr("parts")));
}

TEST(SignalsTest, ReadsTheSizesOfAHeightmapAndWhatAMeshCountsAs) {
  const test::TemporaryFolder folder;
  const std::string file = folder.Write("heights.csv", "1,2\n").string();
  const auto read = [&](const std::string& fields) {
    return Signal<ObstacleSet>::ReadJson(R"([{"id":"s","shape":{)" + fields + R"(,"file":")" +
                                         file + R"("},"pose":{"xyz":[0,0,0]}}])");
  };
  const auto set = read(R"("type":"heightmap","cell":0.5,"scale":0.1)");
  const auto& map = std::get<geometry::Compound>(set.obstacles[0].body->collider->shape());
  EXPECT_EQ(map.parts.size(), 2u);
  EXPECT_THAT(
      Refusal<ObstacleSet>(R"([{"id":"s","shape":{"type":"mesh","file":"a.stl","collision":"hul"},)"
                           R"("pose":{"xyz":[0,0,0]}}])"),
      HasSubstr("hull, decomposition"));
}

TEST(SignalsTest, RefusesAShapeThatHasSizesOfAnother) {
  const auto refusal = [](const std::string& shape) {
    return Refusal<ObstacleSet>(R"([{"id":"s","shape":)" + shape + R"(,"pose":{"xyz":[0,0,0]}}])");
  };
  EXPECT_THAT(refusal(R"({"type":"half_space","radius":1})"),
              HasSubstr("radius: got a value; expected none of a half_space"));
  EXPECT_THAT(refusal(R"({"type":"ellipsoid","size":[1,1,1]})"),
              HasSubstr("size: got a value; expected none of an ellipsoid"));
  EXPECT_THAT(refusal(R"({"type":"compound"})"), HasSubstr("parts: got none"));
  EXPECT_THAT(refusal(R"({"type":"compound","parts":[{"shape":{"type":"half_space"}}]})"),
              HasSubstr("parts[0].shape.type: got a half_space"));
  EXPECT_THAT(refusal(R"({"type":"dodecahedron"})"), HasSubstr("'dodecahedron'"));
}

TEST(SignalsTest, VelocityAtAPointAddsTheRotation) {
  const Obstacle obstacle = Signal<ObstacleSet>::ReadJson(kObstacle).obstacles[0];
  // 0.5 rad/s about z at a lever of 2 m along x: 1 m/s along y.
  EXPECT_EQ(obstacle.VelocityAt({3.0, 2.0, 3.0}), Eigen::Vector3d(0.1, 1.0, 0.0));
}

TEST(SignalsTest, ReadsRollPitchYawAboutFixedAxes) {
  // A quarter about x and then about z takes the body's z axis to -y and on to x.
  const auto links = Signal<LinkPoses>::ReadJson(
      R"([{"link":"l","pose":{"xyz":[0,0,0],"rpy":[1.5707963267948966,0,1.5707963267948966]}}])");
  const Eigen::Vector3d z = links.poses[0].linear().col(2);
  EXPECT_NEAR((z - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-15);
}

TEST(SignalsTest, AcceptsAQuaternionRoundedToThreeDigitsButNoOther) {
  const auto text = [](const std::string& quaternion) {
    return R"([{"link":"l","pose":{"xyz":[0,0,0],"quaternion":)" + quaternion + "}}]";
  };
  const auto links = Signal<LinkPoses>::ReadJson(text("[0,0,0.707,0.707]"));
  EXPECT_NEAR(links.poses[0].linear().determinant(), 1.0, 1e-12);
  EXPECT_NEAR(links.poses[0].linear()(1, 0), 1.0, 1e-12);
  EXPECT_THAT(Refusal<LinkPoses>(text("[0,0,0.7,0.7]")), HasSubstr("unit quaternion"));
  EXPECT_THAT(Refusal<LinkPoses>(text("[0,0,0,0]")), HasSubstr("unit quaternion"));
}

TEST(SignalsTest, ALinkOfJsonIsItsOwnBody) {
  const auto links = Signal<LinkPoses>::ReadJson(
      R"([{"link":"a","pose":{"xyz":[0,0,0]}},{"link":"b","pose":{"xyz":[0,0,1]}}])");
  EXPECT_EQ(links.bodies, (std::vector<int>{0, 1}));
  EXPECT_EQ(links.Find(models::Name("b")), 1);
  EXPECT_EQ(links.Find(models::Name("b"), 1), 1);
  EXPECT_EQ(links.Find(models::Name("b"), 7), 1);
  EXPECT_EQ(links.Find(models::Name("c")), -1);
}

TEST(SignalsTest, ReadsTheVelocityOfAnObstacleButNeverWritesIt) {
  std::string text = kProximity;
  text.insert(text.size() - 2, R"(,"obstacle_velocity":[0.0,0.0,0.7])");
  const auto set = Signal<ProximitySet>::ReadJson(text);
  EXPECT_EQ(set.proximities[0].obstacle_velocity, Eigen::Vector3d(0.0, 0.0, 0.7));
  EXPECT_EQ(WriteText(set), kProximity);
}

TEST(SignalsTest, RefusesAnUnknownKeyAndSaysWhichWasMeant) {
  EXPECT_THAT(
      Refusal<LinkForceSet>(R"([{"link":"l","obstacle":"o","forse":[1,2,3],"point":[0,0,0]}])"),
      AllOf(HasSubstr("forces[0]"), HasSubstr("'forse'"), HasSubstr("did you mean 'force'")));
}

TEST(SignalsTest, RefusesAMissingKey) {
  EXPECT_THAT(Refusal<WrenchSet>(R"([{"link":"l","force":[1,2,3],"torque":[0,0,0]}])"),
              AllOf(HasSubstr("wrenches[0]"), HasSubstr("'origin'")));
}

TEST(SignalsTest, RefusesVectorsOfAnotherLengthOrType) {
  for (const char* point : {"[0,0]", "[0,0,0,0]", "\"x\"", "[0,0,null]", "[0,0,\"1\"]", "3"}) {
    const std::string text =
        R"([{"link":"l","obstacle":"o","force":[1,2,3],"point":)" + std::string(point) + "}]";
    EXPECT_THAT(Refusal<LinkForceSet>(text), HasSubstr("forces[0].point")) << point;
  }
}

TEST(SignalsTest, RefusesNumbersThatAreNotFinite) {
  EXPECT_THAT(
      Refusal<LinkForceSet>(R"([{"link":"l","obstacle":"o","force":[1e999,2,3],"point":[0,0,0]}])"),
      HasSubstr("finite"));
}

TEST(SignalsTest, RefusesANormalThatIsNoUnitVector) {
  std::string text = kProximity;
  text.replace(text.find("[0,0,1]"), 7, "[0,0,1.1]");
  EXPECT_THAT(Refusal<ProximitySet>(text), HasSubstr("proximities[0].normal"));
}

TEST(SignalsTest, RefusesTextThatIsNoJson) {
  EXPECT_THAT(Refusal<ProximitySet>("[{"), HasSubstr("syntax"));
  EXPECT_THAT(Refusal<ProximitySet>("{}"), HasSubstr("expected a list"));
  EXPECT_THAT(Refusal<ProximitySet>("[1]"), HasSubstr("expected an object"));
}

TEST(SignalsTest, RefusesTwoObstaclesOfOneIdAndALinkTwice) {
  const std::string one =
      R"({"id":"s","shape":{"type":"sphere","radius":0.1},"pose":{"xyz":[0,0,0]}})";
  EXPECT_THAT(Refusal<ObstacleSet>("[" + one + "," + one + "]"), HasSubstr("unique ids"));
  const std::string link = R"({"link":"l","pose":{"xyz":[0,0,0]}})";
  EXPECT_THAT(Refusal<LinkPoses>("[" + link + "," + link + "]"), HasSubstr("unique links"));
}

TEST(SignalsTest, RefusesShapesWithMissingSurplusOrBadSizes) {
  const auto refusal = [](const std::string& shape) {
    return Refusal<ObstacleSet>(R"([{"id":"s","shape":)" + shape + R"(,"pose":{"xyz":[0,0,0]}}])");
  };
  EXPECT_THAT(refusal(R"({"type":"sphere"})"), HasSubstr("shape.radius: got none"));
  EXPECT_THAT(refusal(R"({"type":"sphere","radius":1,"length":1})"),
              HasSubstr("shape.length: got a value"));
  EXPECT_THAT(refusal(R"({"type":"sphere","radius":0})"), HasSubstr("above 0"));
  EXPECT_THAT(refusal(R"({"type":"box","size":[1,1,-1]})"), HasSubstr("above 0"));
  EXPECT_THAT(refusal(R"({"type":"torus","radius":1})"), HasSubstr("'torus'"));
  EXPECT_THAT(refusal(R"({"type":"mesh","file":"no_such_mesh.stl"})"),
              HasSubstr("no_such_mesh.stl"));
}

TEST(SignalsTest, SeesANumberThatIsNotFiniteAnywhere) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  auto obstacles = Signal<ObstacleSet>::ReadJson(kObstacle);
  EXPECT_TRUE(Signal<ObstacleSet>::Check(obstacles, Look::kFinite).ok());
  obstacles.obstacles[0].angular.z() = kNaN;
  EXPECT_FALSE(Signal<ObstacleSet>::Check(obstacles, Look::kFinite).ok());
  auto proximities = Signal<ProximitySet>::ReadJson(kProximity);
  EXPECT_TRUE(Signal<ProximitySet>::Check(proximities, Look::kFinite).ok());
  proximities.proximities[0].distance = kNaN;
  EXPECT_FALSE(Signal<ProximitySet>::Check(proximities, Look::kFinite).ok());
  auto links = Signal<LinkPoses>::ReadJson(kLinks);
  EXPECT_TRUE(Signal<LinkPoses>::Check(links, Look::kFinite).ok());
  links.poses[0].translation().x() = kNaN;
  EXPECT_FALSE(Signal<LinkPoses>::Check(links, Look::kFinite).ok());
  auto forces = Signal<LinkForceSet>::ReadJson(kForce);
  EXPECT_TRUE(Signal<LinkForceSet>::Check(forces, Look::kFinite).ok());
  forces.forces[0].point.y() = kNaN;
  EXPECT_FALSE(Signal<LinkForceSet>::Check(forces, Look::kFinite).ok());
  auto wrenches = Signal<WrenchSet>::ReadJson(kWrench);
  EXPECT_TRUE(Signal<WrenchSet>::Check(wrenches, Look::kFinite).ok());
  wrenches.wrenches[0].origin.y() = kNaN;
  EXPECT_FALSE(Signal<WrenchSet>::Check(wrenches, Look::kFinite).ok());
}

TEST(SignalsTest, ALinkWithoutTwistRestsAndATwistIsRead) {
  const auto links = Signal<LinkPoses>::ReadJson(
      R"([{"link":"a","pose":{"xyz":[0,0,0]}},{"link":"b","pose":{"xyz":[0,0,1]},)"
      R"("twist":{"linear":[1,2,3],"angular":[0,0,2]}}])");
  ASSERT_EQ(links.velocities.size(), 2u);
  EXPECT_EQ(links.velocities[0].linear, Eigen::Vector3d::Zero());
  EXPECT_EQ(links.VelocityAt(1, {1.0, 0.0, 1.0}), Eigen::Vector3d(1.0, 4.0, 3.0));
  EXPECT_THROW(Signal<LinkPoses>::ReadJson(
                   R"([{"link":"a","pose":{"xyz":[0,0,0]},"twist":{"linear":[1,2,3]}}])"),
               ConfigError);
}

TEST(SignalsTest, AProximityTellsWhichLinkOfItsOwnRobotItMeets) {
  std::string text = kProximity;
  text.insert(text.size() - 2, R"(,"own_link":"k")");
  EXPECT_EQ(Signal<ProximitySet>::ReadJson(text).proximities[0].own_link, models::Name("k"));
  EXPECT_TRUE(Signal<ProximitySet>::ReadJson(kProximity).proximities[0].own_link.empty());
}

}  // namespace signals_test
}  // namespace oca::systems
