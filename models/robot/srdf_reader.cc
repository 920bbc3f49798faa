// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/srdf_reader.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <string_view>

#include "oca/models/nearest_name.h"
#include "oca/models/robot/xml_numbers.h"
#include "oca/models/robot/xml_reader.h"

namespace oca::robot {
namespace {

using Names = XmlReader::Names;

/// What an element may have. source MoveIt's srdfdom, src/model.cpp
struct Kind {
  const char* name;
  Names required, optional;  // attributes
  Names children;
};

const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds = {
      {"group", {"name"}, {}, {"link", "joint", "chain", "group", "passive_joint"}},
      {"group_state", {"name", "group"}, {}, {"joint"}},
      {"end_effector", {"name", "parent_link", "group"}, {"parent_group"}, {}},
      {"virtual_joint", {"name", "type", "parent_frame", "child_link"}, {}, {}},
      {"passive_joint", {"name"}, {}, {}},
      {"joint_property", {"joint_name", "property_name", "value"}, {}, {}},
      {"link_sphere_approximation", {"link"}, {}, {"sphere"}},
      {"disable_default_collisions", {"link"}, {}, {}},
      {"enable_collisions", {"link1", "link2"}, {"reason"}, {}},
      {"disable_collisions", {"link1", "link2"}, {"reason"}, {}},
  };
  return kinds;
}

/// One file: checks every element, then takes what it says.
class SrdfReader {
 public:
  SrdfReader(const TiXmlElement& root, const SrdfRobot& robot, const std::string& where)
      : root_(root), robot_(robot), reader_(where) {}

  Srdf Read() {
    reader_.CheckExpanded(root_);
    CheckText(root_);
    CheckRobot();
    for (auto* e = root_.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckShape(*e);
      const std::string& name = e->ValueStr();
      if (name == "group") AddGroup(*e);
      if (name == "virtual_joint") {
        joints_.push_back(Attribute(*e, "name"));
        srdf_.frames.push_back(Attribute(*e, "parent_frame"));
      }
    }
    joints_.insert(joints_.end(), robot_.joints.begin(), robot_.joints.end());
    for (auto* e = root_.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckContent(*e);
      if (e->ValueStr() == "group_state") AddState(*e);
      if (e->ValueStr() == "passive_joint") srdf_.passive.push_back(Attribute(*e, "name"));
    }
    srdf_.disabled_pairs = Pairs();
    return std::move(srdf_);
  }

 private:
  [[noreturn]] void FailUnknown(const TiXmlElement& element, std::string_view what,
                                const std::string& got, const Names& known) const {
    reader_.Fail(
        element, what, fmt::format("'{}'", got),
        known.empty()
            ? std::string("none, there is none")
            : fmt::format("{}nearest is '{}'",
                          known.size() <= 12 ? fmt::format("one of {}; ", fmt::join(known, ", "))
                                             : std::string(),
                          models::NearestName(got, known)));
  }

  /// Without blanks around it, as MoveIt takes it; "" if absent.
  static std::string Attribute(const TiXmlElement& element, const char* attribute) {
    const char* const text = element.Attribute(attribute);
    const std::string_view all = text == nullptr ? "" : text;
    const std::size_t first = all.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return "";
    return std::string(all.substr(first, all.find_last_not_of(" \t\r\n") - first + 1));
  }

  void CheckRobot() const {
    for (auto* a = root_.FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string name = a->Name();
      if (name != "name" && name != "version" && !name.starts_with("xmlns")) {
        FailUnknown(root_, "unknown attribute", name, {"name"});
      }
    }
    const std::string name = Attribute(root_, "name");
    if (root_.Attribute("name") == nullptr || name == robot_.name) return;
    reader_.Fail(root_, "name", fmt::format("'{}'", name),
                 fmt::format("'{}', the URDF's robot", robot_.name));
  }

  /// Text between elements is a tag that lost its brackets.
  void CheckText(const TiXmlElement& element) const {
    for (const TiXmlNode* node = element.FirstChild(); node != nullptr;
         node = node->NextSibling()) {
      if (node->ToText() == nullptr) continue;
      reader_.Fail(element, "text", fmt::format("'{}'", node->ValueStr().substr(0, 40)),
                   "elements and comments only");
    }
  }

  void CheckAttributes(const TiXmlElement& element, const Names& required,
                       const Names& optional) const {
    Names known = required;
    known.insert(known.end(), optional.begin(), optional.end());
    for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (std::find(known.begin(), known.end(), a->Name()) == known.end()) {
        FailUnknown(element, "unknown attribute", a->Name(), known);
      }
    }
    for (const std::string& name : required) {
      if (Attribute(element, name.c_str()).empty())
        reader_.Fail(element, name, "nothing", "a text");
    }
  }

