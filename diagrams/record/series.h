// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/mcap_reader.h"

namespace oca::record {

/// One number of a recorded signal over time.
struct Series {
  std::string name;           ///< `system.port.joint`, `system.port[index]` or `system.port.member`
  std::string unit;           ///< may be empty
  std::vector<double> times;  ///< s since the run began
  std::vector<double> values;
  std::string signal;  ///< that it is of, `system.port`
};

/// Whether a channel carries a signal `/system/port` rather than a picture, log or summary.
bool IsSignal(const McapChannel& channel);
/// `system.port`
std::string SignalName(const McapChannel& channel);
/// When the run of a record began, ns since the epoch.
std::uint64_t StartOf(const McapFile& record);

/// The numbers of all signals whose name, or that of the signal they belong to, matches a pattern
/// with `*` and `?`. Of proximities the distance of each pair is one, `system.port.link/obstacle`.
std::vector<Series> ReadSeries(const McapFile& record, const std::string& pattern);

}  // namespace oca::record
