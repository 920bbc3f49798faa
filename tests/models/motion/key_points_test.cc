// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/key_points.h"

#include <gmock/gmock.h>

#include <limits>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::motion {
namespace key_points_test {

using ::testing::HasSubstr;

/// A file that is gone after the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(folder_.Write("key_points.csv", text).string()) {}
  const std::string& path() const { return path_; }

 private:
  test::TemporaryFolder folder_;
  std::string path_;
};

std::string RefusalOf(const std::string& text) {
  const TemporaryFile file(text);
  try {
    CheckKeyPoints(ReadKeyPoints(file.path()), file.path());
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

std::string RefusalOf(const std::vector<KeyPoint>& points) {
  try {
    CheckKeyPoints(points, "key_points");
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

KeyPoint At(double time, const Eigen::VectorXd& position) {
  return {.time = time, .position = position};
}

TEST(KeyPointsTest, ReadsTimesAndPositions) {
  const TemporaryFile file("# comment\n\n0, 1, 2\r\n 0.5 ,+3,-4e-1\n");
  const auto points = ReadKeyPoints(file.path());
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].time, 0.5);
  EXPECT_EQ(Eigen::Vector2d(points[1].position), Eigen::Vector2d(3.0, -0.4));
  EXPECT_FALSE(points[1].velocity);
}

TEST(KeyPointsTest, ReadsVelocitiesAndAccelerationsThatTheFirstLineNames) {
  const TemporaryFile file("time,p1,p2,v1,v2,a1,a2\n1,2,3,4,5,6,7\n");
  const auto points = ReadKeyPoints(file.path());
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(Eigen::Vector2d(points[0].position), Eigen::Vector2d(2.0, 3.0));
  EXPECT_EQ(Eigen::Vector2d(*points[0].velocity), Eigen::Vector2d(4.0, 5.0));
  EXPECT_EQ(Eigen::Vector2d(*points[0].acceleration), Eigen::Vector2d(6.0, 7.0));
}

TEST(KeyPointsTest, NamesFileAndLineOfWhatIsNoNumber) {
  const std::string text = RefusalOf("0,1\n1,two\n");
  EXPECT_THAT(text, HasSubstr(".csv:2: column 2: not a number; got 'two'"));
  EXPECT_THAT(RefusalOf("0,1\n1,nan\n"), HasSubstr("not a number"));
  EXPECT_THAT(RefusalOf("0,1\n1,\n"), HasSubstr("not a number; got ''"));
}

TEST(KeyPointsTest, RefusesLinesOfAnotherLength) {
  EXPECT_THAT(RefusalOf("0,1,2\n1,1\n"), HasSubstr(":2: wrong length; got 2 values; expected 3"));
  EXPECT_THAT(RefusalOf("0\n"), HasSubstr("wrong length"));
}

TEST(KeyPointsTest, RefusesNamesThatDoNotMatchThePositions) {
  EXPECT_THAT(RefusalOf("time,p1,p2,v1\n0,1,2,3\n"), HasSubstr(":1: names of columns"));
  EXPECT_THAT(RefusalOf("time\n0\n"), HasSubstr(":1: names of columns"));
}

TEST(KeyPointsTest, GoesByTheNamesOfColumnsInAnyOrder) {
  const TemporaryFile file(
      "\xEF\xBB\xBFv[1],note,position[1],time,position[0],v[0]\n6,9,3,1,2,5\n");
  const auto points = ReadKeyPoints(file.path());
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].time, 1.0);
  EXPECT_EQ(Eigen::Vector2d(points[0].position), Eigen::Vector2d(2.0, 3.0));
  EXPECT_EQ(Eigen::Vector2d(*points[0].velocity), Eigen::Vector2d(5.0, 6.0));
  EXPECT_THAT(RefusalOf("time,p1,p3\n0,1,2\n"), HasSubstr("got p3 without those before"));
  EXPECT_THAT(RefusalOf("time,p1,position1\n0,1,2\n"), HasSubstr("two with number 1"));
  EXPECT_THAT(RefusalOf("p1,p2\n1,2\n"), HasSubstr("no 'time'"));
  EXPECT_THAT(RefusalOf("time,q1,pwm1,pressure2\n0,1,100,2\n"), HasSubstr("or `joints`"));
  const TemporaryFile other("time,P_1,voltage1,axis1,valid[1]\n0,4,1,2,3\n");
  const auto alone = ReadKeyPoints(other.path());
  EXPECT_EQ(alone.at(0).position[0], 4.0);
  EXPECT_FALSE(alone.at(0).velocity || alone.at(0).acceleration);
  EXPECT_THAT(RefusalOf("time,elbow,wrist\n0,1,2\n"), HasSubstr("or `joints`"));
}

