// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/node.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>

#include "oca/models/error.h"
#include "oca/models/robot/xacro/python_value.h"
#include "oca/models/robot/xml_file.h"

namespace oca::robot::xacro {
namespace {

constexpr std::size_t kMostWritten = 50'000'000;

class NodeWriter {
 public:
  WrittenNodes Write(const Node& root) {
    Line("<?xml version=\"1.0\"?>", root);
    Element(root, 0);
    return std::move(written_);
  }

 private:
  void Line(const std::string& text, const Node& of) {
    written_.text += text;
    written_.text += '\n';
    if (written_.text.size() > kMostWritten) {
      throw Mistake("expanded text", fmt::format("more than {} bytes", kMostWritten), "fewer");
    }
    written_.places.push_back(of.place.ToString());
  }

  /// throws ModelError for what expressions made and XML cannot hold, as U+0000
  static std::string Escaped(std::string_view text, const Node& of) {
    if (XmlPrefix(text) < text.size()) {
      throw models::ModelError(
          fmt::format("{}: text; got {}; expected characters that XML may hold",
                      of.place.ToString(), Shown(PythonValue(std::string(text)))));
    }
    std::string escaped;
    for (const char c : text) {
      switch (c) {
        case '&':
          escaped += "&amp;";
          break;
        case '<':
          escaped += "&lt;";
          break;
        case '>':
          escaped += "&gt;";
          break;
        case '"':
          escaped += "&quot;";
          break;
        case '\n':
        case '\r':
          escaped += ' ';
          break;
        default:
          escaped += c;
      }
    }
    return escaped;
  }

  static std::string Trimmed(const std::string& text) {
    constexpr std::string_view kAround = " \t\r\n";
    const std::size_t from = text.find_first_not_of(kAround);
    return from == std::string::npos ? ""
                                     : text.substr(from, text.find_last_not_of(kAround) + 1 - from);
  }

  void Element(const Node& node, int depth) {
    const std::string indent(static_cast<std::size_t>(2 * std::min(depth, 40)), ' ');
    std::string tag = indent + "<" + node.name;
    for (const auto& [name, value] : node.attributes) {
      tag += fmt::format(" {}=\"{}\"", name, Escaped(value, node));
    }
    std::vector<const Node*> inner;
    bool texts = true;
    for (const NodePtr& child : node.children) {
      if (child->name.empty() && Trimmed(child->text).empty()) continue;
      inner.push_back(child.get());
      texts = texts && child->name.empty();
    }
    if (inner.empty()) return Line(tag + "/>", node);
    if (texts) {
      std::string text;
      for (const Node* const part : inner) text += Escaped(part->text, *part);
      return Line(fmt::format("{}>{}</{}>", tag, Trimmed(text), node.name), node);
    }
    Line(tag + ">", node);
    for (const Node* const child : inner) {
      if (child->name.empty()) {
        Line(indent + "  " + Escaped(Trimmed(child->text), *child), *child);
      } else {
        Element(*child, depth + 1);
      }
    }
    Line(fmt::format("{}</{}>", indent, node.name), node);
  }

  WrittenNodes written_;
};

}  // namespace

std::string SourcePlace::ToString() const {
  constexpr int kMostCalls = 4;
  std::string text = fmt::format("{}:{}", *file, line);
  int count = 0;
  for (const Call* at = call.get(); at != nullptr; at = at->at.call.get()) {
    if (++count > kMostCalls) continue;
    text += fmt::format("{}{}:{}", count == 1 ? " (called at " : ", ", *at->at.file, at->at.line);
  }
  if (count > kMostCalls) text += fmt::format(" and {} more", count - kMostCalls);
  return count == 0 ? text : text + ")";
}

const std::string* Node::Attribute(std::string_view attribute) const {
  for (const auto& [key, value] : attributes) {
    if (key == attribute) return &value;
  }
  return nullptr;
}

void Node::SetAttribute(const std::string& attribute, std::string value) {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& one) { return one.first == attribute; });
  if (found != attributes.end()) {
    found->second = std::move(value);
  } else {
    attributes.emplace_back(attribute, std::move(value));
  }
}

NodePtr ReadNode(const TiXmlElement& element, const std::shared_ptr<const std::string>& file) {
  auto node = std::make_shared<Node>();
  node->place = {file, element.Row(), nullptr};
  node->name = element.ValueStr();
  for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    node->SetAttribute(a->Name(), a->ValueStr());
  }
  for (auto* child = element.FirstChild(); child != nullptr; child = child->NextSibling()) {
    if (const TiXmlElement* const inner = child->ToElement()) {
      node->children.push_back(ReadNode(*inner, file));
    } else if (const TiXmlText* const text = child->ToText()) {
      auto part = std::make_shared<Node>();
      part->place = {file, text->Row(), nullptr};
      part->text = text->ValueStr();
      node->children.push_back(std::move(part));
    }
  }
  return node;
}

WrittenNodes WriteNodes(const Node& root) { return NodeWriter().Write(root); }

}  // namespace oca::robot::xacro
