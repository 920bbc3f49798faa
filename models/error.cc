// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "oca/models/counted.h"

namespace oca::models {

void ModelErrors::Throw() const {
  constexpr std::size_t kShown = 50;
  if (lines_.empty()) return;
  const auto end = lines_.begin() + static_cast<std::ptrdiff_t>(std::min(kShown, lines_.size()));
  std::string text = fmt::format("{}", fmt::join(lines_.begin(), end, "\n"));
  if (lines_.size() > kShown) text += "\nand " + Counted(lines_.size() - kShown, "more error");
  throw ModelError(text);
}

}  // namespace oca::models
