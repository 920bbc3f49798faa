// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// Problems and warnings of diagram files that others use. What two uses of a file have in common
/// is told once, with both of them.
class ToldOnce {
 public:
  /// `use` is the path of the use in the diagram, or empty for the file that is built.
  void Add(const std::string& use, const Diagnostic& diagnostic);
  /// All of them, in the order in which they came first: `in left and right: what`.
  std::vector<Diagnostic> all() const;

 private:
  std::vector<std::pair<Diagnostic, std::vector<std::string>>> told_;  // and their uses
};

}  // namespace oca::loading
