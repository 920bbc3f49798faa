// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/told_once.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace oca::loading {

void ToldOnce::Add(const std::string& use, const Diagnostic& diagnostic) {
  const auto same = std::find_if(told_.begin(), told_.end(), [&](const auto& told) {
    return told.first.what == diagnostic.what &&  // most differ here, before all is written out
           told.first.ToString() == diagnostic.ToString();
  });
  if (same == told_.end()) {
    told_.push_back({diagnostic, {use}});
  } else if (std::find(same->second.begin(), same->second.end(), use) == same->second.end()) {
    same->second.push_back(use);
  }
}

std::vector<Diagnostic> ToldOnce::all() const {
  std::vector<Diagnostic> all;
  for (const auto& [diagnostic, uses] : told_) {
    all.push_back(diagnostic);
    if (uses.front().empty()) continue;
    all.back().what = fmt::format("in {}: {}", fmt::join(uses, " and "), diagnostic.what);
  }
  return all;
}

}  // namespace oca::loading