  void CheckShape(const TiXmlElement& element) const {
    const std::string& name = element.ValueStr();
    const auto& kinds = Kinds();
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                   [&](const Kind& known) { return name == known.name; });
    if (kind == kinds.end()) {
      Names known;
      for (const Kind& other : kinds) known.emplace_back(other.name);
      FailUnknown(element, "unknown element", name, known);
    }
    CheckAttributes(element, kind->required, kind->optional);
    CheckText(element);
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const Names& known = kind->children;
      if (std::find(known.begin(), known.end(), e->ValueStr()) == known.end()) {
        FailUnknown(*e, fmt::format("unknown element in <{}>", name), e->ValueStr(), known);
      }
      CheckText(*e);
      if (auto* inner = e->FirstChildElement()) {
        FailUnknown(*inner, fmt::format("unknown element in <{}>", e->ValueStr()),
                    inner->ValueStr(), {});
      }
    }
  }

  void CheckKnown(const TiXmlElement& element, const char* attribute, const char* what,
                  const Names& known) const {
    const std::string name = Attribute(element, attribute);
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const std::string nearest = known.empty() ? "" : models::NearestName(name, known);
    reader_.Fail(element, fmt::format("{}: unknown {}", attribute, what), fmt::format("'{}'", name),
                 nearest.empty()
                     ? fmt::format("a {}, of which there is none", what)
                     : fmt::format("a {} of the robot, nearest is '{}'", what, nearest));
  }

  void CheckContent(const TiXmlElement& element) const {
    for (const char* attribute : {"link", "link1", "link2", "parent_link", "child_link"}) {
      if (element.Attribute(attribute) != nullptr) {
        CheckKnown(element, attribute, "link", robot_.links);
      }
    }
    for (const char* attribute : {"group", "parent_group"}) {
      if (element.Attribute(attribute) != nullptr) CheckKnown(element, attribute, "group", groups_);
    }
    const std::string& name = element.ValueStr();
    if (name == "passive_joint") CheckKnown(element, "name", "joint", joints_);
    if (name == "joint_property") CheckKnown(element, "joint_name", "joint", joints_);
    if (name == "virtual_joint") {
      static const Names kTypes{"fixed", "floating", "planar"};
      CheckKnown(element, "type", "type of virtual joint", kTypes);
    }
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckPart(*e, name == "group_state");
    }
  }

  void CheckPart(const TiXmlElement& part, bool of_state) const {
    const std::string& name = part.ValueStr();
    if (name == "chain") {
      CheckAttributes(part, {"base_link", "tip_link"}, {});
      CheckKnown(part, "base_link", "link", robot_.links);
      CheckKnown(part, "tip_link", "link", robot_.links);
    } else if (name == "sphere") {
      CheckAttributes(part, {"center", "radius"}, {});
      reader_.Numbers(part, "center", 3, true);
      if (reader_.Numbers(part, "radius", 1, true)[0] < 0.0) {
        reader_.Fail(part, "radius", part.Attribute("radius"), "a number not below 0");
      }
    } else if (of_state) {
      CheckAttributes(part, {"name", "value"}, {});
      CheckKnown(part, "name", "joint", joints_);
      const auto numbers = ParseFiniteNumbers(part.Attribute("value"));
      if (!numbers || numbers->empty()) {
        reader_.Fail(part, "value", fmt::format("'{}'", part.Attribute("value")), "finite numbers");
      }
    } else {
      CheckAttributes(part, {"name"}, {});
      CheckKnown(part, "name", name.c_str(),
                 name == "link"            ? robot_.links
                 : name.ends_with("joint") ? joints_
                                           : groups_);
    }
  }

  /// Groups of one name are one.
  void AddGroup(const TiXmlElement& element) {
    const std::string name = Attribute(element, "name");
    const auto place = std::find(groups_.begin(), groups_.end(), name) - groups_.begin();
    if (place == std::ssize(groups_)) {
      groups_.push_back(name);
      srdf_.groups.push_back({name});
    }
    SrdfGroup& group = srdf_.groups[static_cast<std::size_t>(place)];
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string& kind = e->ValueStr();
      const std::string named = Attribute(*e, "name");
      if (kind == "chain") {
        group.chains.push_back({Attribute(*e, "base_link"), Attribute(*e, "tip_link")});
      } else if (kind == "link") {
        group.links.push_back(named);
      } else if (kind == "group") {
        group.groups.push_back(named);
      } else {
        (kind == "joint" ? group.joints : srdf_.passive).push_back(named);
      }
    }
  }

  /// What it says of a virtual joint, whose numbers are several, is where the robot stands.
  void AddState(const TiXmlElement& element) {
    NamedState state{Attribute(element, "name"), Attribute(element, "group")};
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string joint = Attribute(*e, "name");
      const auto numbers = ParseFiniteNumbers(e->Attribute("value"));
      const auto& known = robot_.joints;
      if (numbers->size() != 1 || std::find(known.begin(), known.end(), joint) == known.end()) {
        continue;
      }
      state.positions.emplace_back(joint, numbers->front());
    }
    srdf_.states.push_back(std::move(state));
  }

  int LinkAt(const TiXmlElement& element, const char* attribute) const {
    const auto found =
        std::find(robot_.links.begin(), robot_.links.end(), Attribute(element, attribute));
    return static_cast<int>(found - robot_.links.begin());
  }

  /// Defaults first, then what is enabled again, then what is disabled by name.
  std::vector<std::pair<int, int>> Pairs() const {
    std::set<std::pair<int, int>> pairs;
    const auto for_each = [this](const char* name, const auto& action) {
      for (auto* e = root_.FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name)) {
        action(*e);
      }
    };
    const auto pair_of = [this](const TiXmlElement& element) {
      return std::pair<int, int>(std::minmax({LinkAt(element, "link1"), LinkAt(element, "link2")}));
    };
    for_each("disable_default_collisions", [&](const TiXmlElement& element) {
      const int a = LinkAt(element, "link");
      for (int b = 0; b < static_cast<int>(robot_.links.size()); ++b) {
        if (a != b) pairs.emplace(std::min(a, b), std::max(a, b));
      }
    });
    for_each("enable_collisions", [&](const TiXmlElement& e) { pairs.erase(pair_of(e)); });
    for_each("disable_collisions", [&](const TiXmlElement& e) { pairs.insert(pair_of(e)); });
    return {pairs.begin(), pairs.end()};
  }

  const TiXmlElement& root_;
  const SrdfRobot& robot_;
  const XmlReader reader_;
  Names groups_, joints_;
  Srdf srdf_;
};

}  // namespace

Srdf ReadSrdf(const TiXmlElement& root, const SrdfRobot& robot, const std::string& where) {
  return SrdfReader(root, robot, where).Read();
}

}  // namespace oca::robot
