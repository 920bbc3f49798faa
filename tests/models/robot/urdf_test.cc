// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "tests/models/robot/random_robot.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace urdf_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kPi = std::numbers::pi;

const char* const kArm = R"(<robot name="arm">
  <material name="red"><color rgba="1 0 0 0.5"/></material>
  <link name="base"/>
  <link name="upper">
    <inertial><origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/><mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/></inertial>
    <visual><geometry><box size="1 2 3"/></geometry><material name="red"/></visual>
    <collision><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>
      <geometry><box size="1 2 3"/></geometry></collision>
    <collision><geometry><sphere radius="0.5"/></geometry></collision>
    <collision><geometry><cylinder radius="0.5" length="4"/></geometry></collision>
  </link>
  <link name="hand"/><link name="finger"/>
  <joint name="z_last" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="2" velocity="3" effort="4" acceleration="5" jerk="6"/></joint>
  <joint name="turn" type="continuous"><parent link="upper"/><child link="hand"/></joint>
  <joint name="a_first" type="prismatic"><parent link="hand"/><child link="finger"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.1" velocity="0.2" effort="7"/></joint>
</robot>)";

TEST(UrdfTest, ReadsTheTreeInTheOrderOfTheFile) {
  const RobotModel model = ParseUrdf(kArm, "arm.urdf");
  EXPECT_EQ(model.name(), models::Name("arm"));
  ASSERT_EQ(model.num_links(), 4);
  EXPECT_EQ(model.position_names()[0], models::Name("z_last"));
  EXPECT_EQ(model.position_names()[1], models::Name("turn"));
  EXPECT_EQ(model.position_names()[2], models::Name("a_first"));
  EXPECT_EQ(model.joints()[0].type, JointType::kRevolute);
  EXPECT_EQ(model.joints()[1].type, JointType::kContinuous);
  EXPECT_EQ(model.joints()[2].type, JointType::kPrismatic);
  EXPECT_EQ(model.joints()[0].axis, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(model.joints()[1].axis, Eigen::Vector3d::UnitX());
  EXPECT_EQ(model.joints()[0].X_PJ.translation(), Eigen::Vector3d(0, 0, 1));
}

TEST(UrdfTest, ReadsLimits) {
  const RobotModel model = ParseUrdf(kArm, "arm.urdf");
  EXPECT_EQ(model.lower_limits(), Eigen::Vector3d(-1, -kUnlimited, 0));
  EXPECT_EQ(model.upper_limits(), Eigen::Vector3d(2, kUnlimited, 0.1));
  EXPECT_EQ(model.velocity_limits(), Eigen::Vector3d(3, kUnlimited, 0.2));
  EXPECT_EQ(model.effort_limits(), Eigen::Vector3d(4, kUnlimited, 7));
  EXPECT_EQ(model.acceleration_limits(), Eigen::Vector3d(5, kUnlimited, kUnlimited));
  EXPECT_EQ(model.jerk_limits(), Eigen::Vector3d(6, kUnlimited, kUnlimited));
}

TEST(UrdfTest, ContinuousJointHasNoRangeEvenIfTheFileGivesOne) {
  const RobotModel model = ParseUrdf(
      R"(<robot name="r"><link name="a"/><link name="b"/>
         <joint name="spin" type="continuous"><parent link="a"/><child link="b"/>
         <limit lower="-1" upper="1" velocity="2" effort="3"/></joint></robot>)",
      "r.urdf");
  EXPECT_EQ(model.lower_limits()[0], -kUnlimited);
  EXPECT_EQ(model.upper_limits()[0], kUnlimited);
  EXPECT_EQ(model.velocity_limits()[0], 2.0);
}

