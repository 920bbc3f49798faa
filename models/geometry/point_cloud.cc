// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/point_cloud.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "oca/models/csv_table.h"
#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/table_text.h"

namespace oca::geometry {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using models::internal::RefuseText;
using models::internal::TakeLine;
using models::internal::ToNumber;
using models::internal::Words;

/// A scalar of a binary record.
struct Field {
  std::size_t offset{0};
  std::size_t size{0};
  char kind{'F'};  // F float, I integer, U unsigned
};

/// What the header of a PLY or PCD file says.
struct Layout {
  bool text{true};
  std::uint64_t count{0};
  std::uint64_t record{0};      // bytes of a point
  std::uint64_t columns{0};     // of a point, in text
  std::array<Field, 3> fields;  // x, y, z
  std::array<std::optional<std::size_t>, 3> column;

  /// Appends a field; both sums stay below kMostBytes.
  void Add(const fs::path& file, int line, std::string_view name, const Field& field,
           std::uint64_t copies) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (name != std::string_view("xyz").substr(axis, 1)) continue;
      if (column[axis])
        models::internal::RefuseText(file, line, "fields", name, "each coordinate once");
      fields[axis] = {record, field.size, field.kind};
      column[axis] = columns;
    }
    if (copies > (kMostBytes - record) / field.size) {
      models::internal::RefuseText(file, line, "record of a point",
                                   fmt::format("more than {} bytes", kMostBytes),
                                   fmt::format("at most {}", kMostBytes));
    }
    record += field.size * copies;
    columns += copies;
  }

  static constexpr std::uint64_t kMostBytes = 1'000'000;
};

template <class T>
double As(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double Decode(const Field& field, const char* record) {
  const char* const at = record + field.offset;
  if (field.kind == 'F') return field.size == 4 ? As<float>(at) : As<double>(at);
  const bool with_sign = field.kind == 'I';
  switch (field.size) {
    case 1:
      return with_sign ? As<std::int8_t>(at) : As<std::uint8_t>(at);
    case 2:
      return with_sign ? As<std::int16_t>(at) : As<std::uint16_t>(at);
    case 4:
      return with_sign ? As<std::int32_t>(at) : As<std::uint32_t>(at);
    default:
      return with_sign ? As<std::int64_t>(at) : As<std::uint64_t>(at);
  }
}

void Keep(const Vector3d& point, std::vector<Vector3d>& points) {
  if (point.allFinite()) points.push_back(point);
}

std::vector<Vector3d> ReadBinary(const fs::path& file, const Layout& layout,
                                 std::string_view rest) {
  const std::uint64_t record = layout.record;
  if (rest.size() / record < layout.count) {
    models::internal::RefuseText(file, 0, "ends too early",
                                 fmt::format("{} points", rest.size() / record),
                                 fmt::format("{} points of {} bytes", layout.count, record));
  }
  std::vector<Vector3d> points;
  points.reserve(layout.count);
  for (std::size_t i = 0; i < layout.count; ++i) {
    const char* const at = rest.data() + i * record;
    Keep({Decode(layout.fields[0], at), Decode(layout.fields[1], at), Decode(layout.fields[2], at)},
         points);
  }
  return points;
}

std::vector<Vector3d> ReadText(const fs::path& file, const Layout& layout, int line,
                               std::string_view rest) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < layout.count; ++i) {
    if (rest.empty()) {
      models::internal::RefuseText(file, line, "ends too early", fmt::format("{} points", i),
                                   fmt::format("{}", layout.count));
    }
    const auto words = models::internal::Words(models::internal::TakeLine(rest));
    ++line;
    if (words.size() != layout.columns) {
      models::internal::RefuseText(file, line, "no point", fmt::format("{} values", words.size()),
                                   fmt::format("{}", layout.columns));
    }
    Vector3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto number = models::internal::ToNumber(words[*layout.column[axis]]);
      if (!number)
        models::internal::RefuseText(file, line, "no point", words[*layout.column[axis]],
                                     "numbers");
      point[static_cast<Eigen::Index>(axis)] = *number;
    }
    Keep(point, points);
  }
  return points;
}

