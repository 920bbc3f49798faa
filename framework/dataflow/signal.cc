// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/signal.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca {

// A vector port keeps its doubles in the arena itself, so nothing here is ever called with one
// value; the engine asks for `&kVectorType` and handles the length.
const SignalType kVectorType{
    {0, alignof(double), nullptr, nullptr, nullptr}, "Vector", nullptr, nullptr, nullptr};

namespace internal {

void ThrowIf(const Fault& fault) {
  if (!fault.ok()) throw ConfigError(fault.text());
}

}  // namespace internal

std::string DefaultJson(const SignalType& type) {
  std::size_t space = type.size + type.align;
  const auto memory = std::make_unique<std::byte[]>(space);
  void* at = memory.get();
  std::align(type.align, type.size, at, space);
  type.construct(at);
  std::string text;
  type.write_json(at, text);
  type.destroy(at);
  if (nlohmann::json::accept(text)) return text;
  throw ConfigError(
      fmt::format("signal type {}: WriteJson; got '{:.60}'; expected JSON", type.name, text));
}

void WriteVectorJson(const double* values, std::size_t n, std::string& out) {
  out += '[';
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) out += ',';
    // "-0" would be read back as the integer zero, which has no sign.
    if (values[i] == 0.0) {
      out += std::signbit(values[i]) ? "-0.0" : "0";
    } else if (std::isfinite(values[i])) {
      fmt::format_to(std::back_inserter(out), "{}", values[i]);
    } else {
      out += "null";
    }
  }
  out += ']';
}

Eigen::VectorXd ReadVectorJson(std::string_view text) {
  const auto json = internal::ReadJsonTree(text);
  if (!json.is_array()) {
    throw ConfigError(fmt::format("got {}; expected a list of numbers", text.substr(0, 60)));
  }
  Eigen::VectorXd vector(static_cast<Eigen::Index>(json.size()));
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (!json[i].is_number()) {
      throw ConfigError(
          fmt::format("item {}: got {}; expected a number", i, internal::JsonText(json[i])));
    }
    vector[static_cast<Eigen::Index>(i)] = json[i].get<double>();
  }
  if (!AllFinite(vector.data(), json.size())) {
    throw ConfigError("got a number that is not finite; expected finite numbers");
  }
  return vector;
}

}  // namespace oca
