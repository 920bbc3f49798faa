// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/stl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "oca/models/geometry/binary_scalar.h"
#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr std::uint64_t kStlHead = 84, kStlTriangle = 50;  // bytes
constexpr std::string_view kStlSpaces = " \t\r\n\f\v";

void AppendCorners(const std::array<Vector3d, 3>& corners, TriangleMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// The words of a text STL.
class StlText {
 public:
  StlText(const fs::path& file, std::string_view text) : file_(file), rest_(text) {}

  TriangleMesh Read() {
    TriangleMesh mesh;
    do {
      Expect("solid");
      models::internal::TakeLine(rest_);  // its name
      ++line_;
      while (Take("facet or endsolid") == "facet") AppendCorners(Facet(), mesh);
      if (word_ != "endsolid") Refuse("facet or endsolid");
      models::internal::TakeLine(rest_);
      ++line_;
      SkipSpaces();
    } while (!rest_.empty());
    return mesh;
  }

 private:
  std::array<Vector3d, 3> Facet() {
    Expect("normal");
    for (int i = 0; i < 3; ++i) Take("the normal of a facet");
    Expect("outer");
    Expect("loop");
    std::array<Vector3d, 3> corners;
    for (Vector3d& corner : corners) {
      Expect("vertex");
      for (double& x : corner) x = Number();
    }
    Expect("endloop");
    Expect("endfacet");
    return corners;
  }

  [[noreturn]] void Refuse(std::string_view expected) const {
    models::internal::RefuseText(file_, line_, "text STL",
                                 word_.empty() ? "its end" : models::internal::Shown(word_),
                                 expected);
  }

  void SkipSpaces() {
    const std::size_t next = std::min(rest_.find_first_not_of(kStlSpaces), rest_.size());
    line_ += static_cast<int>(std::count(rest_.begin(), rest_.begin() + next, '\n'));
    rest_.remove_prefix(next);
  }

  /// In small letters; empty at the end of the text, which is refused.
  const std::string& Take(std::string_view expected) {
    SkipSpaces();
    const std::size_t end = std::min(rest_.find_first_of(kStlSpaces), rest_.size());
    word_ = models::internal::Lower(rest_.substr(0, end));
    rest_.remove_prefix(end);
    if (word_.empty()) Refuse(expected);
    return word_;
  }

  void Expect(std::string_view word) {
    if (Take(word) != word) Refuse(word);
  }

  double Number() {
    const auto number = models::internal::ToNumber(Take("a coordinate"));
    if (!number || !std::isfinite(*number)) Refuse("a coordinate, a finite number");
    return *number;
  }

  const fs::path& file_;
  std::string_view rest_;
  int line_{1};
  std::string word_;
};

std::uint64_t AnnouncedTriangles(std::string_view bytes) {
  return static_cast<std::uint64_t>(Decode({4, 'U'}, bytes.data() + kStlHead - 4, false));
}

/// Binary files may begin with `solid` too.
bool IsTextStl(std::string_view bytes, std::string_view text) {
  constexpr std::size_t kLooked = 1000;
  if (bytes.size() >= kStlHead &&
      bytes.size() == kStlHead + kStlTriangle * AnnouncedTriangles(bytes))
    return false;
  const bool solid = models::internal::Lower(text.substr(0, 5)) == "solid";
  return solid && text.substr(0, kLooked).find('\0') == text.npos;
}

TriangleMesh ReadBinaryStl(const fs::path& file, std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  if (size < kStlHead) {
    models::internal::RefuseText(file, 0, "is neither text nor binary STL",
                                 fmt::format("{} bytes that do not begin with solid", size),
                                 fmt::format("solid, or at least {} bytes", kStlHead));
  }
  const std::uint64_t count = AnnouncedTriangles(bytes),
                      announced = kStlHead + kStlTriangle * count;
  if (size < announced) {
    models::internal::RefuseText(file, 0, "binary STL ends too early",
                                 fmt::format("{} bytes", size),
                                 fmt::format("{} for its {} triangles", announced, count));
  }
  if (size >= announced + kStlTriangle) {
    models::internal::RefuseText(file, 0, "binary STL goes on behind its triangles",
                                 fmt::format("{} bytes", size),
                                 fmt::format("{} for its {} triangles", announced, count));
  }
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + kStlHead + kStlTriangle * i + 12;  // behind the normal
    std::array<Vector3d, 3> corners;
    for (Vector3d& corner : corners) {
      for (double& x : corner) {
        x = Decode({4, 'F'}, at, false);
        at += 4;
      }
    }
    AppendCorners(corners, mesh);
  }
  return mesh;
}

}  // namespace

TriangleMesh ReadStl(const fs::path& file, std::string_view bytes) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view text = bytes;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::string_view whole = text;
  text.remove_prefix(std::min(text.find_first_not_of(kStlSpaces), text.size()));
  return IsTextStl(bytes, text) ? StlText(file, whole).Read() : ReadBinaryStl(file, bytes);
}

}  // namespace oca::geometry::internal
