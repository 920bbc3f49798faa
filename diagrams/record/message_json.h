// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "oca/diagrams/record/mcap_reader.h"

namespace oca::record::internal {

/// A message of a record as a tree. throws ConfigError `FILE: TOPIC: message N: JSON: ...`
nlohmann::ordered_json MessageJson(const McapFile& record, const McapMessage& message,
                                   std::string_view topic);

}  // namespace oca::record::internal
