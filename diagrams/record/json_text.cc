// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/record/json_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>

namespace oca::record {
namespace {

template <class Number>
void AppendShortest(std::string& out, Number number) {
  if (!std::isfinite(number)) {
    out += "null";
    return;
  }
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, number).ptr;
  out.append(text, end);
}

}  // namespace

void AppendJson(std::string& out, double number) { AppendShortest(out, number); }

void AppendShort(std::string& out, double number) {
  AppendShortest(out, static_cast<float>(number));
}

void AppendQuoted(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      fmt::format_to(std::back_inserter(out), "\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  out += '"';
}

void AppendXyz(std::string& out, const Eigen::Vector3d& vector) {
  out += "{\"x\":";
  AppendShort(out, vector.x());
  out += ",\"y\":";
  AppendShort(out, vector.y());
  out += ",\"z\":";
  AppendShort(out, vector.z());
  out += '}';
}

void AppendQuaternion(std::string& out, const Eigen::Quaterniond& rotation) {
  out += "{\"x\":";
  AppendShort(out, rotation.x());
  out += ",\"y\":";
  AppendShort(out, rotation.y());
  out += ",\"z\":";
  AppendShort(out, rotation.z());
  out += ",\"w\":";
  AppendShort(out, rotation.w());
  out += '}';
}

void AppendList(std::string& out, const Eigen::Vector3d& vector) {
  char separator = '[';
  for (const double number : vector) {
    out += separator;
    AppendJson(out, number);
    separator = ',';
  }
  out += ']';
}

void AppendTime(std::string& out, std::uint64_t nanoseconds) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  fmt::format_to(std::back_inserter(out), "{{\"sec\":{},\"nsec\":{}}}", nanoseconds / kSecond,
                 nanoseconds % kSecond);
}

void AppendBase64(std::string& out, std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      word = (word << 8) | (i < count ? static_cast<std::uint8_t>(bytes[at + i]) : 0u);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      out += i <= count ? kDigits[(word >> (18 - 6 * i)) & 63] : '=';
    }
  }
}

}  // namespace oca::record
