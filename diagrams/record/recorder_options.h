// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "oca/diagrams/files/override.h"

namespace oca::record {

struct RecorderOptions {
  /// Told of as those of the command line; else those that the diagram was loaded with.
  std::optional<std::vector<files::Override>> overrides{};
  std::uint64_t start_epoch{0};  ///< ns; 0: the wall clock's
  bool attach_files{true};       ///< diagram and models, to run the record again
  bool brief{false};             ///< for a picture: of proximities only names and distance
};

}  // namespace oca::record
