// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/told_once.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace oca::loading {
namespace {

/// Where WHAT begins.
std::size_t EndOfKind(const std::string& line) {
  std::size_t end = std::string::npos;
  for (const std::string kind : {": error: ", ": warning: "}) {
    const std::size_t at = line.find(kind);
    if (at != std::string::npos) end = std::min(end, at + kind.size());
  }
  return end == std::string::npos ? 0 : end;
}

}  // namespace

void ToldOnce::Add(const std::string& use, const std::string& line) {
  const auto same = std::find_if(told_.begin(), told_.end(),
                                 [&](const auto& told) { return told.first == line; });
  if (same == told_.end()) {
    told_.push_back({line, {use}});
  } else if (std::find(same->second.begin(), same->second.end(), use) == same->second.end()) {
    same->second.push_back(use);
  }
}

std::vector<std::string> ToldOnce::Lines() const {
  std::vector<std::string> lines;
  for (const auto& [line, uses] : told_) {
    if (uses.front().empty()) {
      lines.push_back(line);
      continue;
    }
    const std::size_t end = EndOfKind(line);
    lines.push_back(fmt::format("{}in {}: {}", line.substr(0, end), fmt::join(uses, " and "),
                                line.substr(end)));
  }
  return lines;
}

}  // namespace oca::loading
