// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/models/robot/robot_model.h"

namespace oca::runs {

/// Whose joints the Vector outputs of a diagram are: what a record says of them beyond what the
/// diagram knows itself.
class SignalFacts {
 public:
  explicit SignalFacts(const loading::LoadedDiagram& loaded);

  /// The robot that an output has one number a position for, by its name among the models; empty if
  /// it is none's.
  std::string RobotOf(const OutputHandle& output) const;
  /// Names of that robot's joints, one an element of the output; empty if it is none's.
  std::vector<std::string> JointsOf(const OutputHandle& output) const;

 private:
  using Key = std::pair<const System*, int>;

  void ClaimModels();
  void SpreadClaims();
  bool Claim(const System& system, const std::string& robot);
  std::vector<OutputHandle> VectorsAt(const System& system) const;

  const loading::LoadedDiagram& loaded_;
  std::map<Key, std::string> robots_;
};

}  // namespace oca::runs
