// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace oca::robot {

/// The values of a xacro file's `<xacro:arg>`, by name.
using XacroArguments = std::map<std::string, std::string>;

struct XacroOptions {
  XacroArguments arguments{};
  /// $(find NAME) is find_package(NAME) if that is set and not empty, else DIR/NAME of the first
  /// DIR that has it.
  std::function<std::filesystem::path(const std::string& package)> find_package{};
  std::vector<std::filesystem::path> package_directories{};
  std::string package_advice{};  ///< ends messages about packages that are nowhere
  /// Takes what xacro.warning and its like say, with their place; or unset.
  std::function<void(const std::string& line)> warn{};
};

/// What a xacro file stands for.
struct ExpandedXacro {
  std::string urdf;
  /// Where each line of `urdf` comes from: `arm.xacro:12 (called at main.xacro:40)`.
  std::vector<std::string> places;

  /// A message that names lines of `urdf` as `file:LINE`, with their places instead.
  std::string WithPlaces(const std::string& message, const std::string& file) const;
};

/// Whether a file is one, by the ending .xacro of its name.
bool IsXacro(const std::filesystem::path& file);

/// Expands a xacro file: macros, properties, conditions, includes, arguments and the expressions
/// that docs/reference/xacro.md lists. The environment and the working folder have no say in it.
/// Numbers, texts and scopes are those of xacro 2; what it leaves to Python beyond that page is
/// refused.
///
/// throws ModelError naming file, line and calls, for whatever xacro refuses; for unknown
/// arguments; and for files that take more than 500 levels, 200 000 elements or 400 MB of values
/// source https://wiki.ros.org/xacro
ExpandedXacro ExpandXacro(const std::filesystem::path& file, const XacroOptions& options = {});

}  // namespace oca::robot
