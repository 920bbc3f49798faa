// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

class TiXmlElement;

namespace oca::robot::xacro {

struct Call;

/// Where something is written, and the macro calls that lead there.
struct SourcePlace {
  std::shared_ptr<const std::string> file{};
  int line{0};
  std::shared_ptr<const Call> call{};  ///< the innermost; nullptr: none

  /// "file:line", or "file:line (called at file:line, file:line)".
  std::string ToString() const;
};
struct Call {
  SourcePlace at;
};

struct Node;
using NodePtr = std::shared_ptr<const Node>;

/// An element, or a text if it has no name.
struct Node {
  SourcePlace place{};
  std::string name{};
  std::string text{};
  std::vector<std::pair<std::string, std::string>> attributes{};
  std::vector<NodePtr> children{};

  /// nullptr if there is none.
  const std::string* Attribute(std::string_view attribute) const;
  void SetAttribute(const std::string& attribute, std::string value);
};

/// The tree of an element that was read from `file`; comments are left out.
NodePtr ReadNode(const TiXmlElement& element, const std::shared_ptr<const std::string>& file);

/// XML text of a tree, with the place of each of its lines.
struct WrittenNodes {
  std::string text;
  std::vector<std::string> places;
};
/// throws Mistake if it is longer than 50 MB
WrittenNodes WriteNodes(const Node& root);

}  // namespace oca::robot::xacro
