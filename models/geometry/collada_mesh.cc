// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/collada_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>

#include "oca/models/geometry/polygon.h"
#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kMostOffset = 100;
constexpr std::size_t kMostNumbers = 20'000'000;          // of an element
constexpr std::string_view kNodeName = "name of a node";  // no element has such a kind

/// The words of an element's text, which its closing tag ends.
class ColladaWords {
 public:
  ColladaWords(const ColladaTree& tree, int element)
      : tree_(tree), element_(element), rest_(tree[element].text), line_(tree[element].text_line) {}

  /// Empty at the end.
  std::string_view Take() {
    const std::size_t next = std::min(rest_.find_first_not_of(kXmlSpaces), rest_.size());
    line_ += static_cast<int>(std::count(rest_.begin(), rest_.begin() + next, '\n'));
    rest_.remove_prefix(next);
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kXmlSpaces));
    rest_.remove_prefix(word.size());
    return word;
  }

  [[noreturn]] void Refuse(std::string_view got, std::string_view expected) const {
    tree_.Refuse(element_, fmt::format("<{}>", tree_[element_].name), got, expected, line_);
  }

  /// What ends the text must be the end of the element.
  void CheckEnd() const {
    if (tree_[element_].closed) return;
    Refuse("another tag among its numbers", fmt::format("</{}>", tree_[element_].name));
  }

 private:
  const ColladaTree& tree_;
  const int element_;
  std::string_view rest_;
  int line_;
};

/// Whole numbers, those at place `offset` of `stride` below `most`, and these alone are returned.
std::vector<int> Indices(const ColladaTree& tree, int element, std::uint64_t offset,
                         std::uint64_t stride, std::uint64_t most) {
  ColladaWords words(tree, element);
  std::vector<int> indices;
  std::uint64_t place = 0;
  for (std::string_view word = words.Take(); !word.empty(); word = words.Take(), ++place) {
    if (place % stride != offset) continue;
    const auto index = models::internal::ToCount(word, most - 1);
    if (!index || most == 0) {
      words.Refuse(models::internal::Shown(word),
                   most == 0 ? std::string("none of the 0 vertices")
                             : fmt::format("whole numbers from 0 to {}", most - 1));
    }
    indices.push_back(static_cast<int>(*index));
  }
  words.CheckEnd();
  if (place % stride == 0) return indices;
  words.Refuse(fmt::format("{} numbers", place), fmt::format("{} for each corner", stride));
}

/// How the corners of a primitive become triangles.
void AddCorners(const ColladaTree& tree, int primitive, const std::vector<int>& corners,
                TriangleMesh& mesh) {
  const std::string_view kind = tree[primitive].name;
  if (mesh.triangles.size() + corners.size() > ColladaMeshes::kMost) {
    tree.Refuse(primitive, "triangles", "more", fmt::format("at most {}", ColladaMeshes::kMost));
  }
  if (kind == "polygons") return AddPolygon(corners, mesh);
  if (kind == "triangles" && corners.size() % 3 != 0) {
    tree.Refuse(primitive, "<triangles>", fmt::format("{} corners", corners.size()),
                "3 for each triangle");
  }
  const std::size_t step = kind == "triangles" ? 3 : 1;
  for (std::size_t k = 2; k < corners.size(); k += step) {
    const int first = kind == "trifans" ? corners[0] : corners[k - 2];
    const bool turned = kind == "tristrips" && k % 2 == 1;
    mesh.triangles.push_back({first, corners[turned ? k : k - 1], corners[turned ? k - 1 : k]});
  }
}

