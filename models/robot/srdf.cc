// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/srdf.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <string_view>
#include <system_error>

#include "oca/models/error.h"
#include "oca/models/robot/srdf_reader.h"
#include "oca/models/robot/xml_file.h"
#include "oca/models/whole_file.h"

namespace oca::robot {
namespace {

const TiXmlElement& CheckedRoot(const TiXmlDocument& document, const std::string& where) {
  const TiXmlElement& root = *document.RootElement();
  if (root.ValueStr() != "robot") {
    throw models::ModelError(fmt::format("{}:{}: root element; got {}; expected robot", where,
                                         root.Row(), root.ValueStr()));
  }
  return root;
}

bool Computed(const std::string& reason) {
  return reason == "Adjacent" || reason == "Always" || reason == "Default" || reason == "Never";
}

std::string TextOf(const TiXmlElement& element, const char* attribute) {
  const char* const text = element.Attribute(attribute);
  return text == nullptr ? "" : text;
}

void RemoveComputedPairs(TiXmlElement& root) {
  for (TiXmlElement* e = root.FirstChildElement("disable_collisions"); e != nullptr;) {
    TiXmlElement* const next = e->NextSiblingElement("disable_collisions");
    if (Computed(TextOf(*e, "reason"))) root.RemoveChild(e);
    e = next;
  }
}

bool Holds(const TiXmlElement& root, const DisabledPair& pair) {
  for (auto* e = root.FirstChildElement("disable_collisions"); e != nullptr;
       e = e->NextSiblingElement("disable_collisions")) {
    const std::string one = TextOf(*e, "link1");
    const std::string two = TextOf(*e, "link2");
    if (std::minmax(one, two) == std::minmax(pair.link1, pair.link2)) return true;
  }
  return false;
}

// What the file holds already, without what was computed, or a new document.
XmlDocument DocumentToFill(const std::filesystem::path& file, const std::string& robot) {
  const std::string where = file.string();
  if (std::error_code error; std::filesystem::exists(file, error)) {
    XmlDocument document = ParseXml(ReadXmlFile(file), where);
    const TiXmlElement& root = CheckedRoot(*document, where);
    if (root.FirstChildElement("link") != nullptr || root.FirstChildElement("joint") != nullptr) {
      throw models::ModelError(
          fmt::format("{}: SRDF to write; got a URDF; expected another file", where));
    }
    if (const std::string name = TextOf(root, "name"); name != robot) {
      throw models::ModelError(
          fmt::format("{}: robot; got '{}'; expected '{}', the URDF's name", where, name, robot));
    }
    RemoveComputedPairs(*document->RootElement());
    return document;
  }
  XmlDocument document(new TiXmlDocument);
  document->LinkEndChild(new TiXmlDeclaration("1.0", "", ""));
  auto* const root = new TiXmlElement("robot");
  root->SetAttribute("name", robot);
  document->LinkEndChild(root);
  return document;
}

}  // namespace

SrdfRobot DescribeForSrdf(const std::string& name, std::span<const Link> links,
                          std::span<const Joint> joints) {
  SrdfRobot robot{name, {}, {}, std::vector<int>(links.size(), -1), {}};
  for (const Link& link : links) robot.links.push_back(link.name.text());
  for (const Joint& joint : joints) {
    robot.joints.push_back(joint.name.text());
    robot.parents[static_cast<std::size_t>(joint.child_link)] = joint.parent_link;
    robot.limits.emplace_back(joint.lower_limit, joint.upper_limit);
  }
  return robot;
}

Srdf LoadSrdf(const std::filesystem::path& file, const SrdfRobot& robot) {
  const std::string where = file.string();
  const XmlDocument document = ParseXml(ReadXmlFile(file), where);
  return ReadSrdf(CheckedRoot(*document, where), robot, where);
}

void SaveDisabledPairs(const std::filesystem::path& file, const std::string& robot,
                       const std::vector<DisabledPair>& pairs) {
  const XmlDocument document = DocumentToFill(file, robot);
  for (const DisabledPair& pair : pairs) {
    if (Holds(*document->RootElement(), pair)) continue;
    auto* const element = new TiXmlElement("disable_collisions");
    element->SetAttribute("link1", pair.link1);
    element->SetAttribute("link2", pair.link2);
    element->SetAttribute("reason", pair.reason);
    document->RootElement()->LinkEndChild(element);
  }
  TiXmlPrinter printer;
  printer.SetIndent("  ");
  document->Accept(&printer);
  models::WriteWhole(file, printer.Str());
}

}  // namespace oca::robot
