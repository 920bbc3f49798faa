// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <string>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::drafts {
namespace draft_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string Content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A six-axis arm of capsule-like boxes with a gripper of two jaws; `scale` stretches its links.
std::string ArmWithGripper(double scale, const std::string& limit = "velocity='2'") {
  std::string text = "<robot name='my arm'><link name='base'/>";
  const auto link = [&](const std::string& name, double length) {
    return "<link name='" + name + "'><collision><origin xyz='0 0 " +
           std::to_string(0.5 * length * scale) + "'/><geometry><cylinder radius='" +
           std::to_string(0.05 * scale) + "' length='" + std::to_string(0.7 * length * scale) +
           "'/></geometry></collision></link>";
  };
  const auto joint = [&](const std::string& name, const std::string& parent,
                         const std::string& axis, double offset) {
    return "<joint name='" + name + "' type='revolute'><parent link='" + parent +
           "'/><child link='" + name + "_link'/><origin xyz='0 0 " +
           std::to_string(offset * scale) + "'/><axis xyz='" + axis +
           "'/><limit lower='-2.8' upper='2.8' " + limit + "/></joint>";
  };
  const double lengths[] = {0.3, 0.4, 0.35, 0.1, 0.1, 0.1};
  const char* const axes[] = {"0 0 1", "0 1 0", "0 1 0", "0 1 0", "0 0 1", "0 1 0"};
  std::string parent = "base";
  double offset = 0.1;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "j" + std::to_string(i + 1);
    text += link(name + "_link", lengths[i]) + joint(name, parent, axes[i], offset);
    parent = name + "_link";
    offset = lengths[i];
  }
  for (const char* jaw : {"left", "right"}) {
    text += std::string("<link name='") + jaw + "_jaw'><collision><geometry><box size='" +
            std::to_string(0.01 * scale) +
            " 0.01 0.03'/></geometry></collision></link><joint name='" + jaw +
            "' type='prismatic'><parent link='" + parent + "'/><child link='" + jaw +
            "_jaw'/><origin xyz='0 0 " + std::to_string(0.12 * scale) +
            "'/><axis xyz='1 0 0'/><limit lower='0.01' upper='0.04' velocity='0.1'/></joint>";
  }
  return text + "</robot>";
}

class DraftTest : public testing::Test {
 protected:
  Draft Make(const std::string& urdf) {
    folder_.Write("my_arm.urdf", urdf);
    DraftOptions options;
    options.robot = folder_.path() / "my_arm.urdf";
    options.folder = folder_.path() / "out";
    options.warn = [this](const std::string& line) { warnings_ += line + "\n"; };
    options.progress = progress_;
    return MakeDraft(options);
  }
  std::function<bool(const std::string& task, double share)> progress_;
  test::TemporaryFolder folder_;
  std::string warnings_;
};

TEST_F(DraftTest, OfAnArmWithAGripperTouchesWithoutAvoidanceAndEvadesWithIt) {
  const Draft draft = Make(ArmWithGripper(1.0));
  EXPECT_EQ(draft.robot.model->num_positions(), 6);
  EXPECT_THAT(draft.robot.held,
              testing::ElementsAre(std::pair("left", 0.01), std::pair("right", 0.01)));
  EXPECT_TRUE(draft.attempt.contact());
  EXPECT_TRUE(draft.attempt.evaded());
  ASSERT_EQ(draft.files.size(), 2);
  EXPECT_EQ(draft.files[0], folder_.path() / "out/my_arm.yaml");
  EXPECT_EQ(draft.files[1], folder_.path() / "out/my_arm.srdf");
  // The file says what was run.
  const loading::LoadedDiagram loaded = loading::LoadDiagram(draft.diagram);
  EXPECT_EQ(loaded.models.Get("arm")->num_positions(), 6);
  EXPECT_THAT(Content(draft.diagram),
              AllOf(HasSubstr("urdf: \"../my_arm.urdf\""), HasSubstr("\"left\": 0.01"),
                    Not(HasSubstr("safe_distance"))));
}