/// Of a <polylist>: <vcount> says how many corners each polygon has.
void AddPolylist(const ColladaTree& tree, int primitive, const std::vector<int>& corners,
                 TriangleMesh& mesh) {
  const int element = tree.Child(primitive, "vcount");
  std::vector<int> counts;
  if (element >= 0) counts = Indices(tree, element, 0, 1, ColladaMeshes::kMost);
  const std::size_t sum = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  if (sum != corners.size()) {
    tree.Refuse(primitive, "<polylist>", fmt::format("{} corners", corners.size()),
                fmt::format("{}, which its <vcount> adds up to", sum));
  }
  if (mesh.triangles.size() + sum > ColladaMeshes::kMost) {
    tree.Refuse(primitive, "triangles", "more", fmt::format("at most {}", ColladaMeshes::kMost));
  }
  auto begin = corners.begin();
  for (const int count : counts) {
    AddPolygon({begin, begin + count}, mesh);
    begin += count;
  }
}

}  // namespace

std::vector<double> ColladaNumbers(const ColladaTree& tree, int element, std::size_t count) {
  ColladaWords words(tree, element);
  std::vector<double> numbers;
  for (std::string_view word = words.Take(); !word.empty(); word = words.Take()) {
    const auto number = models::internal::ToNumber(word);
    if (!number) words.Refuse(models::internal::Shown(word), "numbers");
    if (numbers.size() == kMostNumbers) {
      words.Refuse("more numbers", fmt::format("at most {}", kMostNumbers));
    }
    numbers.push_back(*number);
  }
  words.CheckEnd();
  if (count == 0 || numbers.size() == count) return numbers;
  words.Refuse(fmt::format("{} numbers", numbers.size()), fmt::format("{}", count));
}

ColladaMeshes::ColladaMeshes(const ColladaTree& tree) : tree_(tree) {
  for (int i = 0; i < tree.size(); ++i) {
    const std::string_view id = tree.Attribute(i, "id");
    if (!id.empty()) ids_.emplace(tree[i].name, id, i);
    if (tree[i].name == "node") ids_.emplace(kNodeName, tree.Attribute(i, "name"), i);
  }
}

int ColladaMeshes::Find(std::string_view id, std::string_view kind, int near) const {
  const auto is_one = [&](const auto& found) {
    return found != ids_.end() && std::get<0>(*found) == kind && std::get<1>(*found) == id;
  };
  const auto inside = ids_.lower_bound({kind, id, near});
  if (is_one(inside) && std::get<2>(*inside) < tree_[near].end) return std::get<2>(*inside);
  const auto first = ids_.lower_bound({kind, id, 0});
  return is_one(first) ? std::get<2>(*first) : -1;
}

int ColladaMeshes::Resolve(int from, std::string_view attribute, std::string_view kind,
                           int near) const {
  const std::string_view reference = tree_.Attribute(from, attribute);
  if (reference.starts_with('#')) {
    int found = Find(reference.substr(1), kind, near);
    if (found < 0 && kind == "node") found = Find(reference.substr(1), kNodeName);
    if (found >= 0) return found;
  }
  tree_.Refuse(from, fmt::format("<{}> {}", tree_[from].name, attribute),
               reference.empty() ? "nothing" : models::internal::Shown(reference),
               fmt::format("# and the id of a <{}> of this file", kind));
}

const TriangleMesh& ColladaMeshes::Of(int geometry) {
  const auto [place, fresh] = meshes_.try_emplace(geometry);
  if (!fresh) return place->second;
  Growing result{place->second};
  for (const int mesh : tree_.Children(geometry, "mesh")) {
    for (const int primitive : tree_.Children(mesh)) {
      const std::string_view kind = tree_[primitive].name;
      if (kind == "triangles" || kind == "polylist" || kind == "polygons" || kind == "trifans" ||
          kind == "tristrips") {
        AddPrimitive(primitive, mesh, result);
      }
    }
  }
  return place->second;
}

