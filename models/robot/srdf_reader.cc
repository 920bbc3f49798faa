// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/srdf_reader.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "oca/models/motion/key_points.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/srdf_groups.h"
#include "oca/models/robot/xml_numbers.h"
#include "oca/models/robot/xml_reader.h"

namespace oca::robot {
namespace {

using Names = std::vector<std::string>;

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
    reader_.CheckNames(root_);
    CheckText(root_);
    CheckRobot();
    for (auto* e = root_.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckShape(*e);
      const std::string& name = e->ValueStr();
      if (name == "group") groups_.Add(*e);
      if (name == "virtual_joint") {
        joints_.push_back(Attribute(*e, "name"));
        srdf_.frames.push_back(Attribute(*e, "parent_frame"));
      }
    }
    joints_.insert(joints_.end(), robot_.joints.begin(), robot_.joints.end());
    for (auto* e = root_.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      CheckContent(*e);
      if (e->ValueStr() == "group") LookIntoGroup(*e);
      if (e->ValueStr() == "group_state") AddState(*e);
      if (e->ValueStr() == "passive_joint") srdf_.passive.push_back(Attribute(*e, "name"));
    }
    for (const std::string& circle : groups_.CheckNesting()) Warn("circle", circle);
    srdf_.groups = groups_.Take();
    srdf_.disabled_pairs = Pairs();
    for (const auto& [kind, line] : warnings_) {
      const std::size_t more = told_.at(kind) - 1;
      srdf_.warnings.push_back(more == 0 ? line : fmt::format("{}; and {} more", line, more));
    }
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

  static std::string Attribute(const TiXmlElement& element, const char* attribute) {
    return XmlReader::Trimmed(element, attribute);
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

  void CheckGroup(const TiXmlElement& element, const char* attribute) const {
    if (groups_.Contains(Attribute(element, attribute))) return;
    CheckKnown(element, attribute, "group", groups_.names());
  }

  void CheckContent(const TiXmlElement& element) const {
    for (const char* attribute : {"link", "link1", "link2", "parent_link", "child_link"}) {
      if (element.Attribute(attribute) != nullptr) {
        CheckKnown(element, attribute, "link", robot_.links);
      }
    }
    for (const char* attribute : {"group", "parent_group"}) {
      if (element.Attribute(attribute) != nullptr) CheckGroup(element, attribute);
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
      if (name == "group") return CheckGroup(part, "name");
      CheckKnown(part, "name", name.c_str(), name == "link" ? robot_.links : joints_);
    }
  }

  /// The first of a kind is told, and how many others there are.
  void Warn(const char* kind, const TiXmlElement& element, std::string_view what,
            const std::string& got, std::string_view expected) {
    Warn(kind, reader_.Describe(element, what, got, expected));
  }
  void Warn(const char* kind, const std::string& line) {
    if (told_[kind]++ == 0) warnings_.emplace_back(kind, line);
  }

  void LookIntoGroup(const TiXmlElement& element) {
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (e->ValueStr() == "passive_joint") srdf_.passive.push_back(Attribute(*e, "name"));
      if (e->ValueStr() == "chain") LookAtChain(*e);
    }
  }

  void LookAtChain(const TiXmlElement& chain) {
    const int base = LinkAt(chain, "base_link");
    const int tip = LinkAt(chain, "tip_link");
    if (robot_.parents.empty()) return;
    const std::string name = Attribute(chain, "base_link");
    if (base == tip) {
      return Warn("empty chain", chain, "tip_link", fmt::format("'{}', the base_link too", name),
                  "another link: such a chain has no joint");
    }
    for (int link = base; link >= 0; link = robot_.parents[static_cast<std::size_t>(link)]) {
      if (link != tip) continue;
      return Warn("chain", chain, "base_link",
                  fmt::format("'{}', which lies beyond the tip_link '{}'", name,
                              Attribute(chain, "tip_link")),
                  "the link nearer to the root; the joints between are taken");
    }
  }

  /// MoveIt's assistant rounds states to four decimals.
  void LookAtState(const TiXmlElement& part, std::size_t joint, double position) {
    constexpr double kRounding = 5e-5;  // rad, m
    if (robot_.limits.empty()) return;
    const double lower = std::max(robot_.limits[joint].first, -motion::kFarthestPosition);
    const double upper = std::min(robot_.limits[joint].second, motion::kFarthestPosition);
    if (position >= lower - kRounding && position <= upper + kRounding) return;
    Warn("state", part, "value", fmt::format("{:g}", position),
         fmt::format("{:g} to {:g}, its limits", lower, upper));
  }

  /// What it says of a virtual joint, whose numbers are several, is where the robot stands.
  void AddState(const TiXmlElement& element) {
    NamedState state{Attribute(element, "name"), Attribute(element, "group")};
    for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string joint = Attribute(*e, "name");
      const auto numbers = ParseFiniteNumbers(e->Attribute("value"));
      const auto& known = robot_.joints;
      const auto found = std::find(known.begin(), known.end(), joint);
      if (numbers->size() != 1 || found == known.end()) continue;
      LookAtState(*e, static_cast<std::size_t>(found - known.begin()), numbers->front());
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
  std::vector<std::pair<int, int>> Pairs() {
    std::set<std::pair<int, int>> pairs;
    const auto for_each = [this](const char* name, const auto& action) {
      for (auto* e = root_.FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name)) {
        action(*e);
      }
    };
    const auto pair_of = [this](const TiXmlElement& element) {
      return std::pair<int, int>(std::minmax({LinkAt(element, "link1"), LinkAt(element, "link2")}));
    };
    const auto disable = [&](const TiXmlElement& element) {
      const std::pair<int, int> pair = pair_of(element);
      if (pair.first != pair.second) return void(pairs.insert(pair));
      Warn("pair", element, "link2",
           fmt::format("'{}', the link1 too", Attribute(element, "link2")),
           "another link: a link is never checked against itself");
    };
    for_each("disable_default_collisions", [&](const TiXmlElement& element) {
      const int a = LinkAt(element, "link");
      for (int b = 0; b < static_cast<int>(robot_.links.size()); ++b) {
        if (a != b) pairs.emplace(std::min(a, b), std::max(a, b));
      }
    });
    for_each("enable_collisions", [&](const TiXmlElement& e) { pairs.erase(pair_of(e)); });
    for_each("disable_collisions", disable);
    return {pairs.begin(), pairs.end()};
  }

  const TiXmlElement& root_;
  const SrdfRobot& robot_;
  const XmlReader reader_;
  SrdfGroups groups_{reader_};
  Names joints_;
  Srdf srdf_;
  std::vector<std::pair<const char*, std::string>> warnings_;  // kind and line
  std::map<std::string_view, std::size_t> told_;               // of a kind
};

}  // namespace

Srdf ReadSrdf(const TiXmlElement& root, const SrdfRobot& robot, const std::string& where) {
  return SrdfReader(root, robot, where).Read();
}

}  // namespace oca::robot
