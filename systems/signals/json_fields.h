// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For the source files that read and write the JSON of signals; not installed.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

namespace oca::systems {

using Json = nlohmann::ordered_json;

/// One JSON value that knows where it stands, for strict reading. All members throw ConfigError
/// `where: what; got X; expected Y`.
class JsonReader {
 public:
  JsonReader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}

  /// Refuses anything but an object that has all of `required` and else only keys of `optional`.
  void CheckKeys(std::initializer_list<const char*> required,
                 std::initializer_list<const char*> optional = {}) const;
  bool Has(const char* key) const { return json_.contains(key); }
  JsonReader At(const char* key) const;
  /// Calls read(item) for the items of a list.
  template <class ReadItem>
  void ForEach(const ReadItem& read) const {
    CheckList();
    for (std::size_t i = 0; i < json_.size(); ++i) read(JsonReader(json_[i], ItemName(i)));
  }

  double Number() const;
  std::string Text() const;
  /// A text that is not empty.
  std::string Label() const;
  Eigen::Vector3d Vector3() const;
  /// A vector of length 1, to within rounding to three digits; normalised.
  Eigen::Vector3d UnitVector() const;
  /// {xyz, rpy | quaternion [x, y, z, w]}; neither of the two means no rotation.
  Eigen::Isometry3d Pose() const;

  [[noreturn]] void Fail(const std::string& got, const std::string& expected) const;

 private:
  void CheckList() const;
  std::string ItemName(std::size_t i) const;

  const Json& json_;
  std::string where_;
};

Json ToJson(const Eigen::Vector3d& vector);
/// {xyz, quaternion [x, y, z, w] with w >= 0}
Json ToJson(const Eigen::Isometry3d& pose);

}  // namespace oca::systems
