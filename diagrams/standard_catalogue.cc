// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/catalogue.h"
#include "systems/attractive_field.h"
#include "systems/avoidance_log.h"
#include "systems/bullet_distance.h"
#include "systems/constant.h"
#include "systems/delay.h"
#include "systems/delta_limiter.h"
#include "systems/delta_overlay.h"
#include "systems/delta_relaxation.h"
#include "systems/elastic_band.h"
#include "systems/first_order_lag.h"
#include "systems/flacco_de_luca.h"
#include "systems/force_sum.h"
#include "systems/gain.h"
#include "systems/integrator.h"
#include "systems/integrator_plant.h"
#include "systems/jacobian_mapping.h"
#include "systems/joint_servo.h"
#include "systems/linear_interpolator.h"
#include "systems/loop_gain.h"
#include "systems/motion_limiter.h"
#include "systems/motion_metrics.h"
#include "systems/obstacle_sensor.h"
#include "systems/obstacle_source.h"
#include "systems/ramp_source.h"
#include "systems/repulsive_field.h"
#include "systems/robot_kinematics.h"
#include "systems/safety_filter.h"
#include "systems/saturation.h"
#include "systems/servo_scaling.h"
#include "systems/sine_source.h"
#include "systems/spline_generator.h"
#include "systems/step_source.h"
#include "systems/sum.h"
#include "systems/task_priority.h"
#include "systems/tip_error.h"
#include "systems/tip_trajectory.h"
#include "systems/velocity_aware_field.h"
#include "systems/velocity_loop.h"
#include "systems/vortex_field.h"
#include "systems/wrench_transform.h"
#include "systems/zero_order_hold.h"

namespace oca::diagrams {
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

}  // namespace oca::diagrams
