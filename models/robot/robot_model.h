// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/models/geometry/shape.h"
#include "oca/models/name.h"

namespace oca::robot {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// One solid of a link. Pose `X_LC` of the shape's frame in the link's frame; `source` says where
/// it was described ("file:line"), for messages.
struct CollisionElement {
  Eigen::Isometry3d X_LC{Eigen::Isometry3d::Identity()};
  geometry::Shape shape{};
  std::string source{};
};

/// What a viewer draws: a shape, or else the file `mesh_file` scaled by `mesh_scale`.
/// `colour` is red, green, blue, alpha in [0, 1].
struct VisualElement {
  Eigen::Isometry3d X_LV{Eigen::Isometry3d::Identity()};
  std::optional<geometry::Shape> shape{};
  std::string mesh_file{};
  Eigen::Vector3d mesh_scale{Eigen::Vector3d::Ones()};
  Eigen::Vector4d colour{0.7, 0.7, 0.7, 1.0};
};

/// `mass` kg; centre of mass `p_LC` m in the link's frame; `I_C` kg m^2 about the centre of mass
/// in the link's axes. Mass 0 says that nothing is known of the link's inertia.
struct Inertia {
  double mass{0.0};
  Eigen::Vector3d p_LC{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d I_C{Eigen::Matrix3d::Zero()};
};

/// `parent_joint` is -1 for the root. The link's frame is its parent joint's frame after motion.
struct Link {
  models::Name name{};
  int parent_joint{-1};
  std::vector<CollisionElement> collisions{};
  std::vector<VisualElement> visuals{};
  Inertia inertia{};
  bool attached{false};  ///< not of the robot itself: see AttachObjects
};

enum class JointType { kFixed, kRevolute, kContinuous, kPrismatic };

/// This joint moves by multiplier * (position of joint number `joint`) + offset.
struct Mimic {
  int joint{-1};
  double multiplier{1.0};
  double offset{0.0};
};

/// `X_PJ` is the joint's frame in its parent link; `axis` a unit vector in the joint's frame.
/// Limits are in rad or m and their derivatives, effort in Nm or N, infinite where not given; they
/// are as described: what the robot has to keep of them says RobotModel, for mimics bind too.
struct Joint {
  models::Name name{};
  JointType type{JointType::kFixed};
  int parent_link{-1};
  int child_link{-1};
  Eigen::Isometry3d X_PJ{Eigen::Isometry3d::Identity()};
  Eigen::Vector3d axis{Eigen::Vector3d::UnitX()};
  double lower_limit{-kUnlimited};
  double upper_limit{kUnlimited};
  double velocity_limit{kUnlimited};
  double effort_limit{kUnlimited};
  double acceleration_limit{kUnlimited};
  double jerk_limit{kUnlimited};
  std::optional<Mimic> mimic{};
  bool held{false};        ///< moves by design, and is fixed here: see HoldJoints
  int position_index{-1};  // own entry of q; -1 for fixed and mimic; RobotModel numbers them

  bool movable() const { return type != JointType::kFixed; }
};

/// A posture that has a name, SRDF's <group_state>: where some joints of `group` are, rad or m.
struct NamedState {
  std::string name;
  std::string group{};
  std::vector<std::pair<std::string, double>> positions{};
};

/// What a kinematics pass reads of one joint, packed: the joint stands at
/// multiplier * q[column] + offset (column -1: fixed). A mimic joint has its master's column.
struct KinematicStep {
  JointType type;
  int parent_link;
  int column;
  int principal_axis;  // 0, 1, 2 for +-x, +-y, +-z (the sign is in `sign`), 3 for any other
  bool rotated;        // false if R_PJ is the identity
  double sign;
  double multiplier;
  double offset;
  Eigen::Vector3d p_PJ;
  Eigen::Vector3d axis;
  Eigen::Matrix3d R_PJ;
};

/// A robot, or a world of fixed links, as an immutable value: a tree of links and joints.
///
/// Links are numbered parents first, link 0 is the root, and joint j leads to link j + 1.
/// Positions q are numbered in the order of their joints. A *body* is a link that a movable joint
/// leads to; the links fixed to it, directly or not, belong to it.
class RobotModel {
 public:
  /// Takes links and joints in the order above (joint j has child_link j + 1 and a parent_link
  /// <= j; indices of parents and positions are filled in here). `X_WB` is the root link's pose in
  /// the world. `disabled_pairs` are pairs of link numbers that are never checked for collision;
  /// `states` may speak of joints that do not move.
  /// throws ModelError if the tree, an axis, a limit or a mimic rule is wrong, a mimic is fixed or
  /// leaves the joint it follows no position, or if an inertia has numbers that are not finite or a
  /// negative mass; whether any body can have it says ImpossibleInertia
  RobotModel(models::Name name, std::vector<Link> links, std::vector<Joint> joints,
             const Eigen::Isometry3d& X_WB = Eigen::Isometry3d::Identity(),
             std::vector<std::pair<int, int>> disabled_pairs = {},
             std::vector<NamedState> states = {});

