// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <vector>

#include "oca/models/geometry/collada_tree.h"
#include "oca/models/geometry/mesh.h"

namespace oca::geometry::internal {

/// The numbers of an element's text. throws ModelError: no numbers, an element between them, not as
/// many as `count` if it is not 0, more than 20 million
std::vector<double> ColladaNumbers(const ColladaTree& tree, int element, std::size_t count);

/// The triangles of the geometries of a Collada file: of <triangles>, <polylist>, <polygons>
/// without their holes, <trifans> and <tristrips>.
class ColladaMeshes {
 public:
  static constexpr std::size_t kMost = 4'000'000;  ///< triangles, and vertices, of a file

  explicit ColladaMeshes(const ColladaTree& tree);

  /// The element of a kind that a reference `#id` names; of two of one id that within `near`, if
  /// there is one, else the first. A node may be named by its name, as some programs do.
  /// throws ModelError at `from`, which has the reference
  int Resolve(int from, std::string_view attribute, std::string_view kind, int near = 0) const;
  /// The same; -1 if there is none.
  int Find(std::string_view id, std::string_view kind, int near = 0) const;
  /// Of a <geometry>, read once, in its own frame. Vertices that no triangle uses may be there.
  /// throws ModelError `file:line: ...`
  const TriangleMesh& Of(int geometry);

 private:
  struct Points {
    int first, count;
  };
  /// A geometry while it is read.
  struct Growing {
    TriangleMesh& mesh;
    std::map<int, Points> sources{};  ///< those that are among its vertices
  };
  Points AddPoints(int input, int mesh, Growing& result);
  const std::vector<double>& ArrayOf(int array);
  void AddPrimitive(int primitive, int mesh, Growing& result);

  const ColladaTree& tree_;
  std::set<std::tuple<std::string_view, std::string_view, int>> ids_;  ///< kind, id, element
  std::map<int, std::vector<double>> arrays_;
  std::map<int, TriangleMesh> meshes_;
};

}  // namespace oca::geometry::internal