TEST(KeyPointsTest, TakesTheColumnsThatJointsName) {
  const TemporaryFile file("wrist,time,force,\"elbow, left\"\n1,0,9,2\n");
  const auto points = ReadKeyPoints(file.path(), {"elbow, left", "wrist"});
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(Eigen::Vector2d(points[0].position), Eigen::Vector2d(2.0, 1.0));
  EXPECT_THROW(ReadKeyPoints(file.path(), {"elbow", "wrist"}), models::ModelError);
  const TemporaryFile unnamed("0,1,2\n");
  EXPECT_THROW(ReadKeyPoints(unnamed.path(), {"elbow", "wrist"}), models::ModelError);
}

TEST(KeyPointsTest, RefusesBinaryJunkEmptyAndMissingFiles) {
  EXPECT_THAT(RefusalOf(std::string("\x7f\x45LF\0\0\n\xff", 8)),
              HasSubstr(":1: control character; got byte 0x7f"));
  EXPECT_THAT(RefusalOf("# nothing\n"), HasSubstr("expected at least one"));
  EXPECT_THROW(ReadKeyPoints("no/such/file.csv"), models::ModelError);
  EXPECT_THROW(ReadKeyPoints(testing::TempDir()), models::ModelError);
}

TEST(KeyPointsTest, RefusesTimesThatDoNotIncrease) {
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(2);
  EXPECT_EQ(RefusalOf({At(0.0, q), At(1.0, q), At(1.0, q)}),
            "key_points[2].time: not later than the point before; got 1; expected > 1");
  EXPECT_EQ(RefusalOf({At(0.0, q), At(std::nextafter(0.0, 1.0), q)}), "accepted");
}

TEST(KeyPointsTest, RefusesPointsOfDifferentLengthAndNumbersThatAreNotFinite) {
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(2);
  const Eigen::VectorXd nan =
      Eigen::VectorXd::Constant(2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(RefusalOf({At(0.0, q), At(1.0, Eigen::VectorXd::Zero(3))}),
              HasSubstr("key_points[1].position: wrong length; got 3 numbers; expected 2"));
  EXPECT_THAT(RefusalOf({At(0.0, Eigen::VectorXd())}), HasSubstr("expected at least one"));
  EXPECT_THAT(RefusalOf({At(0.0, nan)}), HasSubstr("not finite"));
  EXPECT_THAT(RefusalOf({At(nan[0], q)}), HasSubstr("time: not finite"));
  EXPECT_EQ(RefusalOf({At(0.0, q.array() - 1e6)}), "accepted");
  EXPECT_THAT(
      RefusalOf({At(0.0, q), At(1.0, q.array() - 1.1e6)}),
      HasSubstr("key_points[1].position: too far out; got 1100000; expected at most 1e+06"));
  KeyPoint point = At(0.0, q);
  point.velocity = Eigen::VectorXd::Zero(1);
  EXPECT_THAT(RefusalOf({point}), HasSubstr("key_points[0].velocity: wrong length"));
}

TEST(KeyPointsTest, RefusesNoPoints) {
  EXPECT_THAT(RefusalOf(std::vector<KeyPoint>{}), HasSubstr("key_points: empty"));
}

}  // namespace key_points_test
}  // namespace oca::motion
