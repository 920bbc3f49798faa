// SPDX-License-Identifier: BSD-3-Clause
// Soft limits of a safety_controller.
#include <gmock/gmock.h>

#include "oca/models/robot/urdf.h"

namespace oca::robot::test {
namespace soft_limits_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Loaded {
  double lower, upper;
  std::vector<std::string> warnings;
};

/// A slide that may go from 0 to 2, with a safety controller.
Loaded Load(const std::string& attributes) {
  std::vector<std::string> warnings;
  LoadOptions options;
  options.warn = [&](const std::string& line) { warnings.push_back(line); };
  const RobotModel robot = ParseUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='prismatic'><parent "
      "link='a'/><child link='b'/><axis xyz='1 0 0'/><limit lower='0' upper='2' velocity='1' "
      "effort='1'/><safety_controller k_velocity='10' " +
          attributes + "/></joint></robot>",
      "r.urdf", options);
  return {robot.lower_limits()[0], robot.upper_limits()[0], warnings};
}

TEST(SoftLimitsTest, AreToldOfWhereTheyAreNarrower) {
  for (const char* soft : {"soft_lower_limit='0.1' soft_upper_limit='2' k_position='20'",
                           "soft_lower_limit='-1' soft_upper_limit='1.5' k_position='20'"}) {
    const Loaded loaded = Load(soft);
    EXPECT_EQ(loaded.lower, 0.0);
    EXPECT_EQ(loaded.upper, 2.0);
    EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr(
                                     "joint 'j': soft limits of a safety_controller, narrower than "
                                     "<limit>, are not looked at")));
  }
}

TEST(SoftLimitsTest, AreNotToldOfWhereTheyAreNone) {
  for (const char* none : {"", "soft_lower_limit='-1' soft_upper_limit='2'",
                           "soft_lower_limit='0' soft_upper_limit='2' k_position='20'",
                           "soft_lower_limit='1' soft_upper_limit='1'"}) {
    EXPECT_THAT(Load(none).warnings, IsEmpty()) << none;
  }
}

}  // namespace soft_limits_test
}  // namespace oca::robot::test