  /// The same robot with its root link elsewhere. throws ModelError for what is no pose
  RobotModel At(const Eigen::Isometry3d& X_WB) const;

  models::Name name() const { return name_; }
  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  const std::vector<KinematicStep>& steps() const { return steps_; }
  int num_links() const { return static_cast<int>(links_.size()); }
  int num_joints() const { return static_cast<int>(joints_.size()); }
  int num_positions() const { return static_cast<int>(position_names_.size()); }
  const Eigen::Isometry3d& X_WB() const { return X_WB_; }

  /// One entry a position. Limits are those of LimitsOfPositions: of the joint and its mimics.
  const std::vector<models::Name>& position_names() const { return position_names_; }
  const Eigen::VectorXd& lower_limits() const { return lower_limits_; }
  const Eigen::VectorXd& upper_limits() const { return upper_limits_; }
  const Eigen::VectorXd& velocity_limits() const { return velocity_limits_; }
  const Eigen::VectorXd& effort_limits() const { return effort_limits_; }
  const Eigen::VectorXd& acceleration_limits() const { return acceleration_limits_; }
  const Eigen::VectorXd& jerk_limits() const { return jerk_limits_; }
  /// "rad", "m", or "mixed"; "rad" for a robot that cannot move.
  std::string_view position_unit() const;

  /// The bodies as link numbers, ascending: the order of the row blocks of the stacked Jacobian.
  const std::vector<int>& bodies() const { return bodies_; }
  int num_bodies() const { return static_cast<int>(bodies_.size()); }
  /// The body that `link` belongs to, as a link number; -1 if the link cannot move.
  int body(int link) const { return body_of_link_[link]; }
  /// The same as a place in bodies(); -1 if the link cannot move.
  int body_index(int link) const { return body_index_of_link_[link]; }

  /// True if the description excludes this pair, or a == b.
  bool collision_disabled(int link_a, int link_b) const;
  /// Pairs of link numbers, each with first < second, ascending.
  const std::vector<std::pair<int, int>>& disabled_pairs() const { return disabled_pairs_; }
  /// The postures that have names, in the order of the file.
  const std::vector<NamedState>& states() const { return states_; }

  /// True if the two links are rigidly connected or only one joint that moves by design, held or
  /// not, lies between them; of an attached object only if rigidly connected, for it was not built
  /// to clear the neighbours.
  bool adjacent(int link_a, int link_b) const;

  /// Number of the link or joint of that name, the place in q of that joint.
  /// throws ModelError naming the nearest name, or that the joint has no position of its own
  int FindLink(std::string_view name) const;
  int FindJoint(std::string_view name) const;
  int FindPosition(std::string_view joint_name) const;

 private:
  void CheckTree() const;
  void CheckJoint(const Joint& joint) const;
  void CheckInertia(const Link& link) const;
  void NumberPositions();
  void CompileSteps();
  void CollectLimits();
  void AssignBodies();
  int BodyByDesign(int link) const;

  models::Name name_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  Eigen::Isometry3d X_WB_;
  std::vector<std::pair<int, int>> disabled_pairs_;
  std::vector<NamedState> states_;
  std::vector<KinematicStep> steps_;
  std::vector<models::Name> position_names_;
  Eigen::VectorXd lower_limits_, upper_limits_, velocity_limits_, effort_limits_;
  Eigen::VectorXd acceleration_limits_, jerk_limits_;
  std::vector<int> bodies_, body_of_link_, body_index_of_link_;
};

}  // namespace oca::robot
