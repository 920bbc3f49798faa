// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/message_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "oca/models/json_values.h"

namespace oca::record {
namespace {

void AppendInteger(std::string& out, std::uint64_t number) {
  char text[24];
  out.append(text, std::to_chars(text, text + sizeof text, number).ptr);
}

}  // namespace

void AppendShort(std::string& out, double number) {
  constexpr double kLargest = 1e9;
  constexpr int kDecimals = 6;
  if (!(std::fabs(number) < kLargest)) return models::internal::AppendJson(out, number);
  const auto millionths = static_cast<std::uint64_t>(std::llround(std::fabs(number) * 1e6));
  if (number < 0.0 && millionths != 0) out += '-';
  AppendInteger(out, millionths / 1'000'000);
  std::uint64_t rest = millionths % 1'000'000;
  if (rest == 0) return;
  char digits[kDecimals];
  int used = kDecimals;
  for (int i = kDecimals - 1; i >= 0; --i, rest /= 10) {
    digits[i] = static_cast<char>('0' + rest % 10);
    if (digits[i] == '0' && used == i + 1) used = i;
  }
  out += '.';
  out.append(digits, static_cast<std::size_t>(used));
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

void AppendTime(std::string& out, std::uint64_t nanoseconds) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  out += "{\"sec\":";
  AppendInteger(out, nanoseconds / kSecond);
  out += ",\"nsec\":";
  AppendInteger(out, nanoseconds % kSecond);
  out += '}';
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
