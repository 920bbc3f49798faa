// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>

namespace oca::robot {
class RobotModel;
}  // namespace oca::robot

namespace oca::systems {

/// The robots and frames of a diagram, by the names that systems refer to them with.
class ModelSet {
 public:
  /// throws ConfigError if the name is taken.
  void Add(const std::string& name, std::shared_ptr<const robot::RobotModel> model);
  /// The model; an empty name means the only one there is.
  /// throws ConfigError naming the models there are.
  std::shared_ptr<const robot::RobotModel> Get(const std::string& name) const;
  const std::map<std::string, std::shared_ptr<const robot::RobotModel>>& all() const {
    return models_;
  }

 private:
  std::map<std::string, std::shared_ptr<const robot::RobotModel>> models_;
};

}  // namespace oca::systems