void ColladaMeshes::AddPrimitive(int primitive, int mesh, Growing& result) {
  std::uint64_t stride = 1, offset = 0;
  int vertex = -1;
  for (const int input : tree_.Children(primitive, "input")) {
    const std::uint64_t at = tree_.Number(input, "offset", 0);
    if (at > kMostOffset) {
      tree_.Refuse(input, "offset", fmt::format("{}", at), fmt::format("at most {}", kMostOffset));
    }
    stride = std::max(stride, at + 1);
    const std::string_view semantic = tree_.Attribute(input, "semantic");
    if (vertex >= 0 || (semantic != "VERTEX" && semantic != "POSITION")) continue;
    vertex = input;
    offset = at;
  }
  const std::string_view kind = tree_[primitive].name;
  std::vector<int> all;
  for (const int child : tree_.Children(primitive)) {
    // A polygon with holes counts without them.
    const int list = tree_[child].name == "ph" ? tree_.Child(child, "p") : child;
    if (list < 0 || tree_[list].name != "p") continue;
    if (vertex < 0) tree_.Refuse(primitive, "has no vertices", "no input VERTEX", "one");
    const auto [first, count] = AddPoints(vertex, mesh, result);
    auto corners = Indices(tree_, list, offset, stride, count);
    for (int& corner : corners) corner += first;
    if (kind != "polylist") AddCorners(tree_, primitive, corners, result.mesh);
    all.insert(all.end(), corners.begin(), corners.end());
  }
  if (kind == "polylist") AddPolylist(tree_, primitive, all, result.mesh);
  const std::uint64_t announced = tree_.Number(primitive, "count", 0);
  if (kind != "triangles" || announced == 0 || announced * 3 == all.size()) return;
  tree_.Refuse(primitive, "<triangles>", fmt::format("{} corners", all.size()),
               fmt::format("3 for each of its {}", announced));
}

/// The points that an accessor takes from its array.
ColladaMeshes::Points ColladaMeshes::AddPoints(int input, int mesh, Growing& result) {
  if (tree_.Attribute(input, "semantic") == "VERTEX") {
    const int vertices = Resolve(input, "source", "vertices", mesh);
    input = -1;
    for (const int candidate : tree_.Children(vertices, "input")) {
      if (tree_.Attribute(candidate, "semantic") == "POSITION") input = candidate;
    }
    if (input < 0) tree_.Refuse(vertices, "has no positions", "no input POSITION", "one");
  }
  const int source = Resolve(input, "source", "source", mesh);
  const auto [place, fresh] = result.sources.try_emplace(source);
  if (!fresh) return place->second;
  const int technique = tree_.Child(source, "technique_common");
  const int accessor = technique < 0 ? -1 : tree_.Child(technique, "accessor");
  if (accessor < 0) tree_.Refuse(source, "has no points", "no <accessor>", "one");
  const int array = Resolve(accessor, "source", "float_array", source);
  const std::uint64_t count = tree_.Number(accessor, "count", 0),
                      stride = tree_.Number(accessor, "stride", 1),
                      offset = tree_.Number(accessor, "offset", 0);
  const std::uint64_t needed = offset + count * stride;  // 32 bits each: no sum passes 64
  const auto check = [&](std::uint64_t there) {
    if (needed <= there) return;
    const std::string_view id = tree_.Attribute(array, "id");
    tree_.Refuse(accessor, fmt::format("accessor of '{}'", models::internal::Shown(id)),
                 fmt::format("an array of {} numbers", there), fmt::format("{}", needed));
  };
  check(tree_.Number(array, "count", 0));
  if (stride < 3) {
    tree_.Refuse(accessor, "stride", fmt::format("{}", stride), "at least 3, for x, y and z");
  }
  std::vector<Vector3d>& points = result.mesh.vertices;
  if (points.size() + count > kMost) {
    tree_.Refuse(accessor, "vertices", "more", fmt::format("at most {}", kMost));
  }
  const std::vector<double>& numbers = ArrayOf(array);
  check(numbers.size());
  place->second = {static_cast<int>(points.size()), static_cast<int>(count)};
  for (std::uint64_t i = 0; i < count; ++i) {
    const double* at = numbers.data() + offset + i * stride;
    points.emplace_back(at[0], at[1], at[2]);
  }
  return place->second;
}

const std::vector<double>& ColladaMeshes::ArrayOf(int array) {
  const auto [place, fresh] = arrays_.try_emplace(array);
  if (fresh) place->second = ColladaNumbers(tree_, array, 0);
  return place->second;
}

}  // namespace oca::geometry::internal
