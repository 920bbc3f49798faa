// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "models/geometry/point_cloud.h"
#include "models/geometry/table_text.h"

namespace oca::models {
namespace {

namespace fs = std::filesystem;
using internal::RefuseText;

/// Heights row by row, without their unit.
struct Grid {
  std::size_t width{0};
  std::vector<double> values;
};

Grid ReadCsv(const fs::path& file, std::string_view rest) {
  Grid grid;
  for (int line = 1; !rest.empty(); ++line) {
    const auto words = internal::Words(internal::TakeLine(rest));
    if (words.empty() || words[0].starts_with('#')) continue;
    if (grid.width == 0) grid.width = words.size();
    if (words.size() != grid.width) {
      RefuseText(file, line, "row", fmt::format("{} values", words.size()),
                 fmt::format("{} as before", grid.width));
    }
    for (const std::string_view word : words) {
      const auto number = internal::ToNumber(word);
      if (!number) RefuseText(file, line, "height", word, "a number");
      grid.values.push_back(*number);
    }
  }
  return grid;
}

/// The next word of a PGM header, past blanks and comments.
std::string_view TakeWord(std::string_view& rest) {
  constexpr std::string_view kBlanks = " \t\r\n";
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    if (!rest.starts_with('#')) break;
    internal::TakeLine(rest);
  }
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

Grid ReadPgm(const fs::path& file, std::string_view rest) {
  const std::string_view magic = TakeWord(rest);
  if (magic != "P2" && magic != "P5") RefuseText(file, 1, "kind of PGM", magic, "P2 or P5");
  const auto take = [&](const char* what, double most) {
    const std::string_view word = TakeWord(rest);
    const auto number = internal::ToNumber(word);
    if (!number || !(*number >= 0.0 && *number <= most) || *number != std::floor(*number)) {
      RefuseText(file, 0, what, word, fmt::format("a whole number up to {}", most));
    }
    return *number;
  };
  Grid grid;
  grid.width = static_cast<std::size_t>(take("width", 10'000));
  const auto height = static_cast<std::size_t>(take("height", 10'000));
  const double white = std::max(take("largest grey value", 65'535), 1.0);
  const std::size_t count = grid.width * height;
  if (magic == "P2") {
    for (std::size_t i = 0; i < count; ++i)
      grid.values.push_back(take("grey value", white) / white);
    return grid;
  }
  const std::size_t bytes = white > 255.0 ? 2 : 1;
  if (rest.size() < 1 + bytes * count) {
    RefuseText(file, 0, "ends too early", fmt::format("{} bytes of pixels", rest.size()),
               fmt::format("{}", bytes * count));
  }
  const auto* at = reinterpret_cast<const unsigned char*>(rest.data()) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const int grey = bytes == 2 ? 256 * at[2 * i] + at[2 * i + 1] : at[i];
    grid.values.push_back(grey / white);
  }
  return grid;
}

}  // namespace

Compound LoadHeightmap(const fs::path& file, double cell, double scale) {
  for (const double size : {cell, scale}) {
    if (!(std::isfinite(size) && size > 0.0)) {
      RefuseText(file, 0, "cell and scale", fmt::format("{} m", size), "lengths above 0 m");
    }
  }
  const std::string text = internal::ReadWhole(file);
  const std::string kind = file.extension().string();
  if (kind != ".csv" && kind != ".pgm") {
    RefuseText(file, 0, "extension", "'" + kind + "'", ".pgm or .csv");
  }
  const Grid grid = kind == ".csv" ? ReadCsv(file, text) : ReadPgm(file, text);
  if (grid.values.empty()) RefuseText(file, 0, "holds no height", "none", "at least one");
  const std::size_t rows = grid.values.size() / grid.width;
  Compound map;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t first = 0, last = 0; first < grid.width; first = last) {
      const double value = grid.values[row * grid.width + first];
      if (!(std::isfinite(value) && value >= 0.0)) {
        RefuseText(file, 0, fmt::format("height in row {}", row + 1), fmt::format("{}", value),
                   "a finite number not below 0");
      }
      while (last < grid.width && grid.values[row * grid.width + last] == value) ++last;
      const double length = cell * static_cast<double>(last - first);
      const double height = cell + scale * value;
      CompoundPart& column = map.parts.emplace_back();
      column.shape = Box{{length, cell, height}};
      column.X_SP.translation() << cell * (static_cast<double>(first) -
                                           0.5 * static_cast<double>(grid.width)) +
                                       0.5 * length,
          cell * (0.5 * static_cast<double>(rows) - static_cast<double>(row) - 0.5),
          0.5 * height - cell;
    }
  }
  return map;
}

}  // namespace oca::models
