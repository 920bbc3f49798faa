// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/unseen_links.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace oca::robot {

std::vector<int> DrawnOnly(const RobotModel& model) {
  std::vector<int> unseen;
  for (int i = 0; i < model.num_links(); ++i) {
    const Link& link = model.links()[i];
    if (link.collisions.empty() && !link.visuals.empty()) unseen.push_back(i);
  }
  return unseen;
}

bool NothingToSee(const RobotModel& model) {
  const bool moves = model.num_bodies() > 0;
  for (int i = 0; i < model.num_links(); ++i) {
    const Link& link = model.links()[i];
    const bool counts = !link.attached && (!moves || model.body(i) >= 0);
    if (counts && !link.collisions.empty()) return false;
  }
  return true;
}

std::string DescribeUnseen(const RobotModel& model, const std::string& remedy) {
  std::vector<std::string> names;
  for (const int link : DrawnOnly(model)) names.push_back(model.links()[link].name.text());
  const bool nothing = NothingToSee(model);
  if (names.empty() && !nothing) return "";
  std::string text;
  if (nothing) {
    text = fmt::format(
        "robot '{}' has no collision shape on any {}link, so nothing of it can be "
        "seen by distances",
        model.name().text(), model.num_bodies() > 0 ? "movable " : "");
  }
  if (names.empty()) return text + "; expected links with <collision>";
  const bool one = names.size() == 1;
  return text + fmt::format(
                    "{}{} drawn without a collision shape, so distances do not see {}: {}; {} "
                    "takes what is drawn",
                    nothing ? "; " : "", one ? "a link is" : "links are", one ? "it" : "them",
                    fmt::join(names, ", "), remedy);
}

}  // namespace oca::robot
