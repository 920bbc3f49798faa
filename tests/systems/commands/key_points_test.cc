// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/key_points.h"

#include <gmock/gmock.h>

#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::systems {
namespace key_points_test {

using ::testing::HasSubstr;

const std::vector<KeyPointParams> kTwo{
    {.time = 0.0, .position = Eigen::Vector2d(1.0, 2.0)},
    {.time = 1.0, .position = Eigen::Vector2d(3.0, 4.0), .velocity = Eigen::Vector2d(5.0, 6.0)}};

std::string RefusalOf(const std::vector<KeyPointParams>& points, const std::string& file,
                      const std::vector<std::string>& joints = {}) {
  try {
    KeyPointsFrom(points, file, joints);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(KeyPointParamsTest, BecomeKeyPoints) {
  const auto points = KeyPointsFrom(kTwo, "");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].time, 1.0);
  EXPECT_EQ(points[1].position, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(points[1].velocity, kTwo[1].velocity);
  EXPECT_FALSE(points[0].velocity || points[1].acceleration);
}

TEST(KeyPointParamsTest, ComeFromAFileInstead) {
  const test::TemporaryFolder folder;
  const std::string file = folder.Write("points.csv", "time,elbow\n0,1\n1,2\n").string();
  EXPECT_EQ(KeyPointsFrom({}, file, {"elbow"}).at(1).position[0], 2.0);
  EXPECT_THAT(RefusalOf({}, folder.Write("back.csv", "0,1\n0,2\n").string()),
              HasSubstr("back.csv[1].time: not later than the point before"));
}

TEST(KeyPointParamsTest, AreRefusedAsConfigErrors) {
  EXPECT_THAT(RefusalOf({}, ""), HasSubstr("key_points: empty"));
  EXPECT_THAT(RefusalOf({kTwo[1], kTwo[0]}, ""), HasSubstr("key_points[1].time: not later"));
  EXPECT_THAT(RefusalOf({}, "no/such/file.csv"), HasSubstr("no/such/file.csv"));
  EXPECT_THAT(RefusalOf(kTwo, "some.csv"), HasSubstr("file: given twice"));
  EXPECT_THAT(RefusalOf(kTwo, "", {"elbow"}), HasSubstr("joints: without a file"));
}

}  // namespace key_points_test
}  // namespace oca::systems
