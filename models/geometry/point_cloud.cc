// SPDX-License-Identifier: BSD-3-Clause
#include "models/geometry/point_cloud.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "models/geometry/table_text.h"

namespace oca::models {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using internal::RefuseText;
using internal::TakeLine;
using internal::ToNumber;
using internal::Words;

/// A scalar of a binary record.
struct Field {
  int offset{-1};
  int size{0};
  char kind{'F'};  // F float, I integer, U unsigned
};

/// What the header of a PLY or PCD file says.
struct Layout {
  bool text{true};
  std::size_t count{0};
  int record{0};                // bytes of a point
  int columns{0};               // of a point, in text
  std::array<Field, 3> fields;  // x, y, z
  std::array<int, 3> column{-1, -1, -1};

  void Add(std::string_view name, const Field& field, int copies) {
    for (int axis = 0; axis < 3; ++axis) {
      if (name != std::string_view("xyz").substr(static_cast<std::size_t>(axis), 1)) continue;
      fields[static_cast<std::size_t>(axis)] = {record, field.size, field.kind};
      column[static_cast<std::size_t>(axis)] = columns;
    }
    record += field.size * copies;
    columns += copies;
  }
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
  const auto record = static_cast<std::size_t>(layout.record);
  if (rest.size() / record < layout.count) {
    RefuseText(file, 0, "ends too early", fmt::format("{} points", rest.size() / record),
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
      RefuseText(file, line, "ends too early", fmt::format("{} points", i),
                 fmt::format("{}", layout.count));
    }
    const auto words = Words(TakeLine(rest));
    ++line;
    Vector3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto column = static_cast<std::size_t>(layout.column[axis]);
      const auto number = column < words.size() ? ToNumber(words[column]) : std::nullopt;
      if (!number) {
        RefuseText(file, line, "no point", column < words.size() ? words[column] : "too few values",
                   "numbers");
      }
      point[static_cast<Eigen::Index>(axis)] = *number;
    }
    Keep(point, points);
  }
  return points;
}

std::vector<Vector3d> ReadPoints(const fs::path& file, const Layout& layout, int line,
                                 std::string_view rest) {
  for (const int column : layout.column) {
    if (column < 0) RefuseText(file, 0, "has no coordinates", "other fields", "x, y and z");
  }
  return layout.text ? ReadText(file, layout, line, rest) : ReadBinary(file, layout, rest);
}

Field PlyField(const fs::path& file, int line, std::string_view type) {
  struct Type {
    std::string_view name, alias;
    Field field;
  };
  static constexpr std::array<Type, 8> kTypes{{{"char", "int8", {-1, 1, 'I'}},
                                               {"uchar", "uint8", {-1, 1, 'U'}},
                                               {"short", "int16", {-1, 2, 'I'}},
                                               {"ushort", "uint16", {-1, 2, 'U'}},
                                               {"int", "int32", {-1, 4, 'I'}},
                                               {"uint", "uint32", {-1, 4, 'U'}},
                                               {"float", "float32", {-1, 4, 'F'}},
                                               {"double", "float64", {-1, 8, 'F'}}}};
  for (const Type& known : kTypes) {
    if (type == known.name || type == known.alias) return known.field;
  }
  RefuseText(file, line, "property of a vertex", type, "a scalar type of PLY");
}

std::size_t Count(const fs::path& file, int line, std::string_view word) {
  const auto number = ToNumber(word);
  if (!number || !(*number >= 0.0 && *number <= 1e8)) {
    RefuseText(file, line, "number of points", word, "0 to 100000000");
  }
  return static_cast<std::size_t>(*number);
}

