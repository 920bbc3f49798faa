// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/warning_lines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "oca/models/counted.h"

namespace oca::robot {

WarningLines SummedUp(std::vector<std::string> each, const std::string& thing) {
  if (each.empty()) return {};
  const std::size_t more = each.size() - 1;
  std::string sum = each.front();
  if (more > 0) sum += "; and " + models::Counted(more, "more " + thing);
  return {{std::move(sum)}, std::move(each)};
}

WarningLines SummedUpByLink(const std::vector<LinkWarning>& all) {
  if (all.empty()) return {};
  std::vector<std::string> each, links;
  for (const LinkWarning& one : all) {
    const bool first = each.empty();
    each.push_back(one.line);
    if (first || std::find(links.begin(), links.end(), one.link) != links.end()) continue;
    links.push_back(one.link);
  }
  std::string sum = each.front();
  if (!links.empty()) {
    sum += fmt::format("; and {} more, of link{} '{}'", each.size() - 1,
                       links.size() == 1 ? "" : "s", fmt::join(links, "', '"));
  }
  return {{std::move(sum)}, std::move(each)};
}

}  // namespace oca::robot
