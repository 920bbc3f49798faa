// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/record_sink.h"
#include "oca/framework/dataflow/signal.h"

namespace oca::record {

/// How one output becomes messages.
struct SignalFormat {
  std::string system;
  std::string port;
  const SignalType* type;
  int length;                       ///< of a Vector
  std::string unit;                 ///< of a Vector; may be empty
  std::vector<std::string> joints;  ///< one an element; empty: no joints
  bool brief{false};                ///< of proximities only names and distance
};

/// Topic `/system/port` and the JSON Schema of its messages: a Vector of joints is an object by
/// joint name, another one {"values": [...]}; a list {"port": [...]}; anything else as it is.
RecordChannel ChannelOf(const SignalFormat& format);

/// Appends a value as a message; of a Vector the numbers.
void AppendSignal(std::string& out, const SignalFormat& format, const void* value);

}  // namespace oca::record
