// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/ws_protocol.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::live {
namespace {

using nlohmann::ordered_json;

template <class Number>
void PutLittleEndian(unsigned char* at, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i) {
    at[i] = static_cast<unsigned char>(number >> (8 * i));
  }
}

ordered_json ToJson(const LiveParameter& parameter) {
  ordered_json json{{"name", parameter.name}};
  std::visit([&](const auto& value) { json["value"] = value; }, parameter.value);
  if (std::holds_alternative<double>(parameter.value)) json["type"] = "float64";
  if (std::holds_alternative<std::vector<double>>(parameter.value)) json["type"] = "float64_array";
  return json;
}

/// Names may be no UTF-8, as those of files.
std::string Dump(const ordered_json& json) { return oca::internal::JsonText(json); }

}  // namespace

MessageHeader MakeHeader(std::uint32_t subscription, std::uint64_t time) {
  constexpr unsigned char kMessageData = 1;
  MessageHeader header{kMessageData};
  PutLittleEndian(&header[1], subscription);
  PutLittleEndian(&header[5], time);
  return header;
}

std::string StatusText(StatusLevel level, const std::string& text) {
  const ordered_json json{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", text}};
  return Dump(json);
}

std::string ServerInfo(const std::map<std::string, std::string>& about,
                       const std::string& session) {
  return Dump({{"op", "serverInfo"},
               {"name", "OCA simulator"},
               {"capabilities", {"parameters", "parametersSubscribe"}},
               {"supportedEncodings", {"json"}},
               {"metadata", about},
               {"sessionId", session}});
}

std::string Advertisement(const std::vector<record::RecordChannel>& channels) {
  ordered_json json{{"op", "advertise"}, {"channels", ordered_json::array()}};
  for (std::size_t i = 0; i < channels.size(); ++i) {
    json["channels"].push_back({{"id", i},
                                {"topic", channels[i].topic},
                                {"encoding", "json"},
                                {"schemaName", channels[i].schema_name},
                                {"schema", channels[i].schema},
                                {"schemaEncoding", "jsonschema"}});
  }
  return Dump(json);
}

std::string Unadvertisement(std::size_t count) {
  ordered_json gone{{"op", "unadvertise"}, {"channelIds", ordered_json::array()}};
  for (std::size_t i = 0; i < count; ++i) gone["channelIds"].push_back(i);
  return Dump(gone);
}

std::string ParameterValues(const std::vector<LiveParameter>& parameters, const ordered_json& id) {
  ordered_json json{{"op", "parameterValues"}, {"parameters", ordered_json::array()}};
  for (const LiveParameter& parameter : parameters) json["parameters"].push_back(ToJson(parameter));
  if (!id.is_null()) json["id"] = id;
  return Dump(json);
}

/// A JSON value as one of the type that `like` has. throws ConfigError.
LiveParameter::Value ReadValue(const ordered_json& json, const LiveParameter::Value& like) {
  if (std::holds_alternative<bool>(like) && json.is_boolean()) return json.get<bool>();
  if (std::holds_alternative<double>(like) && json.is_number()) return json.get<double>();
  if (std::holds_alternative<std::string>(like) && json.is_string()) return json.get<std::string>();
  if (const auto* const numbers = std::get_if<std::vector<double>>(&like);
      numbers && json.is_array() && json.size() == numbers->size() &&
      std::all_of(json.begin(), json.end(), [](const auto& item) { return item.is_number(); })) {
    return json.get<std::vector<double>>();
  }
  throw ConfigError("another type or length of the value");
}

}  // namespace oca::live