TEST_F(DraftTest, IsRefusedByTheRobotsJointWhereThatIsTooSlow) {
  EXPECT_THAT([&] { Make(ArmWithGripper(1.0, "velocity='9e-4'")); },
              testing::ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("my_arm.urdf: joint 'j1': velocity limit; got 0.0009"),
                        Not(HasSubstr("-s ")))));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out"));
}

TEST_F(DraftTest, KnowsTheMethodsBeforeItLooksAtTheRobot) {
  DraftOptions options;
  options.robot = folder_.path() / "none.urdf";
  options.folder = folder_.path() / "out";
  options.avoidance = "bogus";
  EXPECT_THAT([&] { MakeDraft(options); },
              testing::ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("avoidance: got 'bogus'; expected one of: flacco, recommended"),
                        HasSubstr("safety_filter"))));
}

TEST_F(DraftTest, OfASmallArmHasSmallDistances) {
  const Draft draft = Make(ArmWithGripper(0.3));
  EXPECT_TRUE(draft.attempt.contact());
  EXPECT_TRUE(draft.attempt.evaded());
  EXPECT_THAT(Content(draft.diagram), HasSubstr("  scale: 0.38"));
}

/// A rail along x, a lift, and a boom of two segments along y with a tool at its end.
std::string Gantry() {
  std::string text = "<robot name='gantry'><link name='base'/>";
  const auto add = [&text](const std::string& link, const std::string& parent,
                           const std::string& origin, const std::string& axis,
                           const std::string& range, const std::string& solid) {
    text += "<link name='" + link + "'><collision>" + solid + "</collision></link><joint name='j" +
            link + "' type='prismatic'><parent link='" + parent + "'/><child link='" + link +
            "'/><origin xyz='" + origin + "'/><axis xyz='" + axis + "'/><limit lower='0' upper='" +
            range + "' velocity='1' effort='1'/></joint>";
  };
  add("rail", "base", "0 0 0.5", "1 0 0", "1.6", "<geometry><box size='0.1 0.1 0.1'/></geometry>");
  add("lift", "rail", "0 0 0.1", "0 0 1", "0.4", "<geometry><box size='0.1 0.1 0.1'/></geometry>");
  add("boom", "lift", "0 0 0", "0 1 0", "0.3",
      "<origin xyz='0 0.3 0'/><geometry><box size='0.06 0.4 0.06'/></geometry>");
  add("inner", "boom", "0 0.3 0", "0 1 0", "0.13",
      "<origin xyz='0 0.3 0'/><geometry><box size='0.04 0.3 0.04'/></geometry>");
  return text +
         "<link name='tool'><collision><geometry><sphere radius='0.04'/></geometry></collision>"
         "</link><joint name='at' type='fixed'><parent link='inner'/><child link='tool'/><origin "
         "xyz='0 0.5 0'/></joint></robot>";
}

TEST_F(DraftTest, OfSlidersAloneIsInMetres) {
  const Draft draft = Make(Gantry());
  EXPECT_EQ(draft.robot.model->num_positions(), 4);
  EXPECT_TRUE(draft.robot.held.empty());
  EXPECT_TRUE(draft.attempt.contact());
  const std::string text = Content(draft.diagram);
  EXPECT_THAT(text, AllOf(HasSubstr("    unit: m\n"), HasSubstr(", unit: m}"),
                          HasSubstr("# m; and no contact")));
  EXPECT_NO_THROW(loading::LoadDiagram(draft.diagram));
}

