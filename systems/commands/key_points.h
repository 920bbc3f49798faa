// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/models/motion/key_points.h"
#include "oca/systems/commands/posture.h"

namespace oca::systems {

/// A motion::KeyPoint as a parameter.
struct KeyPointParams {
  double time{0.0};                               ///< s
  Posture position{};                             ///< n; u
  std::optional<Eigen::VectorXd> velocity{};      ///< n; u/s
  std::optional<Eigen::VectorXd> acceleration{};  ///< n; u/s^2
  static void Describe(Fields<KeyPointParams>& fields);
};

/// Describes the parameters key_points, file, joints and model.
template <class P>
void AddKeyPoints(Fields<P>& fields) {
  fields.Add("key_points", &P::key_points, "", "points in order of time");
  fields.Add("file", &P::file, "", "CSV file of key points (time, p1..pn) instead");
  fields.Add(
      "joints", &P::joints, "",
      "names of the columns of positions in `file`, in the order of the joints; none: p1..pn");
  fields.Add("model", &P::model, "",
             "robot whose states and joints the points may name; may be left out if there is but "
             "one");
}

/// The points given by the parameters `key_points` and `file`, of which one must be given; `joints`
/// as motion::ReadKeyPoints takes them. A point that names a state or joints has the others where
/// the point before has them, the first one where robot::ZeroPosture has them. `model` is theirs;
/// nullptr: none is known.
/// throws ConfigError unless motion::CheckKeyPoints accepts them, or if a name is none of the model
std::vector<motion::KeyPoint> KeyPointsFrom(const std::vector<KeyPointParams>& key_points,
                                            const std::string& file,
                                            const std::vector<std::string>& joints = {},
                                            const robot::RobotModel* model = nullptr);

}  // namespace oca::systems
