// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "oca/diagrams/live/live_server.h"

namespace oca::live {

// What is said over a connection, without the connection.
// source https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md, version 1

inline constexpr char kProtocol[] = "foxglove.websocket.v1";

/// What stands before the data of a message: opcode, subscription, time in ns.
using MessageHeader = std::array<unsigned char, 1 + 4 + 8>;
MessageHeader MakeHeader(std::uint32_t subscription, std::uint64_t time);

/// Bytes of `text` that are no UTF-8 are replaced.
std::string StatusText(StatusLevel level, const std::string& text);
std::string ServerInfo(const std::map<std::string, std::string>& about, const std::string& session);
/// Channel numbers are places in `channels`.
std::string Advertisement(const std::vector<record::RecordChannel>& channels);
/// That the first `count` channels are gone.
std::string Unadvertisement(std::size_t count);
/// An answer to the request `id` if it is not null.
std::string ParameterValues(const std::vector<LiveParameter>& parameters,
                            const nlohmann::ordered_json& id);
/// A JSON value as one of the type that `like` has. throws ConfigError.
LiveParameter::Value ReadValue(const nlohmann::ordered_json& json,
                               const LiveParameter::Value& like);

}  // namespace oca::live