/// Three slides across each other of `range` m each, which carry a wrist of three joints.
std::string GantryWithWrist(double range) {
  std::string text = "<robot name='gantry'><link name='l0'/>";
  int links = 0;
  const auto add = [&](const char* type, const char* axis, double drop, double lower, double upper,
                       const std::string& solid) {
    const std::string parent = "l" + std::to_string(links), child = "l" + std::to_string(++links);
    text += "<link name='" + child + "'><collision>" + solid + "</collision></link><joint name='j" +
            std::to_string(links) + "' type='" + type + "'><parent link='" + parent +
            "'/><child link='" + child + "'/><origin xyz='0 0 " + std::to_string(-drop) +
            "'/><axis xyz='" + axis + "'/><limit lower='" + std::to_string(lower) + "' upper='" +
            std::to_string(upper) + "' velocity='1' effort='1'/></joint>";
  };
  const std::string block = "<geometry><box size='0.06 0.06 0.06'/></geometry>";
  const std::string segment =
      "<origin xyz='0 0 -0.06'/><geometry><cylinder radius='0.03' length='0.12'/></geometry>";
  for (const char* axis : {"1 0 0", "0 1 0", "0 0 -1"}) {
    add("prismatic", axis, 0.0, 0.0, range, block);
  }
  add("revolute", "0 0 1", 0.15, -3.0, 3.0, segment);
  add("revolute", "0 1 0", 0.12, -3.0, 3.0, segment);
  add("revolute", "0 0 1", 0.12, -3.0, 3.0, segment);
  return text +
         "<link name='tool'/><joint name='at' type='fixed'><parent link='l6'/><child link='tool'/>"
         "<origin xyz='0 0 -0.12'/></joint></robot>";
}

TEST_F(DraftTest, OfAGantryIsOfTheSizeThatItsSlidesAllow) {
  for (const double range : {0.3, 1.0}) {
    const Draft draft = Make(GantryWithWrist(range));
    EXPECT_EQ(draft.robot.model->num_positions(), 6);
    EXPECT_TRUE(draft.attempt.contact()) << range;
    EXPECT_TRUE(draft.attempt.evaded()) << range;
    const bool small = draft.attempt.motion.size < draft.robot.reach;
    EXPECT_EQ(small, range < 0.5) << range;
    if (small) {
      EXPECT_THAT(Content(draft.diagram), HasSubstr("  scale: 0.")) << range;
    }
    std::filesystem::remove_all(folder_.path() / "out");
  }
}

TEST_F(DraftTest, OfASlowArmIsOverInTenMinutesAndIsForeseenToItsEnd) {
  const Draft draft = Make(ArmWithGripper(1.0, "velocity='0.01'"));
  EXPECT_TRUE(draft.attempt.contact());
  EXPECT_TRUE(draft.attempt.evaded());
  const loading::LoadedDiagram loaded = loading::LoadDiagram(draft.diagram);
  EXPECT_LE(loaded.simulator.duration, 601.0);
  EXPECT_THAT(Content(draft.diagram), HasSubstr("  time_scale: 12 "));
}

TEST_F(DraftTest, FillsInLimitsThatAreMissing) {
  const Draft draft = Make(ArmWithGripper(1.0, "velocity='0'"));
  ASSERT_EQ(draft.files.size(), 3);
  EXPECT_THAT(Content(folder_.path() / "out/my_arm_limits.yaml"),
              HasSubstr("\"j3\": {has_velocity_limits: true, max_velocity: 1}   # rad/s; a guess"));
  const auto loaded = loading::LoadDiagram(draft.diagram);
  EXPECT_EQ(loaded.models.Get("arm")->velocity_limits(), Eigen::VectorXd::Ones(6));
}

TEST_F(DraftTest, EndsWhenToldToAndLeavesNothing) {
  std::set<std::string> tasks;
  progress_ = [&](const std::string& task, double share) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    tasks.insert(task);
    return true;
  };
  Make(ArmWithGripper(1.0));
  EXPECT_THAT(tasks,
              testing::IsSupersetOf({"looking at pairs of links", "looking for a first motion",
                                     "trying motion 1 without avoidance"}));
  std::filesystem::remove_all(folder_.path() / "out");
  for (const std::string& last : tasks) {
    progress_ = [&](const std::string& task, double) { return task != last; };
    Make(ArmWithGripper(1.0));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out")) << last;
  }
}

TEST_F(DraftTest, ReplacesNothing) {
  folder_.Write("out/my_arm.yaml", "mine\n");
  EXPECT_THROW(Make(ArmWithGripper(1.0)), ConfigError);
  EXPECT_EQ(Content(folder_.path() / "out/my_arm.yaml"), "mine\n");
}

TEST_F(DraftTest, RefusesWhatIsNoRobot) {
  EXPECT_THROW(Make("<robot name='r'><link name='a'/></robot>"), models::ModelError);
  EXPECT_THROW(Make("robot"), models::ModelError);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out"));
}

}  // namespace draft_test
}  // namespace oca::drafts
