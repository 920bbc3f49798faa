// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/srdf_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>

#include <algorithm>

namespace oca::robot {
namespace {

constexpr int kOpen = -1;  // levels of a group that is being looked into

}  // namespace

void SrdfGroups::Add(const TiXmlElement& element) {
  const std::string name = XmlReader::Trimmed(element, "name");
  const auto [known, is_new] = numbers_.emplace(name, groups_.size());
  if (!is_new) {
    reader_.Fail(element, "name",
                 fmt::format("a second group '{}', the first is in line {}", name,
                             elements_[known->second]->Row()),
                 "one group of a name");
  }
  names_.push_back(name);
  elements_.push_back(&element);
  SrdfGroup& group = groups_.emplace_back(SrdfGroup{name});
  for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string& kind = e->ValueStr();
    if (kind == "chain") {
      group.chains.push_back(
          {XmlReader::Trimmed(*e, "base_link"), XmlReader::Trimmed(*e, "tip_link")});
    } else if (kind == "link") {
      group.links.push_back(XmlReader::Trimmed(*e, "name"));
    } else if (kind == "group") {
      group.groups.push_back(XmlReader::Trimmed(*e, "name"));
    } else if (kind == "joint") {
      group.joints.push_back(XmlReader::Trimmed(*e, "name"));
    }
  }
}

std::vector<std::string> SrdfGroups::CheckNesting() {
  levels_.assign(groups_.size(), 0);
  Names path;
  std::vector<std::string> circles;
  for (std::size_t i = 0; i < groups_.size(); ++i) Levels(i, path, circles);
  return circles;
}

void SrdfGroups::FailDeep(std::size_t number) const {
  reader_.Fail(*elements_[number], "nesting",
               fmt::format("more than {} groups in each other", kDeepestGroups), "fewer");
}

/// `path` leads to it from the group that was asked about.
int SrdfGroups::Levels(std::size_t number, Names& path, std::vector<std::string>& circles) {
  if (levels_[number] > 0) return levels_[number];
  const std::string& name = groups_[number].name;
  if (levels_[number] == kOpen) {
    Names circle(std::find(path.begin(), path.end(), name), path.end());
    circle.push_back(name);
    circles.push_back(
        reader_.Describe(*elements_[number], "nesting",
                         fmt::format("'{}'", fmt::join(circle.rbegin(), circle.rend(), "' in '")),
                         "groups that are not in themselves; none of these can be used"));
    return 0;
  }
  if (path.size() == static_cast<std::size_t>(kDeepestGroups)) FailDeep(number);
  levels_[number] = kOpen;
  path.push_back(name);
  int below = 0;
  for (const std::string& inner : groups_[number].groups) {
    below = std::max(below, Levels(numbers_.at(inner), path, circles));
  }
  path.pop_back();
  if (below == kDeepestGroups) FailDeep(number);
  return levels_[number] = below + 1;
}

}  // namespace oca::robot
