// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace oca::live::internal {

/// What a client asks for. source foxglove.websocket.v1, "Client Data"
struct ClientRequest {  // NOLINT(bugprone-exception-escape): a null of JSON throws nothing
  enum class Kind {
    kSubscribe,
    kUnsubscribe,
    kGetParameters,
    kSetParameters,
    kWatchParameters,
    kLeaveParameters
  };
  struct Subscription {
    std::uint32_t id;
    int channel;
  };

  Kind kind{};
  std::vector<Subscription> subscriptions{};  ///< to channels that there are, each id once
  std::vector<std::uint32_t> ids{};           ///< of subscriptions to end
  std::vector<std::string> names{};           ///< of parameters; none: all
  /// Of parameters by name, of any type.
  std::vector<std::pair<std::string, nlohmann::ordered_json>> values{};
  nlohmann::ordered_json id{};  ///< a text or a whole number, by which an answer is known; or null
};

/// Reads a message of a client whole or refuses it. `channels`: how many there are.
/// throws ConfigError `op: got X; expected Y`
ClientRequest ReadRequest(std::string_view text, std::size_t channels);

}  // namespace oca::live::internal
