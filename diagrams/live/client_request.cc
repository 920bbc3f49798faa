// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/client_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::live::internal {
namespace {

using nlohmann::ordered_json;
using oca::internal::JsonText;
using oca::internal::WholeNumber;
using Kind = ClientRequest::Kind;

constexpr std::array<std::pair<std::string_view, Kind>, 6> kOps{
    {{"subscribe", Kind::kSubscribe},
     {"unsubscribe", Kind::kUnsubscribe},
     {"getParameters", Kind::kGetParameters},
     {"setParameters", Kind::kSetParameters},
     {"subscribeParameterUpdates", Kind::kWatchParameters},
     {"unsubscribeParameterUpdates", Kind::kLeaveParameters}}};

[[noreturn]] void Refuse(const char* where, const ordered_json& got, const char* expected) {
  throw ConfigError(fmt::format("{}: got {:.60}; expected {}", where, JsonText(got), expected));
}

/// A member of an object; null if there is none.
const ordered_json& Member(const ordered_json& json, const char* key) {
  static const ordered_json kNone;
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() ? *found : kNone;
}

std::string TextOf(const ordered_json& json, const char* key) {
  const ordered_json& text = Member(json, key);
  if (!text.is_string()) Refuse(key, text, "a text");
  return text.get<std::string>();
}

const ordered_json& ListOf(const ordered_json& json, const char* key) {
  const ordered_json& list = Member(json, key);
  if (!list.is_array()) Refuse(key, list, "a list");
  return list;
}

template <class Read>
auto At(const char* where, const Read& read) {
  try {
    return read();
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: {}", where, error.what()));
  }
}

Kind KindOf(const ordered_json& json) {
  const std::string op = TextOf(json, "op");
  const auto found =
      std::find_if(kOps.begin(), kOps.end(), [&op](const auto& one) { return one.first == op; });
  if (found == kOps.end()) Refuse("op", json.at("op"), "one of foxglove.websocket.v1");
  return found->second;
}

void ReadSubscriptions(const ordered_json& json, std::size_t channels, ClientRequest& request) {
  for (const ordered_json& item : ListOf(json, "subscriptions")) {
    const auto id = At("id", [&] { return WholeNumber<std::uint32_t>(Member(item, "id")); });
    const auto channel = At("channelId", [&] {
      return WholeNumber(Member(item, "channelId"), 0, static_cast<std::int64_t>(channels) - 1);
    });
    const bool taken = std::any_of(request.subscriptions.begin(), request.subscriptions.end(),
                                   [id](const auto& one) { return one.id == id; });
    if (taken) Refuse("id", Member(item, "id"), "each subscription's once");
    request.subscriptions.push_back({id, static_cast<int>(channel)});
  }
}

void ReadNames(const ordered_json& json, ClientRequest& request) {
  if (Member(json, "parameterNames").is_null()) return;
  for (const ordered_json& name : ListOf(json, "parameterNames")) {
    if (!name.is_string()) Refuse("parameterNames", name, "texts");
    request.names.push_back(name.get<std::string>());
  }
}

}  // namespace

ClientRequest ReadRequest(std::string_view text, std::size_t channels) {
  const ordered_json json = oca::internal::ReadJsonTree(text);
  ClientRequest request;
  request.kind = KindOf(json);
  request.id = Member(json, "id");
  const bool known =
      request.id.is_null() || request.id.is_string() || request.id.is_number_integer();
  if (!known) Refuse("id", request.id, "a text");
  switch (request.kind) {
    case Kind::kSubscribe:
      ReadSubscriptions(json, channels, request);
      break;
    case Kind::kUnsubscribe:
      for (const ordered_json& id : ListOf(json, "subscriptionIds")) {
        request.ids.push_back(
            At("subscriptionIds", [&] { return WholeNumber<std::uint32_t>(id); }));
      }
      break;
    case Kind::kGetParameters:
      ReadNames(json, request);
      break;
    case Kind::kSetParameters:
      for (const ordered_json& item : ListOf(json, "parameters")) {
        request.values.emplace_back(TextOf(item, "name"), Member(item, "value"));
      }
      break;
    default:
      break;
  }
  return request;
}

}  // namespace oca::live::internal
