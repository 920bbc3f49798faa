// SPDX-License-Identifier: BSD-3-Clause
// Heightmaps, of point_cloud.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "oca/models/csv_table.h"
#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/file_cache.h"
#include "oca/models/geometry/point_cloud.h"
#include "oca/models/table_text.h"

namespace oca::geometry {
namespace {

namespace fs = std::filesystem;
using models::internal::RefuseText;

constexpr std::size_t kMostCells = 25'000'000;
constexpr std::size_t kMostBoxes = 1'000'000;

/// Heights row by row, without their unit.
struct Grid {
  std::size_t width{0};
  std::vector<double> values;
};

Grid ReadCsv(const fs::path& file) {
  models::CsvTable table(file);
  if (!table.names().empty()) {
    throw models::ModelError(fmt::format("{}: height; got '{}'; expected a number", table.where(),
                                         table.names().front()));
  }
  Grid grid;
  while (table.NextRow()) {
    grid.width = table.cells().size();
    for (std::size_t i = 0; i < grid.width; ++i) {
      const double height = table.Number(i);
      if (!(height >= 0.0)) {
        throw models::ModelError(
            fmt::format("{}: column {}: height; got {}; expected a number not below 0",
                        table.where(), i + 1, height));
      }
      grid.values.push_back(height);
    }
    if (grid.values.size() > kMostCells) {
      throw models::ModelError(fmt::format("{}: cells; got {}; expected at most {}", table.where(),
                                           grid.values.size(), kMostCells));
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
    models::internal::TakeLine(rest);
  }
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

Grid ReadPgm(const fs::path& file, std::string_view rest) {
  const std::string_view magic = TakeWord(rest);
  if (magic != "P2" && magic != "P5")
    models::internal::RefuseText(file, 1, "kind of PGM", magic, "P2 or P5");
  const auto take = [&](const char* what, std::uint64_t most) {
    const std::string_view word = TakeWord(rest);
    const auto number = models::internal::ToCount(word, most);
    if (!number)
      models::internal::RefuseText(file, 0, what, word,
                                   fmt::format("a whole number up to {}", most));
    return *number;
  };
  Grid grid;
  grid.width = take("width", 10'000);
  const std::uint64_t count = grid.width * take("height", 10'000);
  if (count > kMostCells) {
    models::internal::RefuseText(file, 0, "cells", fmt::format("{}", count),
                                 fmt::format("at most {}", kMostCells));
  }
  const std::uint64_t brightest = take("largest grey value", 65'535);
  if (brightest == 0) {
    models::internal::RefuseText(file, 0, "largest grey value", "0", "1 to 65535");
  }
  const auto white = static_cast<double>(brightest);
  if (magic == "P2") {
    for (std::uint64_t i = 0; i < count; ++i) {
      grid.values.push_back(static_cast<double>(take("grey value", brightest)) / white);
    }
    return grid;
  }
  const std::uint64_t bytes = brightest > 255 ? 2 : 1;
  if (rest.size() < 1 + bytes * count) {
    models::internal::RefuseText(
        file, 0, "ends too early",
        fmt::format("{} bytes of pixels", rest.empty() ? 0 : rest.size() - 1),
        fmt::format("{}", bytes * count));
  }
  const auto* at = reinterpret_cast<const unsigned char*>(rest.data()) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned grey = bytes == 2 ? 256u * at[2 * i] + at[2 * i + 1] : at[i];
    if (grey > brightest) {
      models::internal::RefuseText(file, 0, "grey value", fmt::format("{} as pixel {}", grey, i),
                                   fmt::format("a whole number up to {}", brightest));
    }
    grid.values.push_back(grey / white);
  }
  return grid;
}

/// How many boxes the columns make, equal neighbours in a row being one.
std::size_t CountBoxes(const fs::path& file, const Grid& grid) {
  std::size_t boxes = 0;
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    if (i % grid.width == 0 || grid.values[i] != grid.values[i - 1]) ++boxes;
  }
  if (boxes > kMostBoxes) {
    models::internal::RefuseText(
        file, 0, "boxes of unequal heights", fmt::format("{}", boxes),
        fmt::format("at most {}; equal neighbours in a row are one", kMostBoxes));
  }
  return boxes;
}

}  // namespace

Compound LoadHeightmap(const fs::path& file, double cell, double scale) {
  for (const double size : {cell, scale}) {
    if (!(std::isfinite(size) && size > 0.0)) {
      models::internal::RefuseText(file, 0, "cell and scale", fmt::format("{} m", size),
                                   "lengths above 0 m");
    }
  }
  const std::string kind = models::internal::Lower(file.extension().string());
  if (kind != ".csv" && kind != ".pgm") {
    models::internal::RefuseText(file, 0, "extension", "'" + kind + "'", ".pgm or .csv");
  }
  const auto read = models::ReadOnce<Grid>(file, "heightmap", [&] {
    return kind == ".csv" ? ReadCsv(file) : ReadPgm(file, models::ReadFile(file));
  });
  const Grid& grid = *read;
  if (grid.values.empty())
    models::internal::RefuseText(file, 0, "holds no height", "none", "at least one");
  const std::size_t rows = grid.values.size() / grid.width;
  Compound map;
  map.parts.reserve(CountBoxes(file, grid));
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t first = 0, last = 0; first < grid.width; first = last) {
      const double value = grid.values[row * grid.width + first];
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

}  // namespace oca::geometry
