// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xml_reader.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <set>

#include "oca/models/counted.h"
#include "oca/models/error.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/xml_numbers.h"

namespace oca::robot {
namespace {

bool Contains(const XmlReader::Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::string_view kBlanks = " \t\r\n";

/// What names something, in URDF and SRDF.
const XmlReader::Names kNaming{"name",      "link",         "link1",       "link2",
                               "joint",     "group",        "parent_link", "child_link",
                               "base_link", "parent_group", "tip_link",    "parent_frame",
                               "joint_name"};

std::string InOneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

// "link 'NAME' " of the link or joint that holds the element or is it, in one line.
std::string HolderOf(const TiXmlElement& element) {
  for (const TiXmlNode* node = &element; node != nullptr; node = node->Parent()) {
    const TiXmlElement* at = node->ToElement();
    if (at == nullptr || (at->ValueStr() != "link" && at->ValueStr() != "joint")) continue;
    const char* name = at->Attribute("name");
    if (name != nullptr) return fmt::format("{} '{}' ", at->ValueStr(), InOneLine(name));
  }
  return "";
}

}  // namespace

std::string XmlReader::Place(const TiXmlElement& element, std::string_view what) const {
  return fmt::format("{}:{}: {}<{}>: {}", where_, element.Row(), HolderOf(element),
                     element.ValueStr(), what);
}

std::string XmlReader::Describe(const TiXmlElement& element, std::string_view what,
                                std::string_view got, std::string_view expected) const {
  return fmt::format("{}; got {}; expected {}", Place(element, what), got, expected);
}

void XmlReader::Fail(const TiXmlElement& element, std::string_view what, std::string_view got,
                     std::string_view expected) const {
  throw models::ModelError(Describe(element, what, got, expected));
}

std::string XmlReader::Trimmed(const TiXmlElement& element, const char* attribute) {
  const char* const text = element.Attribute(attribute);
  const std::string_view all = text == nullptr ? "" : text;
  const std::size_t first = all.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return "";
  return std::string(all.substr(first, all.find_last_not_of(kBlanks) - first + 1));
}

std::string XmlReader::Text(const TiXmlElement& element, const char* attribute) const {
  const char* text = element.Attribute(attribute);
  if (text == nullptr || *text == '\0') Fail(element, attribute, "nothing", "a text");
  return text;
}

std::vector<double> XmlReader::Numbers(const TiXmlElement& element, const char* attribute,
                                       int count, bool required) const {
  const char* text = element.Attribute(attribute);
  const std::string expected = models::Counted(static_cast<std::size_t>(count), "finite number");
  if (text == nullptr) {
    if (required) Fail(element, attribute, "nothing", expected);
    return {};
  }
  const auto numbers = ParseFiniteNumbers(text);
  if (!numbers || static_cast<int>(numbers->size()) != count) {
    Fail(element, attribute, fmt::format("'{}'", text), expected);
  }
  return *numbers;
}

std::vector<double> XmlReader::Positive(const TiXmlElement& element, const char* attribute,
                                        int count) const {
  std::vector<double> numbers = Numbers(element, attribute, count, true);
  if (std::any_of(numbers.begin(), numbers.end(), [](double number) { return !(number > 0.0); })) {
    Fail(element, attribute, fmt::format("'{}'", element.Attribute(attribute)), "more than 0");
  }
  return numbers;
}

void XmlReader::CheckAttributes(const TiXmlElement& element, const Names& known) const {
  for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (!Contains(known, a->Name())) {
      Fail(element, "unknown attribute", fmt::format("'{}'", a->Name()),
           fmt::format("one of {}", fmt::join(known, ", ")));
    }
  }
}

void XmlReader::CheckChildren(const TiXmlElement& element, const Names& once,
                              const Names& repeated) const {
  Names known = once;
  known.insert(known.end(), repeated.begin(), repeated.end());
  std::set<std::string> seen;
  for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string& name = e->ValueStr();
    if (!Contains(known, name)) {
      const std::string meant = models::MisspeltName(name, known);
      if (meant.empty()) continue;
      Fail(*e, fmt::format("unknown element in <{}>", element.ValueStr()), name, meant);
    }
    if (Contains(once, name) && !seen.insert(name).second) {
      Fail(*e, fmt::format("element in <{}>", element.ValueStr()), "a second one", "one");
    }
  }
}

void XmlReader::CheckExpanded(const TiXmlElement& element) const {
  constexpr const char* kExpected =
      "expanded XML (run xacro first; a robot in a file named .xacro is expanded as it is read)";
  if (element.ValueStr().starts_with("xacro:")) {
    Fail(element, "element", element.ValueStr(), kExpected);
  }
  for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string& value = a->ValueStr();
    if (value.find("${") != std::string::npos || value.find("$(") != std::string::npos) {
      Fail(element, a->Name(), fmt::format("'{}'", value), kExpected);
    }
  }
  for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    CheckExpanded(*e);
  }
}

void XmlReader::CheckNames(const TiXmlElement& element) const {
  for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (!Contains(kNaming, a->Name())) continue;
    const std::string name = Trimmed(element, a->Name());
    if (name.find_first_of("\r\n") == std::string::npos) continue;
    Fail(element, a->Name(), fmt::format("'{}', with a line break", InOneLine(name)),
         "a name in one line");
  }
  for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    CheckNames(*e);
  }
}

}  // namespace oca::robot
