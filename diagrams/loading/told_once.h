// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace oca::loading {

/// Problems and warnings of diagram files that others use. What two uses of a file have in common
/// is told once, with both of them.
class ToldOnce {
 public:
  /// `line` is `PLACE: error: WHAT`, or a warning; `use` the path of the use in the diagram, or
  /// empty for the file that is built.
  void Add(const std::string& use, const std::string& line);
  /// All of them, in the order in which they came first: `PLACE: error: in left and right: WHAT`.
  std::vector<std::string> Lines() const;
  void Clear() { told_.clear(); }

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> told_;  // lines and their uses
};

}  // namespace oca::loading