std::vector<Vector3d> ReadPoints(const fs::path& file, const Layout& layout, int line,
                                 std::string_view rest) {
  for (const auto& column : layout.column) {
    if (!column)
      models::internal::RefuseText(file, 0, "has no coordinates", "other fields", "x, y and z");
  }
  return layout.text ? ReadText(file, layout, line, rest) : ReadBinary(file, layout, rest);
}

Field PlyField(const fs::path& file, int line, std::string_view type) {
  struct Type {
    std::string_view name, alias;
    Field field;
  };
  static constexpr std::array<Type, 8> kTypes{{{"char", "int8", {0, 1, 'I'}},
                                               {"uchar", "uint8", {0, 1, 'U'}},
                                               {"short", "int16", {0, 2, 'I'}},
                                               {"ushort", "uint16", {0, 2, 'U'}},
                                               {"int", "int32", {0, 4, 'I'}},
                                               {"uint", "uint32", {0, 4, 'U'}},
                                               {"float", "float32", {0, 4, 'F'}},
                                               {"double", "float64", {0, 8, 'F'}}}};
  for (const Type& known : kTypes) {
    if (type == known.name || type == known.alias) return known.field;
  }
  models::internal::RefuseText(file, line, "property of a vertex", type, "a scalar type of PLY");
}

std::uint64_t Count(const fs::path& file, int line, std::string_view word) {
  const auto number = models::internal::ToCount(word, 100'000'000);
  if (!number) models::internal::RefuseText(file, line, "number of points", word, "0 to 100000000");
  return *number;
}

std::vector<Vector3d> ReadPly(const fs::path& file, std::string_view rest) {
  Layout layout;
  bool of_vertex = false, found = false;
  int line = 1;
  if (models::internal::TakeLine(rest) != "ply")
    models::internal::RefuseText(file, 1, "is no PLY file", "another start", "ply");
  while (true) {
    if (rest.empty())
      models::internal::RefuseText(file, line, "ends in its header", "no end_header", "one");
    const auto words = models::internal::Words(models::internal::TakeLine(rest));
    ++line;
    if (words.empty()) continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() > 1) {
      layout.text = words[1] == "ascii";
      if (!layout.text && words[1] != "binary_little_endian") {
        models::internal::RefuseText(file, line, "format", words[1],
                                     "ascii or binary_little_endian");
      }
    } else if (words[0] == "element" && words.size() > 2) {
      of_vertex = words[1] == "vertex";
      if (!of_vertex && !found) {
        models::internal::RefuseText(file, line, "element before the vertices", words[1],
                                     "vertex first");
      }
      if (of_vertex) layout.count = Count(file, line, words[2]);
      found = found || of_vertex;
    } else if (words[0] == "property" && of_vertex && words.size() > 2) {
      layout.Add(file, line, words.back(), PlyField(file, line, words[1]), 1);
    } else if (words[0] != "comment" && words[0] != "obj_info" && words[0] != "property") {
      models::internal::RefuseText(file, line, "header", words[0], "a line of the PLY format");
    }
  }
  return ReadPoints(file, layout, line, rest);
}

/// What the lines of a PCD header say before they are put together.
struct PcdHeader {
  std::vector<std::string_view> names, sizes, types, counts;
  std::uint64_t points{0};
  bool text{false};
};

