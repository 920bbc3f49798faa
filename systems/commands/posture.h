// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "oca/framework/dataflow/params.h"
#include "oca/models/robot/posture.h"
#include "oca/systems/signals/model_set.h"

namespace oca::systems {

/// Where joints are, as a parameter: a number for all or one a joint, the name of a state of the
/// robot's SRDF, or some joints by name.
struct Posture {
  Posture() = default;
  Posture(PerComponent numbers) : said(std::move(numbers)) {}         // NOLINT: as given
  Posture(double number) : said(PerComponent(number)) {}              // NOLINT
  Posture(std::string state) : said(std::move(state)) {}              // NOLINT
  Posture(const char* state) : said(std::string(state)) {}            // NOLINT
  Posture(robot::NamedPositions joints) : said(std::move(joints)) {}  // NOLINT
  template <class Derived>
  Posture(const Eigen::MatrixBase<Derived>& numbers)  // NOLINT
      : said(PerComponent(numbers)) {}

  /// nullptr if a robot must say what is meant.
  const PerComponent* numbers() const { return std::get_if<PerComponent>(&said); }

  std::variant<PerComponent, std::string, robot::NamedPositions> said{PerComponent(0.0)};
};

/// The robot that `name` means; empty: the only one there is that moves, nullptr if there is not
/// one. throws ConfigError as MovableModel does
std::shared_ptr<const robot::RobotModel> RobotOfPostures(const ModelSet& models,
                                                         const std::string& name);

/// The numbers of a posture: those given, else `before` with what it names moved; an empty `before`
/// is robot::ZeroPosture. `model` may be nullptr where numbers are given.
/// throws ConfigError `where: ...` naming the joints or states of the robot
PerComponent NumbersOf(const Posture& posture, const robot::RobotModel* model,
                       const Eigen::VectorXd& before, const std::string& where);

}  // namespace oca::systems

namespace oca {

template <>
const ParamType& ParamTypeOf<systems::Posture>();

}  // namespace oca
