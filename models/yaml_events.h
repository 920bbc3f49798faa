// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "oca/framework/dataflow/error_base.h"

namespace oca::models::internal {

/// A place in a YAML text: line and column from 1, offset from 0.
struct YamlMark {
  int line{1};
  int column{1};
  std::size_t offset{0};
};

/// A text that is no YAML, or not within bounds.
struct YamlError : Error {
  YamlError(const YamlMark& at, const std::string& what) : Error(what), mark(at) {}
  const YamlMark mark;
};

/// Is told what a YAML text consists of, in order. What it throws ends the reading.
class YamlEvents {
 public:
  /// A tag is "!" of quoted text, "?" or empty of what has none. Anchors are 0 where there is none.
  struct Node {
    YamlMark mark;
    std::string tag;
    std::size_t anchor{0};
  };
  virtual ~YamlEvents() = default;
  virtual void OnNull(const YamlMark& mark, std::size_t anchor) = 0;
  virtual void OnAlias(const YamlMark& mark, std::size_t anchor) = 0;
  virtual void OnScalar(const Node& node, const std::string& value) = 0;
  virtual void OnListStart(const Node& node) = 0;
  virtual void OnListEnd() = 0;
  virtual void OnMapStart(const Node& node) = 0;
  virtual void OnMapEnd() = 0;
};

inline constexpr int kDeepestYaml = 64;

/// Reads one document of UTF-8 text, without the byte order mark it may begin with.
/// throws YamlError if the text is no UTF-8, no YAML, more than one document or nests deeper than
/// kDeepestYaml levels by far; who builds values counts the levels
void ReadYamlEvents(std::string_view text, YamlEvents& events);

}  // namespace oca::models::internal
