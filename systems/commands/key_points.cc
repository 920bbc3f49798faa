// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/key_points.h"

#include "oca/systems/signals/config_errors.h"

namespace oca::systems {

void KeyPointParams::Describe(Fields<KeyPointParams>& fields) {
  using P = KeyPointParams;
  fields.Add("time", &P::time, "s", "when the point is passed").Required();
  fields.Add("position", &P::position, "", "one number a joint").Required();
  fields.Add("velocity", &P::velocity, "", "one number a joint; absent: 0");
  fields.Add("acceleration", &P::acceleration, "", "one number a joint; absent: 0");
}

std::vector<motion::KeyPoint> KeyPointsFrom(const std::vector<KeyPointParams>& key_points,
                                            const std::string& file,
                                            const std::vector<std::string>& joints) {
  if (file.empty() && !joints.empty()) {
    throw ConfigError("joints: without a file; got names; expected them with `file` only");
  }
  if (!file.empty() && !key_points.empty()) {
    throw ConfigError("file: given twice; got key_points too; expected one of the two");
  }
  return WithConfigErrors([&] {
    std::vector<motion::KeyPoint> points;
    if (!file.empty()) points = motion::ReadKeyPoints(file, joints);
    for (const KeyPointParams& point : key_points) {
      points.push_back({point.time, point.position, point.velocity, point.acceleration});
    }
    motion::CheckKeyPoints(points, file.empty() ? "key_points" : file);
    return points;
  });
}

}  // namespace oca::systems
