// SPDX-License-Identifier: BSD-3-Clause
// That a SafetyFilter keeps flat ends apart, between which the nearest points jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "oca/models/robot/urdf.h"
#include "oca/systems/sensing/link_colliders.h"
#include "tests/systems/methods/filter_bench.h"

namespace oca::systems {
namespace safety_filter_flat_test {

using filter_bench::Hundred;
using filter_bench::kDt;
using filter_bench::Loop;

/// A bar on two slides, X and Y, and three turning joints about its middle.
constexpr const char* kGantry = R"(<robot name="gantry">
  <link name="base"/><link name="x"/><link name="y"/><link name="roll"/><link name="pitch"/>
  <link name="bar"><collision><geometry><box size="1.2 0.5 0.1"/></geometry></collision></link>
  <joint name="slide_x" type="prismatic"><parent link="base"/><child link="x"/><axis xyz="1 0 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="slide_z" type="prismatic"><parent link="x"/><child link="y"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="roll" type="revolute"><parent link="y"/><child link="roll"/><axis xyz="1 0 0"/>
    <limit lower="-2" upper="2" velocity="2" effort="1"/></joint>
  <joint name="pitch" type="revolute"><parent link="roll"/><child link="pitch"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="2" effort="1"/></joint>
  <joint name="yaw" type="revolute"><parent link="pitch"/><child link="bar"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="2" effort="1"/></joint>
</robot>)";

/// The least distance to a box under the bar while it is asked to come down to `height` and to move
/// along by `along`.
double Least(const Eigen::Vector3d& box, double height, double along, double speed) {
  ModelSet models;
  const auto model =
      std::make_shared<const robot::RobotModel>(robot::ParseUrdf(kGantry, "gantry.urdf"));
  models.Add("gantry", model);
  const geometry::Collider body{geometry::Shape(geometry::Box{box}), "box"};
  const auto links = MakeLinkColliders(*model);
  const models::Name name("box");
  double least = 10.0;
  double moved = 0.0;
  const auto around = [&](const LinkPoses& poses) {
    ProximitySet set;
    for (const LinkCollider& link : links) {
      const Eigen::Isometry3d X_WO(Eigen::Translation3d(0.0, moved, 0.0));
      const auto found = DistanceToBody(link, poses.poses[link.number], body, X_WO, 10.0);
      set.proximities.push_back({link.link,
                                 name,
                                 found.distance,
                                 found.point_a,
                                 found.point_b,
                                 found.normal,
                                 Eigen::Vector3d(0.0, speed, 0.0),
                                 {}});
      least = std::min(least, found.distance);
    }
    return set;
  };
  Eigen::VectorXd start = Eigen::VectorXd::Zero(5);
  start[1] = 0.4;
  Loop loop(Hundred(), models, start);
  for (int k = 0; k < 1000; ++k) {
    const double share = std::min(k / 500.0, 1.0);
    Eigen::VectorXd request = start;
    request[0] += share * along;
    request[1] += share * (height - start[1]);
    loop.Tick(request, around);
    moved += speed * kDt;
  }
  return least;
}

TEST(SafetyFilterFlatTest, AnEdgeAlongAFace) {
  EXPECT_GT(Least({0.8, 0.02, 0.2}, -0.2, 0.3, 0.0), 0.047);
}

TEST(SafetyFilterFlatTest, AFaceAlongAFace) {
  EXPECT_GT(Least({0.8, 0.3, 0.2}, -0.2, 0.3, 0.0), 0.047);
}

TEST(SafetyFilterFlatTest, AFaceThatMovesAlongAFace) {
  EXPECT_GT(Least({0.8, 0.3, 0.2}, -0.2, 0.3, 0.05), 0.047);
}

}  // namespace safety_filter_flat_test
}  // namespace oca::systems
