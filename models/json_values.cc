// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/json_values.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "oca/models/foreign_text.h"

namespace oca::models::internal {

void AppendJson(std::string& out, double number) {
  if (!std::isfinite(number)) {
    out += "null";
    return;
  }
  if (number == 0.0) {  // "-0" would be read back as the integer zero, which has no sign
    out += std::signbit(number) ? "-0.0" : "0";
    return;
  }
  char text[40];  // fmt finds the shortest digits in less time than std::to_chars
  out.append(text, fmt::format_to(text, FMT_COMPILE("{}"), number));
}

void AppendQuoted(std::string& out, std::string_view text) {
  if (Utf8Prefix(text) < text.size()) {  // a name of a file, perhaps
    return AppendQuoted(out, AsUtf8(text));
  }
  const auto special = [](char c) {
    return c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  };
  out += '"';
  for (auto at = text.begin(); at != text.end();) {
    const auto plain = std::find_if(at, text.end(), special);
    out.append(at, plain);
    if (plain == text.end()) break;
    if (*plain == '"' || *plain == '\\') {
      out += '\\';
      out += *plain;
    } else {
      fmt::format_to(std::back_inserter(out), "\\u{:04x}", static_cast<unsigned>(*plain));
    }
    at = plain + 1;
  }
  out += '"';
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

}  // namespace oca::models::internal
