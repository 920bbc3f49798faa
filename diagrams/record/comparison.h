// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/record/mcap_reader.h"

namespace oca::record {

/// Where two records first differ in time.
struct Difference {
  double time;  ///< s since the runs began
  std::string signal;
  std::string first, second;  ///< what they hold there; empty: nothing
};

/// How two records compare. When the runs were started does not count.
struct Comparison {
  std::optional<Difference> difference;  ///< none: the same signals, bit by bit
  int messages{0};                       ///< that were compared
  /// Each metric with its value in both; empty where it has none.
  struct Metric {
    std::string name;
    std::string first, second;
  };
  std::vector<Metric> metrics;
};

/// Compares signals and metrics, not pictures, which follow from the same values.
Comparison Compare(const McapFile& first, const McapFile& second);

}  // namespace oca::record
