// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/repair_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>

#include <algorithm>
#include <utility>

namespace oca::robot {

void RepairNotes::Add(const char* what, const TiXmlElement& element, const std::string& which) {
  places_[what].push_back(fmt::format("{} (line {})", which, element.Row()));
}

void RepairNotes::Drop(TiXmlNode& parent, TiXmlElement& element, const char* what,
                       const std::string& which) {
  Add(what, element, which);
  parent.RemoveChild(&element);
}

WarningLines RepairNotes::Lines() const {
  constexpr std::size_t kShown = 3;
  WarningLines lines;
  for (const auto& [what, places] : places_) {
    for (const std::string& place : places) {
      lines.each.push_back(fmt::format("{}: {}", what, place));
    }
    const std::size_t shown = std::min(kShown, places.size());
    std::string sum = fmt::format(
        "{}: {}", what,
        fmt::join(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
    if (shown < places.size()) sum += fmt::format(" and {} more", places.size() - shown);
    lines.sums.push_back(std::move(sum));
  }
  return lines;
}

std::string QuotedName(const TiXmlElement& element) {
  const char* const name = element.Attribute("name");
  return fmt::format("'{}'", name == nullptr ? "" : name);
}

}  // namespace oca::robot
