// SPDX-License-Identifier: BSD-3-Clause
// The LWR 4 of the product, against the facts it was written from.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oca/models/geometry/convex_hull.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/link_colliders.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace lwr4_test {

constexpr double kDegree = std::numbers::pi / 180.0;

RobotModel Load(const std::string& name, double base_height = 0.0) {
  LoadOptions options;
  options.srdf = ProductFile(name + ".srdf");
  options.X_WB.translation().z() = base_height;
  return LoadUrdf(ProductFile(name + ".urdf"), options);
}

RobotModel Lwr4(double base_height = 0.0) { return Load("robots/lwr4/lwr4", base_height); }

// The segment from a to b under its skin of thickness `radius`.
struct Segment {
  Eigen::Vector3d a, b;
  double radius;
};

Segment SegmentOf(const CollisionElement& element, const Eigen::Isometry3d& X_WL) {
  const Eigen::Isometry3d X_WC = X_WL * element.X_LC;
  double radius = 0.0;
  double length = 0.0;
  if (const auto* sphere = std::get_if<geometry::Sphere>(&element.shape)) radius = sphere->radius;
  if (const auto* capsule = std::get_if<geometry::Capsule>(&element.shape)) {
    radius = capsule->radius;
    length = capsule->length;
  }
  // A capsule around a cylinder holds more than the cylinder.
  if (const auto* cylinder = std::get_if<geometry::Cylinder>(&element.shape)) {
    radius = cylinder->radius;
    length = cylinder->length;
  }
  return {X_WC * Eigen::Vector3d(0, 0, length / 2), X_WC * Eigen::Vector3d(0, 0, -length / 2),
          radius};
}

// The least of a convex function on [0, 1], by thirds.
template <typename Function>
double Least(const Function& function) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    (function(left) <= function(right) ? high : low) =
        function(left) <= function(right) ? right : left;
  }
  return function((low + high) / 2);
}

double Distance(const Segment& one, const Segment& two) {
  const auto to_two = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d along = two.b - two.a;
    const double t =
        along.isZero() ? 0.0 : std::clamp((p - two.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - two.a - t * along).norm();
  };
  return Least([&](double s) { return to_two(one.a + s * (one.b - one.a)); }) - one.radius -
         two.radius;
}

TEST(Lwr4Test, FlangeStandsAtItsPublishedHeight) {
  const RobotModel model = Lwr4();
  ASSERT_EQ(model.num_positions(), 7);
  const auto X_WL = LinkPoses(model, Eigen::VectorXd::Zero(7));
  const Eigen::Isometry3d& X_WF = X_WL[model.FindLink("lwr4_flange")];
  EXPECT_LT((X_WF.translation() - Eigen::Vector3d(0, 0, 1.1785)).norm(), 1e-15);
  EXPECT_TRUE(X_WF.linear().isIdentity(0.0));
  EXPECT_EQ(model.body(model.FindLink("lwr4_flange")), model.FindLink("lwr4_link_7"));
}

TEST(Lwr4Test, AxesAndOffsetsAreThePublishedOnes) {
  const RobotModel model = Lwr4();
  const auto X_WL = LinkPoses(model, Eigen::VectorXd::Zero(7));
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  const std::vector<Eigen::Vector3d> axes{z, y, z, -y, z, y, z};
  const double heights[] = {0.11, 0.3105, 0.5105, 0.7105, 0.9105, 1.1005, 1.1785};
  for (int j = 0; j < 7; ++j) {
    EXPECT_EQ(X_WL[j + 1].linear() * model.joints()[j].axis, axes[j]) << j;
    EXPECT_NEAR(X_WL[j + 1].translation().z(), heights[j], 1e-15) << j;
  }
}

TEST(Lwr4Test, LimitsAreThePublishedOnes) {
  const RobotModel model = Lwr4();
  const double position[] = {170, 120, 170, 120, 170, 120, 170};
  const double velocity[] = {110, 110, 130, 130, 130, 180, 180};
  const double effort[] = {176, 176, 100, 100, 100, 38, 38};
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(model.upper_limits()[i], position[i] * kDegree, 1e-15);
    EXPECT_EQ(model.lower_limits()[i], -model.upper_limits()[i]);
    EXPECT_NEAR(model.velocity_limits()[i], velocity[i] * kDegree, 1e-15);
    EXPECT_EQ(model.effort_limits()[i], effort[i]);
  }
  EXPECT_EQ(model.position_unit(), "rad");
}

