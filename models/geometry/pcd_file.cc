// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/pcd_file.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "oca/models/file_bytes.h"
#include "oca/models/geometry/binary_scalar.h"
#include "oca/models/geometry/lzf.h"
#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr std::uint64_t kMostPoints = 100'000'000;
constexpr std::uint64_t kMostRecord = 1'000'000;  // bytes of a point

enum class Data { kText, kBinary, kCompressed };

/// What the lines of the header say before they are put together.
struct PcdHeader {
  std::vector<std::string_view> names, sizes, types, counts;
  std::uint64_t points{0};
  std::optional<std::uint64_t> width, height;  // of the grid that the points make
  Data data{Data::kText};
  int lines{0};
};

struct Coordinate {
  Scalar scalar;
  std::uint64_t offset{0};  // in the record of a point, bytes
  std::uint64_t stride{0};  // of its field, which may have several values
  std::uint64_t column{0};  // in a line of text
};

struct Layout {
  std::uint64_t record{0};   // bytes of a point
  std::uint64_t columns{0};  // of a point, in text
  std::array<std::optional<Coordinate>, 3> axes;
};

Data DataOf(const fs::path& file, int line, std::string_view word) {
  if (word == "ascii") return Data::kText;
  if (word == "binary") return Data::kBinary;
  if (word == "binary_compressed") return Data::kCompressed;
  models::internal::RefuseText(file, line, "DATA", models::internal::Shown(word),
                               "ascii, binary or binary_compressed");
}

std::uint64_t CountOf(const fs::path& file, int line, std::string_view what,
                      std::string_view word) {
  const auto count = models::internal::ToCount(word, kMostPoints);
  if (count) return *count;
  models::internal::RefuseText(file, line, what, models::internal::Shown(word),
                               fmt::format("0 to {}", kMostPoints));
}

void CheckGrid(const fs::path& file, const PcdHeader& header) {
  if (!header.width || !header.height || *header.width * *header.height == header.points) return;
  models::internal::RefuseText(
      file, header.lines, "number of points", fmt::format("{}", header.points),
      fmt::format("WIDTH times HEIGHT, {} times {}", *header.width, *header.height));
}

/// Behind the points of a header, whatever their number is, no other one may follow.
void CheckEnd(const fs::path& file, const PcdHeader& header, bool more) {
  if (!more) return;
  models::internal::RefuseText(file, 0, "goes on behind its points", "more points",
                               fmt::format("{}", header.points));
}

/// Takes the header off `rest`.
PcdHeader ReadPcdHeader(const fs::path& file, std::string_view& rest) {
  PcdHeader header;
  int& line = header.lines;
  while (!rest.empty()) {
    const auto words = models::internal::Words(models::internal::TakeTableLine(file, ++line, rest));
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    const std::string_view first = values.empty() ? "none" : values[0];
    if (words[0] == "FIELDS") {
      header.names = values;
    } else if (words[0] == "SIZE") {
      header.sizes = values;
    } else if (words[0] == "TYPE") {
      header.types = values;
    } else if (words[0] == "COUNT") {
      header.counts = values;
    } else if (words[0] == "POINTS") {
      header.points = CountOf(file, line, "number of points", first);
    } else if (words[0] == "WIDTH") {
      header.width = CountOf(file, line, "width", first);
    } else if (words[0] == "HEIGHT") {
      header.height = CountOf(file, line, "height", first);
    } else if (words[0] == "DATA") {
      header.data = DataOf(file, line, first);
      CheckGrid(file, header);
      return header;
    } else if (words[0] != "VERSION" && words[0] != "VIEWPOINT") {
      models::internal::RefuseText(file, line, "header", models::internal::Shown(words[0]),
                                   "a line of the PCD format");
    }
  }
  models::internal::RefuseText(file, line, "ends in its header", "no DATA", "one");
}

/// Appends a field; both sums stay below kMostRecord.
void Append(const fs::path& file, int line, std::string_view name, const Scalar& scalar,
            std::uint64_t copies, Layout& layout) {
  if (copies > (kMostRecord - layout.record) / scalar.size) {
    models::internal::RefuseText(file, line, "record of a point",
                                 fmt::format("more than {} bytes", kMostRecord),
                                 fmt::format("at most {}", kMostRecord));
  }
  const std::size_t axis = name.size() == 1 ? std::string_view("xyz").find(name[0]) : 3;
  if (axis < 3) {
    if (layout.axes[axis]) {
      models::internal::RefuseText(file, line, "fields", name, "each coordinate once");
    }
    layout.axes[axis] = {scalar, layout.record, scalar.size * copies, layout.columns};
  }
  layout.record += scalar.size * copies;
  layout.columns += copies;
}

