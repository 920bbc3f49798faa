// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include "oca/models/geometry/polygon.h"
#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// Lines of an OBJ file, two passes: a face may come before its vertices.
class ObjText {
 public:
  ObjText(const fs::path& file, std::string_view text) : file_(file), text_(text) {}

  TriangleMesh Read() {
    if (text_.find('\0') != text_.npos) Refuse("is no OBJ file", "a zero byte", "text");
    ForEachLine([&](std::string_view line) {
      if (KeyOf(line) == "v") AddVertex(line);
    });
    std::int64_t before = 0;  // vertices, of the line
    ForEachLine([&](std::string_view line) {
      const std::string_view key = KeyOf(line);
      if (key == "v") ++before;
      if (key == "f") AddFace(line, before);
    });
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void Refuse(std::string_view what, std::string_view got,
                           std::string_view expected) const {
    models::internal::RefuseText(file_, line_, what, got, expected);
  }

  static std::string_view KeyOf(std::string_view line) {
    line = models::internal::Trimmed(line);
    return line.substr(0, line.find_first_of(" \t\r"));
  }

  /// Without comments; lines that a backslash ends and what they go on with are one.
  template <class Use>
  void ForEachLine(const Use& use) {
    std::string_view rest = text_;
    int next = 1;
    while (!rest.empty()) {
      line_ = next;
      std::string_view line = models::internal::TakeLine(rest);
      ++next;
      std::string joined;
      while (line.ends_with('\\')) {
        joined += line.substr(0, line.size() - 1);
        joined += ' ';
        if (rest.empty()) {
          line = {};
          break;
        }
        line = models::internal::TakeLine(rest);
        ++next;
      }
      if (!joined.empty()) line = joined += line;
      use(line.substr(0, line.find('#')));
    }
    line_ = 0;
  }

  void AddVertex(std::string_view line) {
    const auto words = models::internal::Words(models::internal::TakeTableLine(file_, line_, line));
    if (words.size() < 4) {
      Refuse("vertex", fmt::format("{} numbers", words.size() - 1), "3, x, y and z");
    }
    Vector3d point;
    for (int i = 0; i < 3; ++i) point[i] = Number(words[i + 1]);
    if (words.size() == 5) {
      const double weight = Number(words[4]);
      if (weight == 0.0) Refuse("weight of a vertex", "0", "another number");
      point /= weight;
    }
    if (mesh_.vertices.size() == 3 * kMostTriangles) {
      Refuse("vertices", "more", fmt::format("at most {}", 3 * kMostTriangles));
    }
    mesh_.vertices.push_back(point);
  }

  double Number(std::string_view word) const {
    const auto number = models::internal::ToNumber(word);
    if (!number || !std::isfinite(*number)) {
      Refuse("vertex", models::internal::Shown(word), "a finite number");
    }
    return *number;
  }

  void AddFace(std::string_view line, std::int64_t before) {
    corners_.clear();
    const auto words = models::internal::Words(models::internal::TakeTableLine(file_, line_, line));
    if (mesh_.triangles.size() + words.size() > kMostTriangles) {
      Refuse("triangles", "more", fmt::format("at most {}", kMostTriangles));
    }
    for (std::size_t i = 1; i < words.size(); ++i) corners_.push_back(Corner(words[i], before));
    AddPolygon(corners_, mesh_);
  }

  /// `5`, `5/2`, `5//3` or `5/2/3`, or counted back from the line: `-1` is the last one before it.
  int Corner(std::string_view word, std::int64_t before) const {
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    const std::string_view head = word.substr(0, word.find('/'));
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(head.data(), head.data() + head.size(), index);
    if (error == std::errc() && end == head.data() + head.size()) {
      if (index > 0 && index <= count) return static_cast<int>(index - 1);
      if (index < 0 && index >= -before) return static_cast<int>(before + index);
    }
    std::string expected = fmt::format("one of the {} vertices, from 1 on", count);
    if (before > 0) expected += fmt::format(", or from -1 back to -{}", before);
    Refuse("corner of a face", models::internal::Shown(word), expected);
  }

  const fs::path& file_;
  const std::string_view text_;
  int line_{0};
  TriangleMesh mesh_;
  std::vector<int> corners_;
};

}  // namespace

TriangleMesh ReadObj(const fs::path& file, std::string_view text) {
  return ObjText(file, text).Read();
}

}  // namespace oca::geometry::internal