std::vector<Vector3d> ReadPly(const fs::path& file, std::string_view rest) {
  Layout layout;
  bool of_vertex = false, found = false;
  int line = 1;
  if (TakeLine(rest) != "ply") RefuseText(file, 1, "is no PLY file", "another start", "ply");
  while (true) {
    if (rest.empty()) RefuseText(file, line, "ends in its header", "no end_header", "one");
    const auto words = Words(TakeLine(rest));
    ++line;
    if (words.empty()) continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() > 1) {
      layout.text = words[1] == "ascii";
      if (!layout.text && words[1] != "binary_little_endian") {
        RefuseText(file, line, "format", words[1], "ascii or binary_little_endian");
      }
    } else if (words[0] == "element" && words.size() > 2) {
      of_vertex = words[1] == "vertex";
      if (!of_vertex && !found) {
        RefuseText(file, line, "element before the vertices", words[1], "vertex first");
      }
      if (of_vertex) layout.count = Count(file, line, words[2]);
      found = found || of_vertex;
    } else if (words[0] == "property" && of_vertex && words.size() > 2) {
      layout.Add(words.back(), PlyField(file, line, words[1]), 1);
    }
  }
  return ReadPoints(file, layout, line, rest);
}

std::vector<Vector3d> ReadPcd(const fs::path& file, std::string_view rest) {
  std::vector<std::string_view> names, sizes, types, counts;
  Layout layout;
  int line = 0;
  while (true) {
    if (rest.empty()) RefuseText(file, line, "ends in its header", "no DATA", "one");
    const auto words = Words(TakeLine(rest));
    ++line;
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    if (words[0] == "FIELDS") names = values;
    if (words[0] == "SIZE") sizes = values;
    if (words[0] == "TYPE") types = values;
    if (words[0] == "COUNT") counts = values;
    if (words[0] == "POINTS" && !values.empty()) layout.count = Count(file, line, values[0]);
    if (words[0] != "DATA") continue;
    layout.text = !values.empty() && values[0] == "ascii";
    if (layout.text || (!values.empty() && values[0] == "binary")) break;
    RefuseText(file, line, "DATA", values.empty() ? "none" : values[0], "ascii or binary");
  }
  if (sizes.size() != names.size() || types.size() != names.size()) {
    RefuseText(file, line, "header", "FIELDS, SIZE and TYPE of unequal length", "equal ones");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto size = ToNumber(sizes[i]);
    const auto copies = i < counts.size() ? ToNumber(counts[i]) : 1.0;
    const bool known = size && (*size == 1 || *size == 2 || *size == 4 || *size == 8) &&
                       types[i].size() == 1 && std::string_view("FIU").find(types[i]) < 3 &&
                       !(types[i] == "F" && *size < 4);
    if (!known || !copies || !(*copies >= 1.0 && *copies <= 1e4)) {
      RefuseText(file, line, fmt::format("field '{}'", names[i]), types[i],
                 "TYPE F, I or U with a SIZE of 1, 2, 4 or 8 bytes");
    }
    layout.Add(names[i], {-1, static_cast<int>(*size), types[i][0]}, static_cast<int>(*copies));
  }
  return ReadPoints(file, layout, line, rest);
}

std::vector<Vector3d> ReadTable(const fs::path& file, std::string_view rest) {
  std::vector<Vector3d> points;
  bool first = true;
  for (int line = 1; !rest.empty(); ++line) {
    const auto words = Words(TakeLine(rest));
    if (words.empty() || words[0].starts_with('#')) continue;
    Vector3d point;
    bool numbers = words.size() >= 3;
    for (std::size_t axis = 0; numbers && axis < 3; ++axis) {
      const auto number = ToNumber(words[axis]);
      numbers = number.has_value();
      point[static_cast<Eigen::Index>(axis)] = number.value_or(0.0);
    }
    if (numbers) {
      Keep(point, points);
    } else if (!first) {
      RefuseText(file, line, "no point", words[0], "three numbers");
    }
    first = false;
  }
  return points;
}

}  // namespace

std::vector<Vector3d> LoadPointCloud(const fs::path& file) {
  const std::string text = internal::ReadWhole(file);
  const std::string kind = file.extension().string();
  std::vector<Vector3d> points;
  if (kind == ".csv" || kind == ".xyz") {
    points = ReadTable(file, text);
  } else if (kind == ".ply") {
    points = ReadPly(file, text);
  } else if (kind == ".pcd") {
    points = ReadPcd(file, text);
  } else {
    RefuseText(file, 0, "extension", "'" + kind + "'", ".csv, .xyz, .ply or .pcd");
  }
  if (points.empty()) RefuseText(file, 0, "holds no point", "none", "at least one");
  return points;
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

}  // namespace oca::models
