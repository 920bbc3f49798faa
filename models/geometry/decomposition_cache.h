// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "oca/models/geometry/convex_hull.h"

namespace oca::geometry::internal {

/// What stands in an entry after its check sum: the number of parts, and of each the number of its
/// points and these, in the byte order of the machine. Empty if it is none.
std::vector<std::shared_ptr<const ConvexHull>> PartsOf(std::string_view body,
                                                       const std::string& name);

/// One decomposition on disk. Written under another name and then renamed, so that whoever reads
/// at the same time sees all of it or nothing.
class DecompositionEntry {
 public:
  /// throws ModelError if `mesh` cannot be read
  DecompositionEntry(const std::filesystem::path& cache, const std::filesystem::path& mesh,
                     const Eigen::Vector3d& scale, double concavity);

  /// The parts; none if they are not there or damaged.
  std::vector<std::shared_ptr<const ConvexHull>> Read(const std::string& name) const;
  void Write(const std::vector<std::shared_ptr<const ConvexHull>>& parts) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;  // empty: nothing is kept
};

}  // namespace oca::geometry::internal
