// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca::loading {

/// Which systems of a file are built: those that are named, or all.
class Part {
 public:
  /// `systems` empty: all.
  explicit Part(std::vector<std::string> systems) : systems_(std::move(systems)) {}

  bool whole() const { return systems_.empty(); }
  /// By its path; `left` has all that is in it.
  bool Has(const std::string& system) const;
  /// Adds a problem at `location` for each name that is none of `known`.
  void CheckNames(const std::vector<std::string>& known, const Location& location,
                  Problems& problems) const;

 private:
  std::vector<std::string> systems_;
};

}  // namespace oca::loading
