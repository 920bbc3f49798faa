// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// `-s PATH=VALUE`: PATH is dot-separated keys, items of lists by index from 0; VALUE is YAML.
/// Behind the name of a system of type Diagram it is a path in the file that this one uses,
/// `left.parameters.rate`; `*` stands for all such names.
struct Override {
  std::string path{};
  std::string value{};
  std::string given_as{};  ///< the path in messages, if it is another
  std::string made_for{};  ///< what a program made it for, which messages begin with, instead of -s
  /// throws ConfigError if `text` is not PATH=VALUE.
  static Override Parse(const std::string& text);
  /// `-s PATH` as it was given, or `MADE FOR: PATH`, which messages have for the place.
  std::string Source() const;
  /// VALUE; what is wrong with it is added to `problems`.
  Value Read(Problems& problems) const;
};

/// The systems of a diagram file that are files themselves, of type Diagram.
std::vector<std::string> UsedFilesOf(const Value& root);

/// Takes out of `overrides` those for files that the tree uses, and returns them by the names of
/// the systems, with their paths in those files.
std::map<std::string, std::vector<Override>> TakeInner(std::vector<Override>& overrides,
                                                       const Value& root);

/// Sets what the overrides name in the tree of a diagram file, one after the other; what they get
/// wrong is added to `problems`.
void ApplyOverrides(const std::vector<Override>& overrides, Value& root, Problems& problems);

}  // namespace oca::files
