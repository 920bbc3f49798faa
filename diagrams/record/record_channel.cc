// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record_channel.h"

#include "oca/diagrams/record/signal_json.h"

namespace oca::record {

std::string_view RecordSample::json() const {
  if (json_.empty()) {
    text_->clear();
    AppendSignal(*text_, *format_, value_);
    json_ = *text_;
  }
  return json_;
}

}  // namespace oca::record
