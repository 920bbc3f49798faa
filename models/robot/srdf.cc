// SPDX-License-Identifier: BSD-3-Clause
#include "models/robot/srdf.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "models/error.h"
#include "models/robot/nearest_name.h"
#include "models/robot/xml_file.h"

namespace oca::models {
namespace {

int FindLink(const TiXmlElement& element, const char* attribute,
             const std::vector<std::string>& links, const std::string& where) {
  const char* text = element.Attribute(attribute);
  const std::string name = text == nullptr ? "" : text;
  const auto found = std::find(links.begin(), links.end(), name);
  if (found == links.end()) {
    throw ModelError(fmt::format(
        "{}:{}: <{}> {}: unknown link; got '{}'; expected a link of the robot, nearest "
        "is '{}'",
        where, element.Row(), element.ValueStr(), attribute, name, NearestName(name, links)));
  }
  return static_cast<int>(found - links.begin());
}

}  // namespace

std::vector<std::pair<int, int>> LoadDisabledPairs(const std::filesystem::path& file,
                                                   const std::vector<std::string>& links) {
  const std::string where = file.string();
  const XmlDocument document = ParseXml(ReadXmlFile(file), where);
  const TiXmlElement& root = *document->RootElement();
  if (root.ValueStr() != "robot") {
    throw ModelError(fmt::format("{}:{}: root element; got {}; expected robot", where, root.Row(),
                                 root.ValueStr()));
  }
  std::set<std::pair<int, int>> pairs;
  const auto pair_of = [&](const TiXmlElement& element) {
    const int a = FindLink(element, "link1", links, where);
    const int b = FindLink(element, "link2", links, where);
    return std::pair<int, int>(std::min(a, b), std::max(a, b));
  };
  const auto for_each = [&root](const char* name, const auto& action) {
    for (auto* e = root.FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name)) {
      action(*e);
    }
  };
  // Defaults first, then what is enabled again, then what is disabled by name.
  for_each("disable_default_collisions", [&](const TiXmlElement& element) {
    const int a = FindLink(element, "link", links, where);
    for (int b = 0; b < static_cast<int>(links.size()); ++b) {
      if (a != b) pairs.emplace(std::min(a, b), std::max(a, b));
    }
  });
  for_each("enable_collisions", [&](const TiXmlElement& e) { pairs.erase(pair_of(e)); });
  for_each("disable_collisions", [&](const TiXmlElement& e) { pairs.insert(pair_of(e)); });
  return {pairs.begin(), pairs.end()};
}

}  // namespace oca::models
