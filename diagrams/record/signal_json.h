// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/record/record_channel.h"

namespace oca::record {

/// `/system/port`
std::string TopicOf(const SignalFormat& format);

/// The channel of a signal, with the JSON Schema of its messages: a Vector of joints is an object
/// by joint name, another one {"values": [...]}; a list {"port": [...]}; anything else as it is.
RecordChannel ChannelOf(const SignalFormat& format);

/// Appends a value as a message; of a Vector the numbers.
void AppendSignal(std::string& out, const SignalFormat& format, const void* value);

}  // namespace oca::record
