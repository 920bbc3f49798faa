// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

class TiXmlElement;

namespace oca::robot {

/// Strict access to the elements of one XML file. Every refusal is a ModelError
/// `file:line: link 'NAME' <element>: what; got X; expected Y`, where the link or joint is the one
/// around the element, if any.
class XmlReader {
 public:
  using Names = std::vector<std::string>;

  /// `where` names the file.
  explicit XmlReader(std::string where) : where_(std::move(where)) {}

  /// `file:line: link 'NAME' <element>: what`
  std::string Place(const TiXmlElement& element, std::string_view what) const;
  /// The whole text.
  std::string Describe(const TiXmlElement& element, std::string_view what, std::string_view got,
                       std::string_view expected) const;
  [[noreturn]] void Fail(const TiXmlElement& element, std::string_view what, std::string_view got,
                         std::string_view expected) const;

  /// The value of an attribute without blanks around it, as MoveIt takes it; "" if absent.
  static std::string Trimmed(const TiXmlElement& element, const char* attribute);

  /// The value of an attribute that must be there and not empty.
  std::string Text(const TiXmlElement& element, const char* attribute) const;
  /// `count` finite numbers; none if the attribute is absent and not `required`.
  std::vector<double> Numbers(const TiXmlElement& element, const char* attribute, int count,
                              bool required = false) const;
  /// The same for numbers that must be there and above 0.
  std::vector<double> Positive(const TiXmlElement& element, const char* attribute, int count) const;

  /// Refuses attributes that are not in `known`.
  void CheckAttributes(const TiXmlElement& element, const Names& known) const;
  /// Refuses a second child of a name in `once`, and a child whose name is within two letters of a
  /// known one; elements of other tools pass.
  void CheckChildren(const TiXmlElement& element, const Names& once, const Names& repeated) const;
  /// Refuses xacro elements and ${...} or $(...) in attributes, of the element and all below.
  void CheckExpanded(const TiXmlElement& element) const;
  /// Refuses names with a line break within, of the element and all below: in a message what
  /// follows would pass for a line of its own.
  void CheckNames(const TiXmlElement& element) const;

 private:
  std::string where_;
};

}  // namespace oca::robot
