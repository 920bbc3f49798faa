// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oca/models/geometry/ply_header.h"
#include "oca/models/geometry/polygon.h"
#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// The numbers behind the header, element after element, each on a line of its own if it is text.
class Body {
 public:
  Body(const fs::path& file, const PlyHeader& header, std::string_view rest)
      : file_(file), header_(header), line_(header.lines), rest_(rest), size_(rest.size()) {}

  /// Goes on to number `index` of an element.
  void Begin(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
    if (!header_.text) return;
    if (rest_.empty()) RefuseEnd();
    words_ = models::internal::Words(models::internal::TakeTableLine(file_, ++line_, rest_));
    next_ = 0;
  }

  double Take(const Scalar& scalar) {
    if (!header_.text) {
      if (rest_.size() < scalar.size) RefuseEnd();
      const double value = Decode(scalar, rest_.data(), header_.big_endian);
      rest_.remove_prefix(scalar.size);
      return value;
    }
    if (next_ == words_.size()) RefuseLength("more");
    const std::string_view word = words_[next_++];
    const auto number = models::internal::ToNumber(word);
    if (!number) Refuse("no number", models::internal::Shown(word), "numbers");
    return *number;
  }

  /// How many elements may follow, that take `least` bytes each at least.
  std::uint64_t Room(std::uint64_t least) const { return rest_.size() / least; }

  /// How long a list is.
  std::uint64_t TakeCount(const Scalar& scalar) {
    const double count = Take(scalar);
    if (!(count >= 0.0 && count <= PlyHeader::kMostElements && count == std::floor(count))) {
      Refuse("length of a list", fmt::format("{}", count), "a whole number");
    }
    return static_cast<std::uint64_t>(count);
  }

  void End() const {
    if (header_.text && next_ != words_.size()) RefuseLength(fmt::format("{}", next_));
  }

  [[noreturn]] void Refuse(std::string_view what, std::string_view got,
                           std::string_view expected) const {
    const std::string element = fmt::format("{} {}: {}", Name(), index_, what);
    if (header_.text) models::internal::RefuseText(file_, line_, element, got, expected);
    models::internal::RefuseText(
        file_, 0, fmt::format("byte {} behind the header: {}", size_ - rest_.size(), element), got,
        expected);
  }

 private:
  std::string Name() const { return models::internal::Shown(element_->name); }

  [[noreturn]] void RefuseEnd() const {
    models::internal::RefuseText(file_, header_.text ? line_ : 0, "ends too early",
                                 fmt::format("{} of element {}", index_, Name()),
                                 fmt::format("{}", element_->count));
  }

  [[noreturn]] void RefuseLength(std::string_view expected) const {
    Refuse("wrong length", fmt::format("{} values", words_.size()), expected);
  }

  const fs::path& file_;
  const PlyHeader& header_;
  int line_;
  std::string_view rest_;
  const std::size_t size_;
  std::vector<std::string_view> words_;
  std::size_t next_{0};
  const PlyElement* element_{nullptr};
  std::uint64_t index_{0};
};

/// The place of the property of a name, a list or not; none is past the end.
std::size_t Find(const PlyElement& element, std::string_view name, bool list) {
  std::size_t i = 0;
  while (i < element.properties.size() &&
         (element.properties[i].name != name || element.properties[i].count.has_value() != list)) {
    ++i;
  }
  return i;
}

/// Reads or skips a property: numbers of a list, or the one that there is.
template <class Use>
void ForEach(const PlyProperty& property, Body& body, const Use& use) {
  const std::uint64_t count = property.count ? body.TakeCount(*property.count) : 1;
  for (std::uint64_t i = 0; i < count; ++i) use(body.Take(property.scalar));
}

void ReadVertices(const fs::path& file, const PlyElement& element, Body& body, TriangleMesh& mesh) {
  const std::size_t none = element.properties.size();
  const std::array<std::size_t, 3> at{Find(element, "x", false), Find(element, "y", false),
                                      Find(element, "z", false)};
  if (std::find(at.begin(), at.end(), none) != at.end()) {
    models::internal::RefuseText(file, 0, "has no coordinates", "other properties of a vertex",
                                 "x, y and z");
  }
  mesh.vertices.reserve(std::min(element.count, body.Room(3)));
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Vector3d point;
    body.Begin(element, i);
    for (std::size_t k = 0; k < none; ++k) {
      const auto axis = std::find(at.begin(), at.end(), k) - at.begin();
      ForEach(element.properties[k], body, [&](double value) {
        if (axis < 3) point[axis] = value;
      });
    }
    body.End();
    mesh.vertices.push_back(point);
  }
}

void ReadFaces(const fs::path& file, const PlyElement& element, std::uint64_t vertices, Body& body,
               TriangleMesh& mesh) {
  const std::size_t none = element.properties.size();
  const std::size_t at =
      std::min(Find(element, "vertex_indices", true), Find(element, "vertex_index", true));
  if (at == none) {
    models::internal::RefuseText(file, 0, "has no corners of faces", "other properties of a face",
                                 "a list vertex_indices");
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    std::vector<int> corners;
    body.Begin(element, i);
    for (std::size_t k = 0; k < none; ++k) {
      ForEach(element.properties[k], body, [&](double value) {
        if (k != at) return;
        if (!(value >= 0.0 && value < static_cast<double>(vertices) &&
              value == std::floor(value))) {
          body.Refuse("vertex", fmt::format("{}", value),
                      fmt::format("one of the {}, from 0 on", vertices));
        }
        corners.push_back(static_cast<int>(value));
      });
    }
    body.End();
    if (mesh.triangles.size() + corners.size() > kMostTriangles) {
      body.Refuse("triangles", "more", fmt::format("at most {}", kMostTriangles));
    }
    for (std::size_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
  }
}

void Skip(const PlyElement& element, Body& body) {
  if (element.properties.empty()) return;  // takes no bytes, however many there are
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.Begin(element, i);
    for (const PlyProperty& property : element.properties) ForEach(property, body, [](double) {});
    body.End();
  }
}

}  // namespace

TriangleMesh ReadPly(const fs::path& file, std::string_view text, PlyPart part) {
  const PlyHeader header = ReadPlyHeader(file, text);
  const auto count = [&](std::string_view name) {
    std::optional<std::uint64_t> found;
    for (const PlyElement& element : header.elements) {
      if (element.name != name) continue;
      if (found) models::internal::RefuseText(file, 0, "elements", name, "each name once");
      found = element.count;
    }
    return found;
  };
  const auto vertices = count("vertex"), faces = count("face");
  if (!vertices) {
    models::internal::RefuseText(file, 0, "has no coordinates", "no element vertex", "one");
  }
  if (!faces && part == PlyPart::kMesh) {
    models::internal::RefuseText(file, 0, "is no mesh", "no element face", "one");
  }
  TriangleMesh mesh;
  Body body(file, header, text);
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      ReadVertices(file, element, body, mesh);
    } else if (element.name == "face" && part == PlyPart::kMesh) {
      ReadFaces(file, element, *vertices, body, mesh);
    } else {
      Skip(element, body);
    }
  }
  return mesh;
}

}  // namespace oca::geometry::internal
