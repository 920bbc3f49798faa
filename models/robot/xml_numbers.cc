// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xml_numbers.h"

#include <charconv>
#include <cmath>

namespace oca::robot {

std::optional<std::vector<double>> ParseFiniteNumbers(std::string_view text) {
  std::vector<double> numbers;
  constexpr std::string_view kBlanks = " \t\r\n";
  for (std::size_t at = text.find_first_not_of(kBlanks); at != text.npos;
       at = text.find_first_not_of(kBlanks, at)) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    std::string_view word = text.substr(at, end - at);
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    double number = 0.0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(number)) {
      return std::nullopt;
    }
    numbers.push_back(number);
    at = end;
  }
  return numbers;
}

}  // namespace oca::robot