Layout LayoutOf(const fs::path& file, const PcdHeader& header) {
  const std::size_t count = header.names.size();
  if (header.sizes.size() != count || header.types.size() != count ||
      (!header.counts.empty() && header.counts.size() != count)) {
    models::internal::RefuseText(file, header.lines, "header",
                                 "FIELDS, SIZE, TYPE and COUNT of unequal length", "equal ones");
  }
  Layout layout;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view type = header.types[i];
    const auto size = models::internal::ToCount(header.sizes[i], 8);
    const auto copies = header.counts.empty()
                            ? std::optional<std::uint64_t>(1)
                            : models::internal::ToCount(header.counts[i], kMostRecord);
    const bool known = size && (*size == 1 || *size == 2 || *size == 4 || *size == 8) &&
                       (type == "I" || type == "U" || (type == "F" && *size >= 4));
    if (!known || !copies || *copies == 0) {
      models::internal::RefuseText(
          file, header.lines, fmt::format("field '{}'", models::internal::Shown(header.names[i])),
          models::internal::Shown(type),
          "TYPE F, I or U with a SIZE of 1, 2, 4 or 8 bytes and a COUNT above 0");
    }
    // Padding, which is not compressed.
    if (header.data == Data::kCompressed && header.names[i] == "_") continue;
    Append(file, header.lines, header.names[i], {*size, type[0]}, *copies, layout);
  }
  for (const auto& axis : layout.axes) {
    if (!axis) {
      models::internal::RefuseText(file, 0, "has no coordinates", "other fields", "x, y and z");
    }
  }
  return layout;
}

std::vector<Vector3d> ReadText(const fs::path& file, const PcdHeader& header, const Layout& layout,
                               std::string_view rest) {
  std::vector<Vector3d> points;
  int line = header.lines;
  for (std::uint64_t i = 0; i < header.points; ++i) {
    if (rest.empty()) {
      models::internal::RefuseText(file, line, "ends too early", fmt::format("{} points", i),
                                   fmt::format("{}", header.points));
    }
    const auto words = models::internal::Words(models::internal::TakeTableLine(file, ++line, rest));
    if (words.size() != layout.columns) {
      models::internal::RefuseText(file, line, "no point", fmt::format("{} values", words.size()),
                                   fmt::format("{}", layout.columns));
    }
    Vector3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view word = words[layout.axes[axis]->column];
      const auto number = models::internal::ToNumber(word);
      if (!number) {
        models::internal::RefuseText(file, line, "no point", models::internal::Shown(word),
                                     "numbers");
      }
      point[static_cast<Eigen::Index>(axis)] = *number;
    }
    points.push_back(point);
  }
  CheckEnd(file, header, rest.find_first_not_of(" \t\r\n") != rest.npos);
  return points;
}

/// Of `count` points, whose record stands at `at(coordinate, point)`.
template <class At>
std::vector<Vector3d> Decoded(const Layout& layout, std::uint64_t count, const At& at) {
  std::vector<Vector3d> points(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Coordinate& coordinate = *layout.axes[axis];
      points[i][static_cast<Eigen::Index>(axis)] =
          Decode(coordinate.scalar, at(coordinate, i), false);
    }
  }
  return points;
}

std::vector<Vector3d> ReadBinary(const fs::path& file, const PcdHeader& header,
                                 const Layout& layout, std::string_view rest) {
  const std::uint64_t there = rest.size() / layout.record;
  if (there < header.points) {
    models::internal::RefuseText(
        file, 0, "ends too early", fmt::format("{} points", there),
        fmt::format("{} points of {} bytes", header.points, layout.record));
  }
  CheckEnd(file, header, there > header.points);
  return Decoded(layout, header.points, [&](const Coordinate& coordinate, std::uint64_t i) {
    return rest.data() + i * layout.record + coordinate.offset;
  });
}

/// Two sizes of 4 bytes each, then LZF of all points' first field, of their second, and so on.
std::vector<Vector3d> ReadCompressed(const fs::path& file, const PcdHeader& header,
                                     const Layout& layout, std::string_view rest) {
  constexpr Scalar kSize{4, 'U'};
  if (rest.size() < 8) {
    models::internal::RefuseText(file, 0, "ends too early", fmt::format("{} bytes", rest.size()),
                                 "two sizes of 4 bytes");
  }
  const auto packed = static_cast<std::uint64_t>(Decode(kSize, rest.data(), false));
  const auto size = static_cast<std::uint64_t>(Decode(kSize, rest.data() + 4, false));
  rest.remove_prefix(8);
  if (packed > rest.size()) {
    models::internal::RefuseText(file, 0, "ends too early", fmt::format("{} bytes", rest.size()),
                                 fmt::format("{} of compressed points", packed));
  }
  const std::uint64_t expected = header.points * layout.record;  // both are bounded above
  if (size != expected || size > models::kMostFileBytes) {
    models::internal::RefuseText(file, 0, "size of the points", fmt::format("{} bytes", size),
                                 fmt::format("{} for {} points of {} bytes, at most {}", expected,
                                             header.points, layout.record, models::kMostFileBytes));
  }
  const auto data = DecompressLzf(rest.substr(0, packed), size);
  if (!data) {
    models::internal::RefuseText(file, 0, "compressed points", "damaged data",
                                 fmt::format("LZF of {} bytes", size));
  }
  return Decoded(layout, header.points, [&](const Coordinate& coordinate, std::uint64_t i) {
    return data->data() + header.points * coordinate.offset + i * coordinate.stride;
  });
}

}  // namespace

std::vector<Vector3d> ReadPcd(const fs::path& file, std::string_view text) {
  const PcdHeader header = ReadPcdHeader(file, text);
  const Layout layout = LayoutOf(file, header);
  switch (header.data) {
    case Data::kText:
      return ReadText(file, header, layout, text);
    case Data::kBinary:
      return ReadBinary(file, header, layout, text);
    default:
      return ReadCompressed(file, header, layout, text);
  }
}

}  // namespace oca::geometry::internal