TEST(UrdfTest, ReadsCollisionShapesWithPoseAndPlace) {
  const RobotModel model = ParseUrdf(kArm, "arm.urdf");
  const std::vector<CollisionElement>& collisions = model.links()[1].collisions;
  ASSERT_EQ(collisions.size(), 3u);
  EXPECT_EQ(std::get<geometry::Box>(collisions[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<geometry::Sphere>(collisions[1].shape).radius, 0.5);
  EXPECT_EQ(std::get<geometry::Cylinder>(collisions[2].shape).length, 4.0);
  EXPECT_EQ(collisions[1].source, "arm.urdf:10: link 'upper' collision");
  // Fixed axes: roll first, yaw last.
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  EXPECT_LT((collisions[0].X_LC.linear() - R).norm(), 1e-15);
  EXPECT_EQ(collisions[0].X_LC.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(UrdfTest, ReadsVisualsAndInertia) {
  const RobotModel model = ParseUrdf(kArm, "arm.urdf");
  const Link& upper = model.links()[1];
  ASSERT_EQ(upper.visuals.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<geometry::Box>(*upper.visuals[0].shape));
  EXPECT_EQ(upper.visuals[0].colour, Eigen::Vector4d(1, 0, 0, 0.5));
  EXPECT_EQ(upper.inertia.mass, 2.0);
  EXPECT_EQ(upper.inertia.p_LC, Eigen::Vector3d(0, 0, 0.1));
  // A quarter turn about z swaps the first two moments.
  const Eigen::Matrix3d I = Eigen::Vector3d(2, 1, 3).asDiagonal();
  EXPECT_LT((upper.inertia.I_C - I).norm(), 1e-15);
  LoadOptions options;
  options.load_visuals = false;
  EXPECT_EQ(ParseUrdf(kArm, "arm.urdf", options).links()[1].visuals.size(), 1u);
}

TEST(UrdfTest, AccelerationLimitsAreOneForAllOrOneAPosition) {
  LoadOptions options;
  options.acceleration_limits = Eigen::VectorXd::Constant(1, 9.0);
  options.jerk_limits = Eigen::Vector3d(1, 2, 3);
  const RobotModel model = ParseUrdf(kArm, "arm.urdf", options);
  EXPECT_EQ(model.acceleration_limits(), Eigen::Vector3d::Constant(9.0));
  EXPECT_EQ(model.jerk_limits(), Eigen::Vector3d(1, 2, 3));
  for (const int wrong : {2, 4}) {
    options.acceleration_limits = Eigen::VectorXd::Ones(wrong);
    EXPECT_THAT([&] { ParseUrdf(kArm, "arm.urdf", options); },
                ThrowsMessage<models::ModelError>(HasSubstr("acceleration_limits")));
  }
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    options.acceleration_limits = Eigen::Vector3d(1, wrong, 1);
    EXPECT_THAT([&] { ParseUrdf(kArm, "arm.urdf", options); },
                ThrowsMessage<models::ModelError>(HasSubstr("'turn'")));
  }
}

TEST(UrdfTest, BasePoseThatIsNotFiniteIsRefused) {
  LoadOptions options;
  options.X_WB.translation().x() = std::nan("");
  EXPECT_THROW(ParseUrdf(kArm, "arm.urdf", options), models::ModelError);
}

TEST(UrdfTest, BranchesAreVisitedDepthFirst) {
  const std::string text = R"(<robot name="tree"><link name="root"/><link name="b"/>
    <link name="a"/><link name="a_tip"/>
    <joint name="to_a" type="fixed"><parent link="root"/><child link="a"/></joint>
    <joint name="to_b" type="fixed"><parent link="root"/><child link="b"/></joint>
    <joint name="on" type="fixed"><parent link="a"/><child link="a_tip"/></joint></robot>)";
  const RobotModel model = ParseUrdf(text, "tree.urdf");
  std::vector<std::string> names;
  for (const Link& link : model.links()) names.push_back(link.name.text());
  EXPECT_THAT(names, testing::ElementsAre("root", "a", "a_tip", "b"));
}

TEST(UrdfTest, ALongChainNeedsNoDeepStack) {
  std::string text = "<robot name='chain'><link name='0'/>";
  for (int i = 1; i <= 5000; ++i) {
    text += "<link name='" + std::to_string(i) + "'/><joint name='j" + std::to_string(i) +
            "' type='fixed'><parent link='" + std::to_string(i - 1) + "'/><child link='" +
            std::to_string(i) + "'/></joint>";
  }
  EXPECT_EQ(ParseUrdf(text + "</robot>", "chain.urdf").num_links(), 5001);
}

TEST(UrdfTest, NothingIsPrintedWhileUrdfdomComplains) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  ParseUrdf(R"(<robot name="r"><link name="a"><visual><geometry><sphere radius="1"/></geometry>
               <material name="never defined"/></visual></link></robot>)",
            "r.urdf");
  EXPECT_THAT([] { ParseUrdf("<robot name='r' version='7.0'><link name='a'/></robot>", "r.urdf"); },
              ThrowsMessage<models::ModelError>(
                  testing::Eq("r.urdf:1: <robot>: version; got 7.0; expected 1.0 or 1.1")));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

// A tetrahedron in a folder laid out as a package.
class MeshTest : public testing::Test {
 protected:
  void SetUp() override {
    temporary_.Write("parts/meshes/tetra.obj",
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  }

  static std::string WithMesh(const std::string& path, const char* element = "collision") {
    return std::string("<robot name='r'><link name='a'><") + element +
           "><geometry><mesh filename='" + path + "' scale='2 2 2'/></geometry></" + element +
           "></link></robot>";
  }

  const oca::test::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

TEST_F(MeshTest, RelativePathsStartAtTheFilesFolder) {
  std::ofstream(folder_ / "r.urdf") << WithMesh("parts/meshes/tetra.obj");
  const RobotModel model = LoadUrdf(folder_ / "r.urdf");
  EXPECT_TRUE(std::holds_alternative<geometry::ConvexMesh>(model.links()[0].collisions[0].shape));
}

TEST_F(MeshTest, PackagesAreFoundByFolderOrByFunction) {
  const std::string text = WithMesh("package://parts/meshes/tetra.obj", "visual");
  const std::string file = (folder_ / "parts/meshes/tetra.obj").string();
  LoadOptions by_folder;
  by_folder.package_directories = {"/nowhere", folder_};
  const VisualElement visual = ParseUrdf(text, "r.urdf", by_folder).links()[0].visuals[0];
  EXPECT_EQ(visual.mesh_file, file);
  EXPECT_EQ(visual.mesh_scale, Eigen::Vector3d::Constant(2.0));
  LoadOptions by_function;
  by_function.find_package = [this](const std::string& package) { return folder_ / package; };
  EXPECT_EQ(ParseUrdf(text, "r.urdf", by_function).links()[0].visuals[0].mesh_file, file);
}

TEST_F(MeshTest, UrisMayHaveEscapes) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string spaced = temporary_.Write("parts/two words.obj", text).string();
  const std::string percent = temporary_.Write("parts/100%25.obj", text).string();
  LoadOptions options;
  options.package_directories = {folder_};
  const auto found = [&](const std::string& name) {
    const RobotModel robot = ParseUrdf(WithMesh(name, "visual"), "r.urdf", options, folder_);
    return robot.links()[0].visuals.empty() ? "" : robot.links()[0].visuals[0].mesh_file;
  };
  const std::string folder = folder_.string();
  EXPECT_EQ(found("package://parts/two%20words.obj"), spaced);
  EXPECT_EQ(found("package://parts/two words.obj"), spaced);
  EXPECT_EQ(found("file://" + folder + "/parts/two%20words.obj"), spaced);
  EXPECT_EQ(found("file:" + folder + "/parts/two%20words.obj"), spaced);
  EXPECT_EQ(found("file://localhost" + folder + "/parts/two%20words.obj"), spaced);
  EXPECT_EQ(found("package://parts/100%25.obj"), percent);  // written without escapes
  EXPECT_EQ(found("parts/two%20words.obj"), "");            // no URI
}

TEST_F(MeshTest, MissingFilesAreRefusedWithTheNameOfTheLink) {
  for (const char* path : {"none.obj", "package://parts/none.obj", "package://unknown/none.obj",
                           "package://parts", "file:///none.obj"}) {
    LoadOptions options;
    options.package_directories = {folder_};
    EXPECT_THAT([&] { ParseUrdf(WithMesh(path, "collision"), "r.urdf", options, folder_); },
                ThrowsMessage<models::ModelError>(testing::AllOf(
                    HasSubstr("missing mesh file"), HasSubstr("link 'a'"), HasSubstr(path))));
  }
}

TEST_F(MeshTest, MeshesThatAreNoMeshesAreRefusedWithTheNameOfTheLink) {
  std::ofstream(folder_ / "junk.obj") << "nothing";
  EXPECT_THAT([&] { ParseUrdf(WithMesh("junk.obj"), "r.urdf", {}, folder_); },
              ThrowsMessage<models::ModelError>(
                  testing::AllOf(HasSubstr("junk.obj"), HasSubstr("link 'a'"))));
}

TEST(UrdfTest, PublicArmsHaveSevenJointsAndAMeshALink) {
  for (const char* file : {"kuka_lwr/kuka.urdf", "kuka_iiwa/model.urdf"}) {
    if (!std::filesystem::exists(SharedRobot(file))) GTEST_SKIP() << "shared test data absent";
    const RobotModel model = LoadUrdf(SharedRobot(file));
    EXPECT_EQ(model.num_positions(), 7);
    for (const Link& link : model.links()) {
      ASSERT_EQ(link.collisions.size(), 1u) << link.name.text();
      EXPECT_TRUE(std::holds_alternative<geometry::ConvexMesh>(link.collisions[0].shape));
    }
  }
}

TEST(UrdfTest, AngleOfAQuarterTurnIsExactToTheLastDigits) {
  const RobotModel model = ParseUrdf(kArm, "arm.urdf");
  const auto X_WL = LinkPoses(model, Eigen::Vector3d(kPi / 2, 0, 0));
  EXPECT_LT((X_WL[1].linear().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-16);
}

}  // namespace urdf_test
}  // namespace oca::robot::test
