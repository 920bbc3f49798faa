// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/waypoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::motion {
namespace waypoints_test {

using Eigen::Vector3d;
using ::testing::HasSubstr;

class WaypointTableTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& text) const {
    return folder_.Write("motion.csv", text).string();
  }
  std::string Refusal(const std::string& text) {
    try {
      ReadWaypoints(Write(text));
    } catch (const models::ModelError& error) {
      return error.what();
    }
    ADD_FAILURE() << "was accepted: " << text;
    return "";
  }

  const test::TemporaryFolder folder_;
};

TEST_F(WaypointTableTest, ReadsTheRowsOfATable) {
  const auto waypoints = ReadWaypoints(Write("time,x,y,z\n0, 1, 2, 3\r\n2,3,2,-1e0\n\n"));
  ASSERT_EQ(waypoints.size(), 2u);
  EXPECT_EQ(waypoints[1].time, 2.0);
  EXPECT_EQ(waypoints[1].xyz, Vector3d(3.0, 2.0, -1.0));
  EXPECT_FALSE(waypoints[1].rpy);
}

TEST_F(WaypointTableTest, ReadsRotationsIfThereAreColumnsForThem) {
  const auto waypoints = ReadWaypoints(Write("time,x,y,z,roll,pitch,yaw\n0,1,2,3,0.1,0.2,0.3\n"));
  ASSERT_EQ(waypoints.size(), 1u);
  EXPECT_EQ(*waypoints[0].rpy, Vector3d(0.1, 0.2, 0.3));
}

TEST_F(WaypointTableTest, GoesByTheNamesOfColumnsInAnyOrder) {
  const auto waypoints =
      ReadWaypoints(Write("# by hand\n\nyaw,note,z,y,x,roll,pitch,time\n6,9,3,2,1,4,5,+0\n"));
  ASSERT_EQ(waypoints.size(), 1u);
  EXPECT_EQ(waypoints[0].time, 0.0);
  EXPECT_EQ(waypoints[0].xyz, Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(*waypoints[0].rpy, Vector3d(4.0, 5.0, 6.0));
  EXPECT_THAT(Refusal("time,x,y,z,roll\n0,1,2,3,4\n"), HasSubstr("no 'pitch'"));
}

TEST_F(WaypointTableTest, RefusesWhatIsNoSuchTable) {
  EXPECT_THAT(Refusal(""), HasSubstr("names of columns; got none"));
  EXPECT_THAT(Refusal("t,x,y,z\n"), HasSubstr(":1: names of columns"));
  EXPECT_THAT(Refusal("time,x,y,z\n0,1,2\n"),
              HasSubstr(":2: wrong length; got 3 values; expected 4"));
  EXPECT_THAT(Refusal("time,x,y,z\n0,1,2,3\n1,1,nan,3\n"),
              HasSubstr(":3: column 3 ('y'): not a number; got 'nan'"));
  EXPECT_THAT(Refusal("time,x,y,z\n0,1,2,3m\n"), HasSubstr("'3m'"));
  EXPECT_THROW(ReadWaypoints("no_such_table.csv"), models::ModelError);
}

}  // namespace waypoints_test
}  // namespace oca::motion