TEST(Lwr4Test, MovingLinksAreOneRoundShapeEach) {
  const RobotModel model = Lwr4();
  for (int link = 1; link <= 7; ++link) {
    ASSERT_EQ(model.links()[link].collisions.size(), 1u);
    const geometry::Shape& shape = model.links()[link].collisions[0].shape;
    EXPECT_EQ(std::holds_alternative<geometry::Capsule>(shape), link < 7);
    EXPECT_EQ(std::holds_alternative<geometry::Sphere>(shape), link == 7);
  }
}

TEST(Lwr4Test, MassIsAboutThatOfTheArm) {
  double mass = 0.0;
  const RobotModel model = Lwr4();
  for (const Link& link : model.links()) {
    mass += link.inertia.mass;
    // Moments of a real body obey the triangle inequality.
    const Eigen::Vector3d I = link.inertia.I_C.diagonal();
    EXPECT_LE(2.0 * I.maxCoeff(), I.sum() + 1e-12);
  }
  EXPECT_GT(mass, 14.0);
  EXPECT_LT(mass, 22.0);
}

// Least distance of each pair over many positions, limits included.
TEST(Lwr4Test, DisabledPairsCannotCollideUnlessTheyAreNeighbours) {
  const RobotModel model = Lwr4();
  Random random(51);
  std::vector<Eigen::Isometry3d> X_WL(model.num_links());
  Eigen::MatrixXd least = Eigen::MatrixXd::Constant(8, 8, kUnlimited);
  for (int i = 0; i < 3000; ++i) {
    Eigen::VectorXd q(7);
    for (int j = 0; j < 7; ++j) {
      const double draw = Uniform(random, -1.4, 1.4);  // the limits themselves are drawn often
      q[j] = std::clamp(draw, -1.0, 1.0) * model.upper_limits()[j];
    }
    ForwardKinematics(model, q, X_WL);
    for (int a = 0; a < 8; ++a) {
      for (int b = a + 2; b < 8; ++b) {
        const double distance = Distance(SegmentOf(model.links()[a].collisions[0], X_WL[a]),
                                         SegmentOf(model.links()[b].collisions[0], X_WL[b]));
        least(a, b) = std::min(least(a, b), distance);
      }
    }
  }
  for (int a = 0; a < 8; ++a) {
    EXPECT_TRUE(a == 7 || model.collision_disabled(a, a + 1));
    for (int b = a + 2; b < 8; ++b) {
      const bool across_the_wrist = a == 5 && b == 7;
      if (model.collision_disabled(a, b) && !across_the_wrist) {
        EXPECT_GT(least(a, b), 0.02) << a << " " << b;
      }
    }
  }
  // And the pairs that can meet are checked.
  EXPECT_LT(least(0, 6), 0.0);
  for (int link : {5, 6, 7}) EXPECT_FALSE(model.collision_disabled(0, link));
  for (int link : {6, 7}) EXPECT_FALSE(model.collision_disabled(1, link));
}

// How far a segment's skin is inside the box |x| < half, by separating directions; a lower bound
// on the signed distance outside.
double SignedDistanceToBox(const Segment& segment, double half) {
  const Eigen::Vector3d along = segment.b - segment.a;
  double distance = -kUnlimited;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i % 3);
    Eigen::Vector3d direction = i < 3 ? unit : Eigen::Vector3d(along.cross(unit));
    if (direction.norm() < 1e-9) continue;
    direction.normalize();
    for (const double sign : {1.0, -1.0}) {
      const double nearest =
          std::min(sign * direction.dot(segment.a), sign * direction.dot(segment.b));
      distance = std::max(distance, nearest - half * direction.cwiseAbs().sum());
    }
  }
  return distance - segment.radius;
}

TEST(Lwr4Test, StaticTestOfTheReportPassesThroughItsBox) {
  // An independent implementation measured -0.122 m on an arm of about these radii.
  const RobotModel model = Lwr4(0.85);
  Eigen::VectorXd home(7), goal(7);
  home << 0, 85, 0, -35, 0, 30, 0;
  goal << 157.5, 85, -30, -35, 0, 30, 0;
  double least = kUnlimited;
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    const double share = s * s * (3.0 - 2.0 * s);
    const auto X_WL = LinkPoses(model, kDegree * (home + share * (goal - home)));
    for (int link = 1; link <= 7; ++link) {
      Segment segment = SegmentOf(model.links()[link].collisions[0], X_WL[link]);
      for (Eigen::Vector3d* end : {&segment.a, &segment.b}) *end -= Eigen::Vector3d(0, 0.6, 1.0);
      least = std::min(least, SignedDistanceToBox(segment, 0.1));
    }
  }
  EXPECT_NEAR(least, -0.1216, 5e-4);
}

