// SPDX-License-Identifier: BSD-3-Clause
// All systems of this tree, by name.
#include "oca/diagrams/files/catalogue.h"
#include "oca/systems/basics/constant.h"
#include "oca/systems/basics/delay.h"
#include "oca/systems/basics/first_order_lag.h"
#include "oca/systems/basics/gain.h"
#include "oca/systems/basics/integrator.h"
#include "oca/systems/basics/ramp_source.h"
#include "oca/systems/basics/saturation.h"
#include "oca/systems/basics/sine_source.h"
#include "oca/systems/basics/step_source.h"
#include "oca/systems/basics/sum.h"
#include "oca/systems/basics/zero_order_hold.h"
#include "oca/systems/commands/linear_interpolator.h"
#include "oca/systems/commands/spline_generator.h"
#include "oca/systems/commands/tip_trajectory.h"
#include "oca/systems/fields/attractive_field.h"
#include "oca/systems/fields/delta_limiter.h"
#include "oca/systems/fields/delta_overlay.h"
#include "oca/systems/fields/delta_relaxation.h"
#include "oca/systems/fields/force_sum.h"
#include "oca/systems/fields/jacobian_mapping.h"
#include "oca/systems/fields/loop_gain.h"
#include "oca/systems/fields/repulsive_field.h"
#include "oca/systems/fields/velocity_aware_field.h"
#include "oca/systems/fields/vortex_field.h"
#include "oca/systems/fields/wrench_transform.h"
#include "oca/systems/judging/avoidance_log.h"
#include "oca/systems/judging/motion_metrics.h"
#include "oca/systems/judging/tip_error.h"
#include "oca/systems/methods/elastic_band.h"
#include "oca/systems/methods/flacco_de_luca.h"
#include "oca/systems/methods/safety_filter.h"
#include "oca/systems/methods/servo_scaling.h"
#include "oca/systems/methods/task_priority.h"
#include "oca/systems/methods/velocity_loop.h"
#include "oca/systems/plants/integrator_plant.h"
#include "oca/systems/plants/joint_servo.h"
#include "oca/systems/plants/motion_limiter.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/obstacle_sensor.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "oca/systems/sensing/obstacle_tracker.h"
#include "oca/systems/sensing/robot_kinematics.h"

namespace oca::files {
namespace {

/// A row for each system of systems/.
Catalogue AllOfOca() {
  Catalogue all;
  all.Add<systems::AttractiveField>("AttractiveField");
  all.Add<systems::AvoidanceLog>("AvoidanceLog");
  all.Add<systems::BulletDistance>("BulletDistance");
  all.Add<systems::Constant>("Constant");
  all.Add<systems::Delay>("Delay");
  all.Add<systems::DeltaLimiter>("DeltaLimiter");
  all.Add<systems::DeltaOverlay>("DeltaOverlay");
  all.Add<systems::DeltaRelaxation>("DeltaRelaxation");
  all.Add<systems::ElasticBand>("ElasticBand");
  all.Add<systems::FirstOrderLag>("FirstOrderLag");
  all.Add<systems::FlaccoDeLuca>("FlaccoDeLuca");
  all.Add<systems::ForceSum>("ForceSum");
  all.Add<systems::Gain>("Gain");
  all.Add<systems::Integrator>("Integrator");
  all.Add<systems::IntegratorPlant>("IntegratorPlant");
  all.Add<systems::JacobianMapping>("JacobianMapping");
  all.Add<systems::JointServo>("JointServo");
  all.Add<systems::LinearInterpolator>("LinearInterpolator");
  all.Add<systems::LoopGain>("LoopGain");
  all.Add<systems::MotionLimiter>("MotionLimiter");
  all.Add<systems::MotionMetrics>("MotionMetrics");
  all.Add<systems::ObstacleSensor>("ObstacleSensor");
  all.Add<systems::ObstacleSource>("ObstacleSource");
  all.Add<systems::ObstacleTracker>("ObstacleTracker");
  all.Add<systems::RampSource>("RampSource");
  all.Add<systems::RepulsiveField>("RepulsiveField");
  all.Add<systems::RobotKinematics>("RobotKinematics");
  all.Add<systems::SafetyFilter>("SafetyFilter");
  all.Add<systems::Saturation>("Saturation");
  all.Add<systems::ServoScaling>("ServoScaling");
  all.Add<systems::SineSource>("SineSource");
  all.Add<systems::SplineGenerator>("SplineGenerator");
  all.Add<systems::StepSource>("StepSource");
  all.Add<systems::Sum>("Sum");
  all.Add<systems::TaskPriority>("TaskPriority");
  all.Add<systems::TipError>("TipError");
  all.Add<systems::TipTrajectory>("TipTrajectory");
  all.Add<systems::VelocityAwareField>("VelocityAwareField");
  all.Add<systems::VelocityLoop>("VelocityLoop");
  all.Add<systems::VortexField>("VortexField");
  all.Add<systems::WrenchTransform>("WrenchTransform");
  all.Add<systems::ZeroOrderHold>("ZeroOrderHold");
  return all;
}

}  // namespace

Catalogue Catalogue::Standard() {
  static const Catalogue standard = AllOfOca();  // a copy shares its rows
  return standard;
}

}  // namespace oca::files
