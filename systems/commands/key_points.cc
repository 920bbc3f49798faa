// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/key_points.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/systems/signals/config_errors.h"

namespace oca::systems {
namespace {

/// Of points that differ in length, the first that is not as long as the robot.
void CheckLengths(const std::vector<motion::KeyPoint>& points, const robot::RobotModel& model) {
  const auto wrong = [&](const motion::KeyPoint& point) {
    return point.position.size() != model.num_positions();
  };
  const bool even = std::all_of(points.begin(), points.end(), [&](const motion::KeyPoint& point) {
    return point.position.size() == points.front().position.size();
  });
  const auto found = std::find_if(points.begin(), points.end(), wrong);
  if (even || found == points.end()) return;
  throw ConfigError(fmt::format("key_points[{}].position: got {} numbers; expected {}",
                                found - points.begin(), found->position.size(),
                                robot::OneAJoint(model)));
}

std::vector<motion::KeyPoint> PointsOf(const std::vector<KeyPointParams>& key_points,
                                       const robot::RobotModel* model) {
  std::vector<motion::KeyPoint> points;
  Eigen::VectorXd before;
  for (std::size_t i = 0; i < key_points.size(); ++i) {
    const KeyPointParams& point = key_points[i];
    const std::string where = fmt::format("key_points[{}].position", i);
    const PerComponent position = NumbersOf(point.position, model, before, where);
    if (position.scalar()) {
      throw ConfigError(
          fmt::format("{}: got {}; expected a list of numbers, one a joint", where, position[0]));
    }
    before = position.values();
    points.push_back({point.time, before, point.velocity, point.acceleration});
  }
  if (model != nullptr) CheckLengths(points, *model);
  return points;
}

}  // namespace

void KeyPointParams::Describe(Fields<KeyPointParams>& fields) {
  using P = KeyPointParams;
  fields.Add("time", &P::time, "s", "when the point is passed").Required();
  fields
      .Add("position", &P::position, "",
           "one number a joint; or the name of a state of the SRDF, or some joints by name, the "
           "others as in "
           "the point before")
      .Required();
  fields.Add("velocity", &P::velocity, "", "one number a joint; absent: 0");
  fields.Add("acceleration", &P::acceleration, "", "one number a joint; absent: 0");
}

std::vector<motion::KeyPoint> KeyPointsFrom(const std::vector<KeyPointParams>& key_points,
                                            const std::string& file,
                                            const std::vector<std::string>& joints,
                                            const robot::RobotModel* model) {
  if (file.empty() && !joints.empty()) {
    throw ConfigError("joints: without a file; got names; expected them with `file` only");
  }
  if (!file.empty() && !key_points.empty()) {
    throw ConfigError("file: given twice; got key_points too; expected one of the two");
  }
  return WithConfigErrors([&] {
    std::vector<motion::KeyPoint> points =
        file.empty() ? PointsOf(key_points, model) : motion::ReadKeyPoints(file, joints);
    motion::CheckKeyPoints(points, file.empty() ? "key_points" : file);
    return points;
  });
}

}  // namespace oca::systems
