// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "oca/models/robot/srdf.h"
#include "oca/models/robot/xml_reader.h"

class TiXmlElement;

namespace oca::robot {

/// The groups of one SRDF file, and how they lie in each other.
class SrdfGroups {
 public:
  using Names = XmlReader::Names;

  /// `reader`, which says what is wrong, outlives this.
  explicit SrdfGroups(const XmlReader& reader) : reader_(reader) {}

  /// throws ModelError for a second group of a name, naming the line of the first
  void Add(const TiXmlElement& element);
  bool Contains(const std::string& name) const { return numbers_.contains(name); }
  const Names& names() const { return names_; }

  /// A line for each way by which a group is in itself, naming those between.
  /// throws ModelError for more than kDeepestGroups in each other
  std::vector<std::string> CheckNesting();
  std::vector<SrdfGroup> Take() { return std::move(groups_); }

 private:
  int Levels(std::size_t number, Names& path, std::vector<std::string>& circles);
  [[noreturn]] void FailDeep(std::size_t number) const;

  const XmlReader& reader_;
  std::vector<SrdfGroup> groups_;
  std::vector<const TiXmlElement*> elements_;  // of each group
  std::vector<int> levels_;                    // of each: groups in each other; 0: not known yet
  Names names_;
  std::map<std::string, std::size_t> numbers_;  // by name
};

}  // namespace oca::robot
