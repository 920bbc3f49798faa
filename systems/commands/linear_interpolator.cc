// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/linear_interpolator.h"

#include "oca/systems/basics/shared_params.h"

namespace oca::systems {

void LinearRequest::Params::Describe(Fields<Params>& fields) {
  AddKeyPoints(fields);
  AddSampling(fields);
}

LinearRequest::Params LinearRequest::Example() {
  return {.key_points = {{.time = 0.0, .position = Eigen::Vector2d(0.0, 1.0)},
                         {.time = 1.0, .position = Eigen::Vector2d(0.5, -1.0)}}};
}

LinearRequest::Params LinearRequest::Resolved(Params params, const ModelSet& models) {
  const auto model = RobotOfPostures(models, params.model);
  params.points = KeyPointsFrom(params.key_points, params.file, params.joints, model.get());
  return params;
}

LinearRequest::Params LinearRequest::Checked(Params params) {
  Validated(params);
  if (params.points.empty()) {
    params.points = KeyPointsFrom(params.key_points, params.file, params.joints);
  }
  return params;
}

motion::Trajectory LinearRequest::MakeTrajectory(const Params& params) {
  return motion::Trajectory::Linear(params.points);
}

}  // namespace oca::systems
