// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oca/models/robot/warning_lines.h"

class TiXmlElement;
class TiXmlNode;

namespace oca::robot {

/// What was done to an XML document so that it can be read, by kind.
class RepairNotes {
 public:
  /// `what` names the kind, `which` the element: `of link 'upper'`.
  void Add(const char* what, const TiXmlElement& element, const std::string& which);
  /// The same, and takes the element out.
  void Drop(TiXmlNode& parent, TiXmlElement& element, const char* what, const std::string& which);

  /// A sum of a kind shows three: `what: of link 'upper' (line 12), ... and 20 more`.
  WarningLines Lines() const;

 private:
  std::map<std::string, std::vector<std::string>> places_;  // by kind
};

/// The name of an element, in quotes.
std::string QuotedName(const TiXmlElement& element);

}  // namespace oca::robot
