// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// `-s PATH=VALUE`: PATH is dot-separated keys, items of lists by index from 0; VALUE is YAML.
struct Override {
  std::string path{};
  std::string value{};
  /// throws ConfigError if `text` is not PATH=VALUE.
  static Override Parse(const std::string& text);
  /// VALUE; what is wrong with it is added to `problems`.
  Value Read(Problems& problems) const;
};

/// Sets what the overrides name in the tree of a diagram file, one after the other; what they get
/// wrong is added to `problems`.
void ApplyOverrides(const std::vector<Override>& overrides, Value& root, Problems& problems);

}  // namespace oca::files
