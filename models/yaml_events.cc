// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/yaml_events.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>

#include "oca/models/foreign_text.h"

namespace oca::models::internal {
namespace {

YamlMark MarkOf(const YAML::Mark& mark) {
  return {mark.line + 1, mark.column + 1, static_cast<std::size_t>(std::max(mark.pos, 0))};
}

/// Passes yaml-cpp's events on, which carry true positions.
class Forwarder final : public YAML::EventHandler {
 public:
  explicit Forwarder(YamlEvents& to) : to_(to) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    // Thrown, because yaml-cpp starts one document after another at a stray bracket.
    if (documents_++ > 0) {
      throw YamlError(MarkOf(mark), "a second document or a stray bracket; expected the end");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    to_.OnNull(MarkOf(mark), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    to_.OnAlias(MarkOf(mark), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    to_.OnScalar({MarkOf(mark), tag, anchor}, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    to_.OnListStart({MarkOf(mark), tag, anchor});
  }
  void OnSequenceEnd() override { to_.OnListEnd(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    to_.OnMapStart({MarkOf(mark), tag, anchor});
  }
  void OnMapEnd() override { to_.OnMapEnd(); }

 private:
  YamlEvents& to_;
  int documents_{0};
};

/// yaml-cpp replaces what is not UTF-8, and its positions then no longer fit the text.
void CheckUtf8(std::string_view text) {
  YamlMark at;
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    if (length == 0) throw YamlError(at, "is not UTF-8; expected text");
    if (text[0] == '\n') ++at.line;
    at.offset += length;
    text.remove_prefix(length);
  }
}

/// yaml-cpp recurses a level; brackets that open deeper than any sane file are refused before.
void CheckNesting(std::string_view text) {
  YamlMark at;
  int depth = 0;
  std::size_t dashes = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == '-' || c == '?' || c == ':') ++dashes;
    if (c != '-' && c != '?' && c != ':' && c != ' ') dashes = 0;
    if (c == '\n') ++at.line;
    ++at.offset;
    if (depth > 4 * kDeepestYaml || dashes > 4 * kDeepestYaml) {
      throw YamlError(at, fmt::format("nested deeper than {} levels", kDeepestYaml));
    }
  }
}

}  // namespace

void ReadYamlEvents(std::string_view text, YamlEvents& events) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  CheckUtf8(text);
  CheckNesting(text);
  Forwarder forwarder(events);
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(forwarder)) {
    }
  } catch (const YAML::Exception& error) {
    throw YamlError(MarkOf(error.mark), error.msg);
  }
}

}  // namespace oca::models::internal
