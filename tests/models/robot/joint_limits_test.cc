// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/joint_limits.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "oca/models/error.h"

namespace oca::robot {
namespace joint_limits_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using testing::ThrowsMessage;

constexpr double kPi = std::numbers::pi;

/// Joint 'a' turns, 'b', 'c', ... behind each other too, each within [-1, 1] at 1 rad/s.
class Chain {
 public:
  explicit Chain(int count) : joints(static_cast<std::size_t>(count)) {
    for (int j = 0; j < count; ++j) {
      Joint& joint = joints[static_cast<std::size_t>(j)];
      joint.name = models::Name(std::string(1, static_cast<char>('a' + j)));
      joint.type = JointType::kRevolute;
      joint.parent_link = j;
      joint.child_link = j + 1;
      joint.lower_limit = -1.0;
      joint.upper_limit = 1.0;
      joint.velocity_limit = 1.0;
    }
  }
  RobotModel Model() const {
    std::vector<Link> links(joints.size() + 1);
    for (std::size_t i = 0; i < links.size(); ++i)
      links[i].name = models::Name("l" + std::to_string(i));
    return {models::Name("chain"), links, joints};
  }
  std::vector<Joint> joints;
};

TEST(JointLimitsTest, APositionIsInMetresOfASliderAndElseInRadians) {
  EXPECT_STREQ(PositionUnit({.type = JointType::kPrismatic}), "m");
  EXPECT_STREQ(PositionUnit({.type = JointType::kRevolute}), "rad");
  EXPECT_STREQ(PositionUnit({.type = JointType::kContinuous}), "rad");
}

TEST(JointLimitsTest, AMimicBindsItsLeader) {
  Chain chain(2);
  chain.joints[0].acceleration_limit = 9.0;
  chain.joints[1].acceleration_limit = 8.0;
  chain.joints[1].jerk_limit = 40.0;
  chain.joints[1].effort_limit = 3.0;
  chain.joints[1].mimic = Mimic{0, 2.0, 0.0};
  const RobotModel model = chain.Model();
  EXPECT_EQ(model.lower_limits()[0], -0.5);
  EXPECT_EQ(model.upper_limits()[0], 0.5);
  EXPECT_EQ(model.velocity_limits()[0], 0.5);
  EXPECT_EQ(model.acceleration_limits()[0], 4.0);
  EXPECT_EQ(model.jerk_limits()[0], 20.0);
  EXPECT_EQ(model.effort_limits()[0], kUnlimited);  // a drive's own
  EXPECT_THAT(LimitWarnings(model),
              ElementsAre("joint 'a': the limits of what mimics it, joint 'b', bind it to [-0.5, "
                          "0.5] rad, 0.5 rad/s, 4 rad/s^2, 20 rad/s^3"));
}

TEST(JointLimitsTest, AMimicThatRunsBackwardsBindsTheOtherEnd) {
  Chain chain(2);
  chain.joints[1].lower_limit = -0.25;
  chain.joints[1].mimic = Mimic{0, -0.5, 0.125};
  const RobotModel model = chain.Model();  // -0.25 <= 0.125 - q / 2 <= 1
  EXPECT_EQ(model.lower_limits()[0], -1.0);
  EXPECT_EQ(model.upper_limits()[0], 0.75);
  EXPECT_EQ(model.velocity_limits()[0], 1.0);  // the mimic is slower
}

TEST(JointLimitsTest, AMimicOfAMimicBindsTheFirst) {
  Chain chain(3);
  chain.joints[1].mimic = Mimic{0, 2.0, 0.25};
  chain.joints[2].mimic = Mimic{1, 2.0, 0.0};  // 4 q + 0.5
  const RobotModel model = chain.Model();
  EXPECT_EQ(model.lower_limits()[0], -0.375);
  EXPECT_EQ(model.upper_limits()[0], 0.125);
  EXPECT_EQ(model.velocity_limits()[0], 0.25);
}

TEST(JointLimitsTest, AMimicWithoutLimitsOrWithTheSameBindsNothing) {
  Chain chain(3);
  chain.joints[1].mimic = Mimic{0, 1.0, 0.0};
  chain.joints[2].mimic = Mimic{0, 5.0, 0.0};
  chain.joints[2].type = JointType::kContinuous;
  chain.joints[2].lower_limit = -kUnlimited;
  chain.joints[2].upper_limit = kUnlimited;
  chain.joints[2].velocity_limit = 0.0;
  EXPECT_EQ(chain.Model().upper_limits()[0], 1.0);
  EXPECT_EQ(chain.Model().velocity_limits()[0], 1.0);
}

TEST(JointLimitsTest, RefusesAMimicThatLeavesNoPosition) {
  Chain chain(3);
  chain.joints[1].mimic = Mimic{0, 1.0, 2.5};
  EXPECT_THAT([&] { chain.Model(); }, ThrowsMessage<models::ModelError>(
                                          AllOf(HasSubstr("joint 'b': mimic"), HasSubstr("'a'"),
                                                HasSubstr("plus 2.5"), HasSubstr("[-1, 1]"))));
  chain.joints[1].mimic = Mimic{0, 1.0, 2.0};  // just q = -1
  EXPECT_EQ(chain.Model().upper_limits()[0], -1.0);
  EXPECT_EQ(chain.Model().lower_limits()[0], -1.0);
  chain.joints[2].mimic = Mimic{0, 1.0, -0.5};  // each would do alone
  EXPECT_THAT([&] { chain.Model(); }, ThrowsMessage<models::ModelError>(
                                          AllOf(HasSubstr("joint 'c': mimic"), EndsWith("keep"))));
  chain.joints[2].mimic.reset();
  chain.joints[1].mimic = Mimic{0, 0.0, 1.5};  // stands still, beyond its limits
  EXPECT_THAT([&] { chain.Model(); }, ThrowsMessage<models::ModelError>(HasSubstr("joint 'b'")));
  chain.joints[1].mimic = Mimic{0, 0.0, 0.5};
  EXPECT_EQ(chain.Model().upper_limits()[0], 1.0);
}

TEST(JointLimitsTest, ZeroMeansNotGiven) {
  Chain chain(3);
  chain.joints[0].velocity_limit = 0.0;
  chain.joints[1].effort_limit = 0.0;
  chain.joints[2].velocity_limit = kUnlimited;
  const RobotModel model = chain.Model();
  EXPECT_EQ(model.velocity_limits()[0], kUnlimited);
  EXPECT_EQ(model.effort_limits()[1], kUnlimited);
  EXPECT_THAT(LimitWarnings(model), ElementsAre(StartsWith("joint 'a': velocity limit 0"),
                                                StartsWith("joint 'c': no velocity limit"),
                                                StartsWith("joint 'b': no effort limit, or 0")));
  EXPECT_THAT(LimitWarnings(Chain(3).Model()), IsEmpty());
}

TEST(JointLimitsTest, DrawsFromRangesThatDrawsCover) {
  Chain chain(1);
  Joint& joint = chain.joints[0];
  const auto drawn = [&](double lower, double upper) {
    joint.lower_limit = lower;
    joint.upper_limit = upper;
    return DrawnRange(chain.Model(), 0);
  };
  const std::pair whole(-kPi, kPi);
  EXPECT_EQ(drawn(-1.0, 2.0), std::pair(-1.0, 2.0));
  EXPECT_EQ(drawn(-100 * kPi, 100 * kPi), std::pair(-100 * kPi, 100 * kPi));
  EXPECT_EQ(drawn(-101 * kPi, 100 * kPi), whole);
  EXPECT_EQ(drawn(-1e308, 1e308), whole);
  EXPECT_EQ(drawn(-kUnlimited, kUnlimited), whole);
  EXPECT_EQ(drawn(1.0, kUnlimited), std::pair(1.0, 1.0 + 2 * kPi));
  EXPECT_EQ(drawn(-1e9, 2.0), std::pair(2.0 - 2 * kPi, 2.0 - 2 * kPi + 2 * kPi));
  joint.type = JointType::kPrismatic;
  EXPECT_EQ(drawn(-50.0, 50.0), std::pair(-50.0, 50.0));
  EXPECT_EQ(drawn(-50.0, 51.0), std::nullopt);
  EXPECT_EQ(drawn(0.0, kUnlimited), std::nullopt);
}

TEST(JointLimitsTest, ATurnDoesNotStandForAllIfAMimicDoesNotComeBack) {
  Chain chain(2);
  chain.joints[0].lower_limit = chain.joints[1].lower_limit = -1e9;
  chain.joints[0].upper_limit = chain.joints[1].upper_limit = 1e9;
  chain.joints[1].mimic = Mimic{0, -3.0, 0.1};
  EXPECT_TRUE(DrawnRange(chain.Model(), 0));
  chain.joints[1].mimic = Mimic{0, 0.5, 0.1};
  EXPECT_FALSE(DrawnRange(chain.Model(), 0));
  chain.joints[1].mimic = Mimic{0, 2.0, 0.1};
  chain.joints[1].type = JointType::kPrismatic;
  EXPECT_FALSE(DrawnRange(chain.Model(), 0));
}

TEST(JointLimitsTest, AMimicThatGoesFarIsNotCoveredByItsLeadersRange) {
  Chain chain(2);
  chain.joints[1].type = JointType::kPrismatic;
  chain.joints[1].lower_limit = -1e9;
  chain.joints[1].upper_limit = 1e9;
  chain.joints[1].mimic = Mimic{0, 49.0, 0.0};  // 98 m over the 2 rad of its leader
  EXPECT_TRUE(HasOwnRange(chain.Model(), 0));
  chain.joints[1].mimic = Mimic{0, -51.0, 0.0};
  EXPECT_FALSE(HasOwnRange(chain.Model(), 0));
  EXPECT_FALSE(DrawnRange(chain.Model(), 0));
}

TEST(JointLimitsTest, SpeaksOfTheSpeedThatNothingBounds) {
  Chain chain(2);
  chain.joints[0].velocity_limit = 0.0;
  chain.joints[1].velocity_limit = 1.0;
  EXPECT_THAT(LimitWarnings(chain.Model()),
              ElementsAre(AllOf(HasSubstr("joint 'a': velocity limit 0"), EndsWith("the speed"))));
  chain.joints[1].mimic = Mimic{0, -2.0, 0.0};
  EXPECT_THAT(LimitWarnings(chain.Model()),
              testing::Contains(AllOf(HasSubstr("joint 'a': velocity limit 0"),
                                      EndsWith("counts as not given"))));
}

TEST(JointLimitsTest, SaysThatARangeLooksLikeDegrees) {
  const auto warnings = [](JointType type, double lower, double upper) {
    Chain chain(1);
    chain.joints[0].type = type;
    chain.joints[0].lower_limit = lower;
    chain.joints[0].upper_limit = upper;
    return LimitWarnings(chain.Model());
  };
  EXPECT_THAT(warnings(JointType::kRevolute, -170.0, 170.0),
              ElementsAre("joint 'a': range [-170, 170] rad, 54 turns; it is kept, but looks like "
                          "degrees"));
  EXPECT_THAT(warnings(JointType::kRevolute, -170.5, 170.0), testing::IsEmpty());
  EXPECT_THAT(warnings(JointType::kRevolute, -6.0, 6.0), testing::IsEmpty());
  EXPECT_THAT(warnings(JointType::kPrismatic, -40.0, 40.0), testing::IsEmpty());
}

TEST(JointLimitsTest, SaysThatARangeIsTooWide) {
  Chain chain(2);
  chain.joints[0].lower_limit = -1e9;
  chain.joints[0].upper_limit = 1e9;
  chain.joints[1].type = JointType::kPrismatic;
  chain.joints[1].upper_limit = 1e308;
  EXPECT_THAT(LimitWarnings(chain.Model()),
              ElementsAre(AllOf(HasSubstr("'a': range [-1e+09, 1e+09] rad, wider than 100 turns"),
                                EndsWith("drawn from one turn")),
                          AllOf(HasSubstr("'b': range [-1, 1e+308] m, wider than 100 m"),
                                EndsWith("covers it"))));
}

TEST(JointLimitsTest, TellsStatesThatCannotBe) {
  Chain chain(2);
  chain.joints[1].type = JointType::kPrismatic;
  const auto wrong = [&](double a, double b) {
    return ImpossibleState(chain.Model(), Eigen::Vector2d(a, b));
  };
  EXPECT_EQ(wrong(0, 0), "");
  EXPECT_EQ(wrong(1.0 + 6.28, -10.9), "");
  EXPECT_EQ(wrong(1.0 + 6.29, 0),
            "position of joint 'a'; got 7.29 rad; expected -7.28319 to 7.28319, no joint more than "
            "2 pi rad or 10 m beyond its limits, nor beyond 1e6");
  EXPECT_THAT(wrong(0, -11.1), HasSubstr("joint 'b'; got -11.1 m; expected -11 to 11"));
  EXPECT_THAT(wrong(std::nan(""), 0), HasSubstr("got nan rad"));
  chain.joints[0].lower_limit = -1e308;
  chain.joints[0].upper_limit = 1e308;
  EXPECT_EQ(wrong(-1e6, 0), "");
  EXPECT_THAT(wrong(-1.1e6, 0), HasSubstr("expected -1e+06 to 1e+06"));
  chain.joints[1] = chain.joints[0];
  chain.joints[1].name = models::Name("b");
  chain.joints[1].parent_link = 1;
  chain.joints[1].child_link = 2;
  chain.joints[1].mimic = Mimic{0, 100.0, 0.0};
  EXPECT_THAT(ImpossibleState(chain.Model(), Eigen::VectorXd::Constant(1, 1e5)),
              HasSubstr("joint 'a'; got 100000 rad; expected -10000 to 10000"));
  chain.joints[1].mimic = Mimic{0, -2.0, 1.0};
  chain.joints[1].lower_limit = 0.0;
  chain.joints[1].upper_limit = 3.0;
  const auto [lower, upper] = PossibleRange(chain.Model(), 0);
  EXPECT_NEAR(lower, -1.0 - std::numbers::pi, 1e-12);  // where b stands at 3 + 2 pi
  EXPECT_NEAR(upper, 0.5 + std::numbers::pi, 1e-12);
}

}  // namespace joint_limits_test
}  // namespace oca::robot