TEST(Lwr4Test, MeshesAreTheSameArmInItsHousings) {
  const RobotModel plain = Lwr4();
  const RobotModel meshes = Load("robots/lwr4/lwr4_meshes");
  ASSERT_EQ(meshes.num_links(), plain.num_links());
  Random random(71);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = RandomPositions(plain, random);
    const auto one = LinkPoses(plain, q), two = LinkPoses(meshes, q);
    for (int link = 0; link < plain.num_links(); ++link) {
      EXPECT_EQ(one[link].matrix(), two[link].matrix());
      EXPECT_EQ(meshes.links()[link].name, plain.links()[link].name);
    }
  }
  for (int link = 0; link < 8; ++link) {
    const Link& housing = meshes.links()[link];
    ASSERT_EQ(housing.collisions.size(), link == 5 ? 2u : 1u);  // forearm and fork
    ASSERT_EQ(housing.visuals.size(), housing.collisions.size());
    for (std::size_t i = 0; i < housing.collisions.size(); ++i) {
      const auto& mesh = std::get<geometry::ConvexMesh>(housing.collisions[i].shape);
      EXPECT_GT(mesh.hull->vertices.size(), 50u) << link;
      EXPECT_FALSE(housing.visuals[i].mesh_file.empty());
    }
  }
}

// Only joints 6 and 7 move the flange against the forearm; joint 7 turns it, not quite round.
TEST(Lwr4Test, FlangeOfTheMeshesTurnsClearOfForearmAndFork) {
  const RobotModel model = Load("robots/lwr4/lwr4_meshes");
  const std::vector<LinkCollider> links = LinkCollidersOf(model);
  ASSERT_EQ(links[5].number, 5);
  ASSERT_EQ(links[7].number, 7);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
  double least = kUnlimited;
  for (int i = -120; i <= 120; ++i) {
    for (int turn = 0; turn < 18; turn += 5) {
      q[5] = i * kDegree;
      q[6] = turn * kDegree;
      const auto X_WL = LinkPoses(model, q);
      least = std::min(least, DistanceToLink(links[5], X_WL[5], links[7], X_WL[7], 1.0).distance);
    }
  }
  EXPECT_GT(least, 0.02) << "the margin within which pairs are to be checked";
  EXPECT_LT(least, 0.03) << "the fork holds the wrist";
  EXPECT_TRUE(model.collision_disabled(5, 7));
}

// Bounds of the housing of each link in its own frame, m: 0.124 m wide, elbows to 0.116 m sideways,
// each elbow two halves that meet in the plane of the arm.
TEST(Lwr4Test, ElbowsBulgeSidewaysByHalves) {
  const RobotModel model = LoadUrdf(ProductFile("robots/lwr4/lwr4_meshes.urdf"));
  const auto reach = [&](int link, const Eigen::Vector3d& direction) {
    const CollisionElement& element = model.links()[link].collisions[0];
    double farthest = -kUnlimited;
    for (const Eigen::Vector3d& p : std::get<geometry::ConvexMesh>(element.shape).hull->vertices) {
      farthest = std::max(farthest, direction.dot(element.X_LC * p));
    }
    return farthest;
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const double side[] = {1.0, -1.0, -1.0, 1.0};
  for (int link = 1; link <= 4; ++link) {
    EXPECT_NEAR(reach(link, x), 0.062, 1e-6) << link;
    EXPECT_NEAR(reach(link, -x), 0.062, 1e-6) << link;
    EXPECT_NEAR(reach(link, side[link - 1] * y), 0.116, 1e-6) << link;
    EXPECT_NEAR(reach(link, -side[link - 1] * y), 0.061, 1e-6) << link;
    const bool upright = link % 2 == 1;
    EXPECT_NEAR(reach(link, z), upright ? 0.261 : 0.191, 1e-6) << link;
    EXPECT_NEAR(reach(link, -z), upright ? -0.009 : 0.061, 1e-6) << link;
  }
}

}  // namespace lwr4_test
}  // namespace oca::robot::test
