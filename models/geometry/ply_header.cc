// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostProperties = 1000;  // of an element

Scalar ScalarOf(const fs::path& file, int line, std::string_view type) {
  struct Type {
    std::string_view name, alias;
    Scalar scalar;
  };
  static constexpr std::array<Type, 8> kTypes{{{"char", "int8", {1, 'I'}},
                                               {"uchar", "uint8", {1, 'U'}},
                                               {"short", "int16", {2, 'I'}},
                                               {"ushort", "uint16", {2, 'U'}},
                                               {"int", "int32", {4, 'I'}},
                                               {"uint", "uint32", {4, 'U'}},
                                               {"float", "float32", {4, 'F'}},
                                               {"double", "float64", {8, 'F'}}}};
  for (const Type& known : kTypes) {
    if (type == known.name || type == known.alias) return known.scalar;
  }
  models::internal::RefuseText(file, line, "type of a property", models::internal::Shown(type),
                               "a scalar type of PLY");
}

using Line = std::vector<std::string_view>;

void TakeFormat(const fs::path& file, int line, const Line& words, PlyHeader& header) {
  const std::string_view format = words.size() > 1 ? words[1] : "none";
  header.text = format == "ascii";
  header.big_endian = format == "binary_big_endian";
  if (header.text || header.big_endian || format == "binary_little_endian") return;
  models::internal::RefuseText(file, line, "format", models::internal::Shown(format),
                               "ascii, binary_little_endian or binary_big_endian");
}

void TakeElement(const fs::path& file, int line, const Line& words, PlyHeader& header) {
  const std::string_view word = words.size() > 2 ? words[2] : "none";
  const auto count = models::internal::ToCount(word, PlyHeader::kMostElements);
  if (!count) {
    models::internal::RefuseText(file, line, "number of elements", models::internal::Shown(word),
                                 fmt::format("0 to {}", PlyHeader::kMostElements));
  }
  header.elements.push_back({words[1], *count, {}});
}

void TakeProperty(const fs::path& file, int line, const Line& words, PlyHeader& header) {
  const bool list = words.size() == 5 && words[1] == "list";
  if (header.elements.empty() || (!list && words.size() != 3)) {
    models::internal::RefuseText(file, line, "property", fmt::format("{} words", words.size()),
                                 "of an element, a type and a name, or list, two types and a name");
  }
  PlyProperty property{words.back(), ScalarOf(file, line, words[words.size() - 2]), std::nullopt};
  if (list) property.count = ScalarOf(file, line, words[2]);
  if (list && property.count->kind == 'F') {
    models::internal::RefuseText(file, line, "type of a list's count", words[2], "an integer");
  }
  auto& properties = header.elements.back().properties;
  const auto same = [&](const PlyProperty& other) { return other.name == property.name; };
  if (std::any_of(properties.begin(), properties.end(), same)) {
    models::internal::RefuseText(file, line, "properties", models::internal::Shown(property.name),
                                 "each name once");
  }
  if (properties.size() == kMostProperties) {
    models::internal::RefuseText(file, line, "properties of an element", "more",
                                 fmt::format("at most {}", kMostProperties));
  }
  properties.push_back(property);
}

}  // namespace

PlyHeader ReadPlyHeader(const fs::path& file, std::string_view& rest) {
  PlyHeader header;
  int& line = header.lines;
  line = 1;
  if (models::internal::TakeLine(rest) != "ply") {
    models::internal::RefuseText(file, 1, "is no PLY file", "another start", "ply");
  }
  while (!rest.empty()) {
    const Line words = models::internal::Words(models::internal::TakeTableLine(file, ++line, rest));
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") return header;
    if (words[0] == "format") {
      TakeFormat(file, line, words, header);
    } else if (words[0] == "element" && words.size() > 1) {
      TakeElement(file, line, words, header);
    } else if (words[0] == "property") {
      TakeProperty(file, line, words, header);
    } else {
      models::internal::RefuseText(file, line, "header", models::internal::Shown(words[0]),
                                   "a line of the PLY format");
    }
  }
  models::internal::RefuseText(file, line, "ends in its header", "no end_header", "one");
}

}  // namespace oca::geometry::internal
