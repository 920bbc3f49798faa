// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <concepts>

#include "framework/error.h"
#include "framework/nearest.h"
#include "models/error.h"
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

template <class S>
std::unique_ptr<System> Make(const typename S::Params& params, const systems::ModelSet& models) {
  if constexpr (std::constructible_from<S, const typename S::Params&, const systems::ModelSet&>) {
    return std::make_unique<S>(params, models);
  } else {
    return std::make_unique<S>(params);
  }
}

/// A value is missing, as that of an expression which could not be worked out.
bool HasGap(const Value& value) {
  if (value.null()) return true;
  if (const Value::List* const list = value.list()) {
    return std::any_of(list->begin(), list->end(), HasGap);
  }
  if (const Value::Map* const map = value.map()) {
    return std::any_of(map->begin(), map->end(),
                       [](const Value::Entry& entry) { return HasGap(entry.value); });
  }
  return false;
}

template <class S>
CatalogueRow Row(const char* type) {
  using Params = typename S::Params;
  CatalogueRow row;
  row.type = type;
  row.doc = S::kDoc;
  row.fields = &FieldsOf<Params>;
  row.make = [](const Value& value, const std::string& where, const systems::ModelSet& models,
                Problems& problems) -> std::unique_ptr<System> {
    Params params;
    Problems own;
    ReadFields(value, FieldsOf<Params>(), where, &params, own);
    problems.Add(own);
    if (!own.empty()) return nullptr;
    const auto refuse = [&](const std::exception& error) {
      if (!problems.empty() && HasGap(value)) return;  // which has been reported
      problems.Add(value.location(), (where.empty() ? "" : where + ": ") + error.what());
    };
    try {
      return Make<S>(params, models);
    } catch (const ConfigError& error) {
      refuse(error);
    } catch (const models::ModelError& error) {
      refuse(error);
    }
    return nullptr;
  };
  row.make_example = [](const systems::ModelSet& models) { return Make<S>(S::Example(), models); };
  row.example = [] {
    const Params params = S::Example();
    return ShowFields(FieldsOf<Params>(), &params);
  };
  row.schema = [] {
    const Params defaults;
    return SchemaOfFields(FieldsOf<Params>(), &defaults);
  };
  row.defaults = [] {
    Params params;
    std::vector<std::string> texts;
    for (const Field& field : FieldsOf<Params>())
      texts.push_back(field.type->Show(field.member(&params)));
    return texts;
  };
  row.needs_models = std::constructible_from<S, const Params&, const systems::ModelSet&>;
  row.says_obstacles = requires { requires S::kSaysObstacles; };
  return row;
}

}  // namespace

const std::vector<CatalogueRow>& Catalogue() {
  using namespace systems;  // NOLINT: a table of their names
  static const std::vector<CatalogueRow> rows = {
      Row<AttractiveField>("AttractiveField"),
      Row<AvoidanceLog>("AvoidanceLog"),
      Row<BulletDistance>("BulletDistance"),
      Row<Constant>("Constant"),
      Row<Delay>("Delay"),
      Row<DeltaLimiter>("DeltaLimiter"),
      Row<DeltaOverlay>("DeltaOverlay"),
      Row<DeltaRelaxation>("DeltaRelaxation"),
      Row<ElasticBand>("ElasticBand"),
      Row<FirstOrderLag>("FirstOrderLag"),
      Row<FlaccoDeLuca>("FlaccoDeLuca"),
      Row<ForceSum>("ForceSum"),
      Row<Gain>("Gain"),
      Row<systems::Integrator>("Integrator"),
      Row<IntegratorPlant>("IntegratorPlant"),
      Row<JacobianMapping>("JacobianMapping"),
      Row<JointServo>("JointServo"),
      Row<LinearInterpolator>("LinearInterpolator"),
      Row<LoopGain>("LoopGain"),
      Row<MotionLimiter>("MotionLimiter"),
      Row<MotionMetrics>("MotionMetrics"),
      Row<ObstacleSensor>("ObstacleSensor"),
      Row<ObstacleSource>("ObstacleSource"),
      Row<RampSource>("RampSource"),
      Row<RepulsiveField>("RepulsiveField"),
      Row<RobotKinematics>("RobotKinematics"),
      Row<SafetyFilter>("SafetyFilter"),
      Row<Saturation>("Saturation"),
      Row<ServoScaling>("ServoScaling"),
      Row<SineSource>("SineSource"),
      Row<SplineGenerator>("SplineGenerator"),
      Row<StepSource>("StepSource"),
      Row<Sum>("Sum"),
      Row<TaskPriority>("TaskPriority"),
      Row<TipError>("TipError"),
      Row<TipTrajectory>("TipTrajectory"),
      Row<VelocityAwareField>("VelocityAwareField"),
      Row<VelocityLoop>("VelocityLoop"),
      Row<VortexField>("VortexField"),
      Row<WrenchTransform>("WrenchTransform"),
      Row<ZeroOrderHold>("ZeroOrderHold"),
  };
  return rows;
}

const CatalogueRow& FindRow(const std::string& type) {
  std::vector<std::string> types;
  for (const CatalogueRow& row : Catalogue()) {
    if (row.type == type) return row;
    types.push_back(row.type);
  }
  throw ConfigError(fmt::format("no system type '{}'{} (`simulator list` shows all)", type,
                                DidYouMean(type, types)));
}

}  // namespace oca::diagrams
