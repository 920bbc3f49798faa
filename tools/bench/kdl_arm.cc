// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/kdl_arm.h"

#include <stdexcept>

#include "tests/kdl_convert.h"

namespace oca::bench {
namespace {

using test::ToKdl;

Eigen::Isometry3d ToEigen(const KDL::Frame& frame) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) X(row, column) = frame.M(row, column);
    X(row, 3) = frame.p(row);
  }
  return X;
}

KDL::Chain MakeChain(const robot::RobotModel& model) {
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(KDL::Joint("base", KDL::Joint::None), ToKdl(model.X_WB())));
  for (const robot::Joint& joint : model.joints()) {
    if (joint.parent_link != joint.child_link - 1 || joint.type == robot::JointType::kPrismatic) {
      throw std::invalid_argument("model: got a branch or a slider; expected a chain of hinges");
    }
    const KDL::Frame tip = ToKdl(joint.X_PJ);
    chain.addSegment(KDL::Segment(
        joint.movable()
            ? KDL::Joint(joint.name.text(), tip.p, tip.M * ToKdl(joint.axis), KDL::Joint::RotAxis)
            : KDL::Joint(joint.name.text(), KDL::Joint::None),
        tip));
  }
  return chain;
}

}  // namespace

KdlArm::KdlArm(const robot::RobotModel& model)
    : model_(model),
      chain_(MakeChain(model)),
      poses_solver_(chain_),
      jacobian_solver_(chain_),
      q_(chain_.getNrOfJoints()),
      body_jacobian_(chain_.getNrOfJoints()),
      X_WL_(static_cast<std::size_t>(model.num_links())),
      J_(6 * model.num_bodies(), model.num_positions()) {}

void KdlArm::Calc(const Eigen::VectorXd& q) {
  q_.data = q;
  KDL::Frame frame;
  for (int link = 0; link < model_.num_links(); ++link) {
    poses_solver_.JntToCart(q_, frame, link + 1);
    X_WL_[static_cast<std::size_t>(link)] = ToEigen(frame);
  }
  for (int b = 0; b < model_.num_bodies(); ++b) {
    jacobian_solver_.JntToJac(q_, body_jacobian_, model_.bodies()[b] + 1);
    J_.middleRows<6>(6 * b) = body_jacobian_.data;
  }
}

}  // namespace oca::bench
