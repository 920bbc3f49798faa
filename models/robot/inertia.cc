// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/inertia.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

namespace oca::robot {
namespace {

// Of the largest moment: what three digits in a file can take from the others.
constexpr double kRounding = 2e-3;

}  // namespace

std::string ImpossibleInertia(const Inertia& inertia) {
  if (inertia.mass == 0.0) return "";
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia.I_C, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& moments = axes.eigenvalues();  // ascending
  // A thin rod or plate lies on the bound itself.
  const double slack = kRounding * moments[2];
  const bool negative = moments[0] < -slack;
  if (!negative && moments[2] <= moments[0] + moments[1] + slack) return "";
  return fmt::format("principal moments {:.6g}, {:.6g}, {:.6g} kg m^2, {}", moments[0], moments[1],
                     moments[2], negative ? "one below 0" : "the last above the sum of the others");
}

WarningLines InertiaWarnings(const RobotModel& model) {
  std::vector<std::string> lines;
  for (const Link& link : model.links()) {
    const std::string why = ImpossibleInertia(link.inertia);
    if (why.empty()) continue;
    lines.push_back(
        fmt::format("inertias that no body can have, which nothing here reads: link '{}' has {}",
                    link.name.text(), why));
  }
  return SummedUp(std::move(lines), "link");
}

}  // namespace oca::robot
