// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace oca::geometry::internal {

inline constexpr std::string_view kXmlSpaces = " \t\r\n";

/// An element of a Collada text, of which it is a view.
struct ColladaElement {
  std::string_view name;
  std::string_view attributes;
  std::string_view text;  ///< between its tag and the next one
  int line{0};            ///< that its tag begins in
  int text_line{0};
  int parent{-1};
  int end{0};         ///< of its subtree, which the elements from its own on to this one are
  bool closed{true};  ///< what follows its text is its closing tag
};

/// The elements of a Collada text in their order: the root is the first.
class ColladaTree {
 public:
  /// throws ModelError `file:line: ...`: no well-formed elements, a document type declaration,
  ///        elements nested deeper than 200, more than a million, with attributes of more than 4096
  ///        characters, a root that is not <COLLADA>
  ColladaTree(const std::filesystem::path& file, std::string_view text);

  const ColladaElement& operator[](int element) const { return elements_[element]; }
  int size() const { return static_cast<int>(elements_.size()); }
  /// Its children, those of one name if one is given. To go over them counts: what many elements
  /// refer to may have many.
  /// throws ModelError after 20 million of them
  std::vector<int> Children(int element, std::string_view name = {}) const;
  /// The first of that name; -1 if there is none.
  int Child(int element, std::string_view name) const;
  /// The value of an attribute as it stands there; nothing without it.
  std::string_view Attribute(int element, std::string_view name) const;
  /// A whole number, `usual` without it. throws ModelError
  std::uint64_t Number(int element, std::string_view name, std::uint64_t usual) const;

  /// throws ModelError at an element; at `line` if it is not 0
  [[noreturn]] void Refuse(int element, std::string_view what, std::string_view got,
                           std::string_view expected, int line = 0) const;

 private:
  void CountStep(int element) const;

  const std::filesystem::path& file_;
  std::vector<ColladaElement> elements_;
  mutable std::uint64_t steps_{0};
};

}  // namespace oca::geometry::internal