/// Takes the header off `rest`; `line` is then that of its last line.
PcdHeader ReadPcdHeader(const fs::path& file, std::string_view& rest, int& line) {
  PcdHeader header;
  while (true) {
    if (rest.empty())
      models::internal::RefuseText(file, line, "ends in its header", "no DATA", "one");
    const auto words = models::internal::Words(models::internal::TakeLine(rest));
    ++line;
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    if (words[0] == "FIELDS") {
      header.names = values;
    } else if (words[0] == "SIZE") {
      header.sizes = values;
    } else if (words[0] == "TYPE") {
      header.types = values;
    } else if (words[0] == "COUNT") {
      header.counts = values;
    } else if (words[0] == "POINTS" && !values.empty()) {
      header.points = Count(file, line, values[0]);
    } else if (words[0] == "DATA") {
      header.text = !values.empty() && values[0] == "ascii";
      if (header.text || (!values.empty() && values[0] == "binary")) return header;
      models::internal::RefuseText(file, line, "DATA", values.empty() ? "none" : values[0],
                                   "ascii or binary");
    } else if (words[0] != "VERSION" && words[0] != "WIDTH" && words[0] != "HEIGHT" &&
               words[0] != "VIEWPOINT") {
      models::internal::RefuseText(file, line, "header", words[0], "a line of the PCD format");
    }
  }
}

std::vector<Vector3d> ReadPcd(const fs::path& file, std::string_view rest) {
  int line = 0;
  const PcdHeader header = ReadPcdHeader(file, rest, line);
  const std::size_t count = header.names.size();
  if (header.sizes.size() != count || header.types.size() != count ||
      (!header.counts.empty() && header.counts.size() != count)) {
    models::internal::RefuseText(file, line, "header",
                                 "FIELDS, SIZE, TYPE and COUNT of unequal length", "equal ones");
  }
  Layout layout;
  layout.text = header.text;
  layout.count = header.points;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view type = header.types[i];
    const auto size = models::internal::ToCount(header.sizes[i], 8);
    const auto copies = header.counts.empty()
                            ? std::optional<std::uint64_t>(1)
                            : models::internal::ToCount(header.counts[i], Layout::kMostBytes);
    const bool known = size && (*size == 1 || *size == 2 || *size == 4 || *size == 8) &&
                       (type == "I" || type == "U" || (type == "F" && *size >= 4));
    if (!known || !copies || *copies == 0) {
      models::internal::RefuseText(
          file, line, fmt::format("field '{}'", header.names[i]), type,
          "TYPE F, I or U with a SIZE of 1, 2, 4 or 8 bytes and a COUNT above 0");
    }
    layout.Add(file, line, header.names[i], {0, *size, type[0]}, *copies);
  }
  return ReadPoints(file, layout, line, rest);
}

std::vector<Vector3d> ReadTable(const fs::path& file) {
  models::CsvTable table(file);
  std::vector<std::size_t> columns = table.Columns({"x", "y", "z"});
  if (columns.empty()) columns = {0, 1, 2};
  std::vector<Vector3d> points;
  while (table.NextRow()) {
    if (table.cells().size() < 3) {
      throw models::ModelError(fmt::format("{}: no point; got {} values; expected x, y and z",
                                           table.where(), table.cells().size()));
    }
    Keep({table.AnyNumber(columns[0]), table.AnyNumber(columns[1]), table.AnyNumber(columns[2])},
         points);
  }
  return points;
}

std::vector<Vector3d> ReadCloud(const fs::path& file) {
  const std::string kind = file.extension().string();
  std::vector<Vector3d> points;
  if (kind == ".csv" || kind == ".xyz") {
    points = ReadTable(file);
  } else if (kind == ".ply") {
    points = ReadPly(file, models::internal::ReadWhole(file));
  } else if (kind == ".pcd") {
    points = ReadPcd(file, models::internal::ReadWhole(file));
  } else {
    models::internal::RefuseText(file, 0, "extension", "'" + kind + "'",
                                 ".csv, .xyz, .ply or .pcd");
  }
  if (points.empty())
    models::internal::RefuseText(file, 0, "holds no point", "none", "at least one");
  return points;
}

}  // namespace

std::vector<Vector3d> LoadPointCloud(const fs::path& file) {
  return *models::ReadOnce<std::vector<Vector3d>>(file, "cloud", [&] { return ReadCloud(file); });
}

Compound MakeCloud(std::span<const Vector3d> points, double radius) {
  Compound cloud;
  cloud.parts.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud.parts[i].X_SP.translation() = points[i];
    cloud.parts[i].shape = Sphere{radius};
  }
  return cloud;
}

}  // namespace oca::geometry
