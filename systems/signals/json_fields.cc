// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/json_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/geometry/rotation.h"
#include "oca/systems/signals/config_errors.h"

namespace oca::systems {

void JsonReader::Fail(const std::string& got, const std::string& expected) const {
  throw ConfigError(fmt::format("{}: got {}; expected {}", where_, got, expected));
}

void JsonReader::CheckKeys(std::initializer_list<const char*> required,
                           std::initializer_list<const char*> optional) const {
  std::vector<std::string> known(required.begin(), required.end());
  known.insert(known.end(), optional.begin(), optional.end());
  if (!json_.is_object()) {
    Fail(oca::internal::JsonText(json_), fmt::format("an object with {}", fmt::join(known, ", ")));
  }
  for (const auto& [key, value] : json_.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    Fail(fmt::format("the unknown key '{}'", key),
         fmt::format("one of {}{}", fmt::join(known, ", "), DidYouMean(key, known)));
  }
  for (const char* key : required) {
    if (!json_.contains(key)) Fail("no such key", fmt::format("the key '{}'", key));
  }
}

JsonReader JsonReader::At(const char* key) const { return {json_.at(key), where_ + "." + key}; }

void JsonReader::CheckList() const {
  if (!json_.is_array()) Fail(oca::internal::JsonText(json_), "a list");
}

std::string JsonReader::ItemName(std::size_t i) const { return fmt::format("{}[{}]", where_, i); }

double JsonReader::Number() const {
  if (!json_.is_number()) Fail(oca::internal::JsonText(json_), "a number");
  const auto number = json_.get<double>();
  if (!std::isfinite(number)) Fail(fmt::format("{}", number), "a finite number");
  return number;
}

std::string JsonReader::Text() const {
  if (!json_.is_string()) Fail(oca::internal::JsonText(json_), "a text");
  return json_.get<std::string>();
}

std::string JsonReader::Label() const {
  std::string text = Text();
  if (text.empty()) Fail("an empty text", "a name");
  return text;
}

Eigen::Vector3d JsonReader::Vector3() const {
  if (!json_.is_array() || json_.size() != 3)
    Fail(oca::internal::JsonText(json_), "a list of 3 numbers");
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = JsonReader(json_[i], ItemName(i)).Number();
  return vector;
}

Eigen::Vector3d JsonReader::UnitVector() const {
  const Eigen::Vector3d vector = Vector3();
  return WithConfigErrors([&] { return geometry::CheckedUnitVector(vector, where_); });
}

Eigen::Isometry3d JsonReader::Pose() const {
  CheckKeys({"xyz"}, {"rpy", "quaternion"});
  if (Has("rpy") && Has("quaternion")) Fail("rpy and quaternion", "one of the two");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = At("xyz").Vector3();
  if (Has("rpy"))
    pose.linear() = geometry::FromRollPitchYaw(At("rpy").Vector3()).toRotationMatrix();
  if (!Has("quaternion")) return pose;

  const JsonReader quaternion = At("quaternion");
  if (!quaternion.json_.is_array() || quaternion.json_.size() != 4) {
    quaternion.Fail(oca::internal::JsonText(quaternion.json_), "a list of 4 numbers [x, y, z, w]");
  }
  Eigen::Vector4d xyzw;
  for (int i = 0; i < 4; ++i) {
    xyzw[i] = JsonReader(quaternion.json_[i], quaternion.ItemName(i)).Number();
  }
  pose.linear() = WithConfigErrors([&] {
                    return geometry::FromQuaternion(xyzw, quaternion.where_);
                  }).toRotationMatrix();
  return pose;
}

Json ToJson(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json ToJson(const Eigen::Isometry3d& pose) {
  Eigen::Quaterniond rotation(pose.linear());
  rotation.normalize();
  if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
  return {{"xyz", ToJson(Eigen::Vector3d(pose.translation()))},
          {"quaternion", {rotation.x(), rotation.y(), rotation.z(), rotation.w()}}};
}

}  // namespace oca::systems
