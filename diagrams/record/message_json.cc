// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/message_json.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::record::internal {

nlohmann::ordered_json MessageJson(const McapFile& record, const McapMessage& message,
                                   std::string_view topic) {
  try {
    return oca::internal::ReadJsonTree(message.data);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: {}: message {}: {}", record.name(), topic, message.sequence,
                                  error.what()));
  }
}

}  // namespace oca::record::internal
