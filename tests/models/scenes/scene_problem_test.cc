// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/scene_problem.h"

#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/urdf.h"
#include "oca/models/scenes/motion_request.h"
#include "oca/models/scenes/scene_families.h"
#include "tests/temporary_folder.h"

namespace oca::scenes {
namespace scene_problem_test {

using testing::HasSubstr;

std::shared_ptr<const robot::RobotModel> Arm(const std::string& name) {
  const std::string folder = OCA_SOURCE_DIR "/models/robots/" + name + "/" + name;
  robot::LoadOptions options;
  options.srdf = folder + ".srdf";
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(folder + ".urdf", options));
}

class SceneProblemTest : public testing::TestWithParam<std::string_view> {};

TEST_P(SceneProblemTest, HasAStartAndAGoalThatAreClearAndReadsBackAsItWas) {
  const auto arm = Arm("ur5e");
  const int tip = robot::TipLink(*arm);
  const SceneProblem problem = MakeSceneProblem(arm, tip, GetParam(), 3);
  std::vector<robot::PlacedBody> bodies;
  for (const SceneObject& object : problem.objects) {
    bodies.push_back(
        {geometry::MakeCollider(std::get<geometry::Shape>(object.bodies[0].shape), object.id),
         object.X_FO});
  }
  robot::Clearance clearance(arm, true, bodies);
  for (const Eigen::VectorXd& q : {problem.start, problem.goal}) {
    EXPECT_TRUE((q.array() >= arm->lower_limits().array()).all());
    EXPECT_TRUE((q.array() <= arm->upper_limits().array()).all());
    clearance.MoveTo(q);
    EXPECT_GE(clearance.Nearest().distance, kProblemClearance);
  }
  EXPECT_GT((problem.goal - problem.start).norm(), 0.3);

  const test::TemporaryFolder folder;
  const std::string text = SceneYaml(*arm, problem);
  const PlanningScene scene = ReadPlanningScene(folder.Write("scene.yaml", text));
  EXPECT_EQ(scene.objects.size(), problem.objects.size());
  EXPECT_TRUE(scene.notes.empty());
  const MotionRequest request =
      ReadMotionRequest(folder.Write("request.yaml", RequestYaml(*arm, problem)));
  for (int i = 0; i < arm->num_positions(); ++i) {
    const std::string& joint = arm->position_names()[static_cast<std::size_t>(i)].text();
    EXPECT_EQ(*request.start.Find(joint), problem.start[i]);
    EXPECT_EQ(*request.goal.Find(joint), problem.goal[i]);
  }
  EXPECT_EQ(SceneYaml(*arm, MakeSceneProblem(arm, tip, GetParam(), 3)), text);
}

INSTANTIATE_TEST_SUITE_P(Families, SceneProblemTest, testing::ValuesIn(kSceneFamilies),
                         [](const auto& of) { return std::string(of.param); });

TEST(SceneProblemRefusalTest, OtherSeedsMakeOtherScenes) {
  models::Random one(1), other(2);
  const FurnishedScene a = Furnish("cage", 1.0, one), b = Furnish("cage", 1.0, other);
  EXPECT_EQ(a.objects.size(), b.objects.size());
  EXPECT_NE(a.target, b.target);
  models::Random again(1);
  EXPECT_EQ(Furnish("cage", 1.0, again).target, a.target);
  models::Random half(1);
  EXPECT_TRUE(Furnish("cage", 0.5, half).target.isApprox(0.5 * a.target));
}

TEST(SceneProblemRefusalTest, AnUnknownFamilyIsRefusedByItsNearestName) {
  models::Random random(1);
  EXPECT_THAT([&] { Furnish("cagee", 1.0, random); },
              testing::ThrowsMessage<models::ModelError>(
                  HasSubstr("family; got 'cagee'; expected one of scenes, nearest is 'cage'")));
}

TEST(SceneProblemRefusalTest, AnArmThatCannotPointDownIsRefused) {
  EXPECT_THAT([] { MakeSceneProblem(Arm("planar2"), 3, "cage", 0); },
              testing::ThrowsMessage<models::ModelError>(HasSubstr("posture of rest; got none")));
}

}  // namespace scene_problem_test
}  // namespace oca::scenes
