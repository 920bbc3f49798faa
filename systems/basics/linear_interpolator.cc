// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/linear_interpolator.h"

namespace oca::systems {

void LinearRequest::Params::Describe(Fields<Params>& fields) {
  fields.Add("key_points", &Params::key_points, "", "points in order of time");
  fields.Add("file", &Params::file, "", "CSV file of key points (time, p1..pn) instead");
  fields.Add(
      "joints", &Params::joints, "",
      "names of the columns of positions in `file`, in the order of the joints; none: p1..pn");
  fields
      .Add("period", &Params::period, "s",
           "0: continuous in time; > 0: sampled for the end of each period and held")
      .AtLeast(0.0);
  fields.Add("unit", &Params::unit, "", "unit of the position");
}

LinearRequest::Params LinearRequest::Example() {
  return {.key_points = {{.time = 0.0, .position = Eigen::Vector2d(0.0, 1.0)},
                         {.time = 1.0, .position = Eigen::Vector2d(0.5, -1.0)}}};
}

LinearRequest::Params LinearRequest::Checked(Params params) {
  Validated(params);
  return params;
}

motion::Trajectory LinearRequest::MakeTrajectory(const Params& params) {
  return motion::Trajectory::Linear(KeyPointsFrom(params.key_points, params.file, params.joints));
}

}  // namespace oca::systems
