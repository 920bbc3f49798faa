// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/arm_guess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"

namespace oca::planning {
namespace arm_guess_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Names = std::vector<std::string>;

/// A robot in text: its joints, each as `NAME PARENT TYPE EXTRA`, lead to links of their names.
class Tree {
 public:
  Tree& Add(const std::string& name, const std::string& parent,
            const std::string& type = "revolute", const std::string& extra = "") {
    const std::string range =
        type == "prismatic" ? "lower='0' upper='0.04'" : "lower='-2' upper='2'";
    text_ += "<link name='" + name + "'/><joint name='" + name + "' type='" + type +
             "'><parent link='" + parent + "'/><child link='" + name +
             "'/><origin xyz='0 0 0.1'/><limit " + range + " velocity='1'/>" + extra + "</joint>";
    return *this;
  }
  Tree& Chain(const std::string& prefix, const std::string& parent, int joints) {
    std::string from = parent;
    for (int i = 1; i <= joints; ++i) {
      Add(prefix + std::to_string(i), from);
      from = prefix + std::to_string(i);
    }
    return *this;
  }
  robot::RobotModel Robot() const {
    return robot::ParseUrdf("<robot name='r'><link name='base'/>" + text_ + "</robot>", "r.urdf");
  }

 private:
  std::string text_;
};

struct Guess {
  Names joints, others;
  std::string tip;
};

Guess GuessOf(const robot::RobotModel& model) {
  const ArmGuess guess = GuessArm(model);
  const auto names = [&](const std::vector<int>& joints) {
    Names result;
    for (const int j : joints) result.push_back(model.joints()[j].name.text());
    return result;
  };
  return {names(guess.joints), names(guess.others), model.links()[guess.tip].name.text()};
}

std::string Mimic(const std::string& leader) { return "<mimic joint='" + leader + "'/>"; }

TEST(ArmGuessTest, OfAChainIsAllOfItUpToItsFarthestFrame) {
  const Guess guess = GuessOf(Tree()
                                  .Chain("j", "base", 6)
                                  .Add("flange", "j6", "fixed")
                                  .Add("tool", "flange", "fixed")
                                  .Robot());
  EXPECT_THAT(guess.joints, ElementsAre("j1", "j2", "j3", "j4", "j5", "j6"));
  EXPECT_THAT(guess.others, IsEmpty());
  EXPECT_EQ(guess.tip, "tool");
}

TEST(ArmGuessTest, EndsWhereFingersBranch) {
  const Guess guess = GuessOf(Tree()
                                  .Chain("j", "base", 7)
                                  .Add("hand", "j7", "fixed")
                                  .Add("left", "hand", "prismatic")
                                  .Add("right", "hand", "prismatic", Mimic("left"))
                                  .Robot());
  EXPECT_EQ(guess.joints.size(), 7);
  EXPECT_THAT(guess.others, ElementsAre("left"));
  EXPECT_EQ(guess.tip, "hand");
}

TEST(ArmGuessTest, EndsAtAJawThatOthersMimic) {
  const Guess guess = GuessOf(Tree()
                                  .Chain("j", "base", 6)
                                  .Add("drive", "j6")
                                  .Add("inner", "j6", "revolute", Mimic("drive"))
                                  .Robot());
  EXPECT_EQ(guess.joints.size(), 6);
  EXPECT_THAT(guess.others, ElementsAre("drive"));
  EXPECT_EQ(guess.tip, "j6");
}

TEST(ArmGuessTest, EndsAtAJawThatItsNameTells) {
  for (const char* name :
       {"gripper", "Gripper_joint", "grip_drive", "left_finger", "moving_jaw", "claw"}) {
    const Guess guess = GuessOf(Tree().Chain("j", "base", 5).Add(name, "j5").Robot());
    EXPECT_EQ(guess.joints.size(), 5) << name;
    EXPECT_THAT(guess.others, ElementsAre(name));
    EXPECT_EQ(guess.tip, "j5");
  }
}

TEST(ArmGuessTest, AShortSlideThatCarriesAWristIsNoJaw) {
  const Guess guess = GuessOf(
      Tree().Chain("j", "base", 4).Add("slide", "j4", "prismatic").Add("wrist", "slide").Robot());
  EXPECT_THAT(guess.joints, ElementsAre("j1", "j2", "j3", "j4", "slide", "wrist"));
  EXPECT_THAT(guess.others, IsEmpty());
}

TEST(ArmGuessTest, ATelescopeIsNoJawAndASlideAcrossIs) {
  Tree lift;
  lift.Chain("j", "base", 3).Add("s1", "j3", "prismatic", "<axis xyz='0 1 0'/>");
  lift.Add("plate", "s1", "fixed");
  Tree across = lift;
  const Guess telescope =
      GuessOf(lift.Add("s2", "plate", "prismatic", "<axis xyz='0 -1 0'/>").Robot());
  EXPECT_THAT(telescope.joints, ElementsAre("j1", "j2", "j3", "s1", "s2"));
  const Guess jaw = GuessOf(across.Add("s2", "plate", "prismatic", "<axis xyz='1 0 0'/>").Robot());
  EXPECT_THAT(jaw.joints, ElementsAre("j1", "j2", "j3", "s1"));
  EXPECT_THAT(jaw.others, ElementsAre("s2"));
}

Names BesideArm(const robot::RobotModel& model) {
  Names names;
  for (const int j : JointsBesideArm(model)) names.push_back(model.joints()[j].name.text());
  return names;
}

TEST(JointsBesideArmTest, AreFingersOfHoweverShortAnArm) {
  EXPECT_THAT(BesideArm(Tree()
                            .Chain("j", "base", 2)
                            .Add("left", "j2", "prismatic")
                            .Add("right", "j2", "prismatic", Mimic("left"))
                            .Robot()),
              ElementsAre("left"));
  EXPECT_THAT(BesideArm(Tree().Chain("j", "base", 2).Add("gripper", "j2").Robot()),
              ElementsAre("gripper"));
  EXPECT_THAT(BesideArm(Tree().Chain("j", "base", 6).Add("left_finger", "j6").Robot()),
              ElementsAre("left_finger"));
}

TEST(JointsBesideArmTest, AreNoneOfAnArmAlone) {
  EXPECT_THAT(BesideArm(Tree().Chain("j", "base", 3).Robot()), IsEmpty());
  // A linkage that the last joint carries keeps the hand level.
  EXPECT_THAT(
      BesideArm(Tree().Chain("j", "base", 3).Add("level", "j3", "revolute", Mimic("j3")).Robot()),
      IsEmpty());
  EXPECT_THAT(BesideArm(Tree().Add("j1", "base").Robot()), IsEmpty());
}

TEST(ArmGuessTest, OfAHandWithFingersOfFourJointsIsTheArmAlone) {
  Tree tree;
  tree.Chain("j", "base", 6);
  for (const char* finger : {"a", "b", "c", "d"}) tree.Chain(finger, "j6", 4);
  const Guess guess = GuessOf(tree.Robot());
  EXPECT_EQ(guess.joints.size(), 6);
  EXPECT_EQ(guess.others.size(), 16);
}

TEST(ArmGuessTest, WheelsHeadAndTorsoAreHeld) {
  const Guess guess = GuessOf(Tree()
                                  .Add("wheel_l", "base", "continuous")
                                  .Add("wheel_r", "base", "continuous")
                                  .Add("torso", "base", "prismatic")
                                  .Chain("head", "torso", 2)
                                  .Chain("arm", "torso", 7)
                                  .Robot());
  EXPECT_THAT(guess.joints, ElementsAre("arm1", "arm2", "arm3", "arm4", "arm5", "arm6", "arm7"));
  EXPECT_THAT(guess.others, ElementsAre("wheel_l", "wheel_r", "torso", "head1", "head2"));
}

TEST(ArmGuessTest, OfTwoArmsTheFirstAndTheOtherIsHeld) {
  const Guess guess = GuessOf(
      Tree().Add("torso", "base").Chain("left", "torso", 5).Chain("right", "torso", 5).Robot());
  EXPECT_THAT(guess.joints, ElementsAre("torso", "left1", "left2", "left3", "left4", "left5"));
  EXPECT_EQ(guess.others.size(), 5);
}

TEST(ArmGuessTest, MimicsWithinTheChainBelongToIt) {
  const Guess guess = GuessOf(Tree()
                                  .Chain("j", "base", 3)
                                  .Add("level", "j3", "revolute", Mimic("j3"))
                                  .Add("wrist", "level")
                                  .Robot());
  EXPECT_THAT(guess.joints, ElementsAre("j1", "j2", "j3", "wrist"));
  EXPECT_EQ(guess.tip, "wrist");
}

TEST(ArmGuessTest, RefusesWhatIsNoArm) {
  try {
    GuessArm(Tree().Add("turntable", "base").Robot());
    FAIL();
  } catch (const models::ModelError& error) {
    EXPECT_THAT(error.what(), HasSubstr("robot 'r': its arm; got 1 joint one after the other"));
  }
}

}  // namespace arm_guess_test
}  // namespace oca::planning
