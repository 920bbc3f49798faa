// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/yaml_events.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
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

/// What yaml-cpp says is wrong, and what is.
struct Reason {
  std::string_view said, meant;
};
constexpr std::string_view kFlow = "a { that nothing closes; expected } or a comma before here";
constexpr std::string_view kList = "a [ that nothing closes; expected ] or a comma before here";
constexpr std::string_view kDedent =
    "a line that belongs to no map or list above; expected the indentation of one of them";
constexpr std::string_view kDirective = "a directive %; expected %YAML 1.2, %TAG or none";
constexpr std::string_view kName = "no name behind & or *; expected letters, digits, - or _";
constexpr std::string_view kTag = "a tag behind ! that does not end; expected none";
constexpr std::string_view kTwice = "two tags, anchors or aliases of one value; expected one";
const std::array<Reason, 30> kReasons{
    {{YAML::ErrorMsg::MAP_VALUE,
      "a colon where no key ends; expected 'key: value' with the key on this line, of at most 1024 "
      "characters, and quotes around values with a colon"},
     {YAML::ErrorMsg::MAP_KEY, "a key where none can stand; expected one in a line of its own"},
     {YAML::ErrorMsg::BLOCK_ENTRY, "a dash where no item begins; expected it first in its line"},
     {YAML::ErrorMsg::END_OF_MAP, kDedent},
     {YAML::ErrorMsg::END_OF_SEQ, kDedent},
     {YAML::ErrorMsg::END_OF_MAP_FLOW, kFlow},
     {YAML::ErrorMsg::END_OF_SEQ_FLOW, kList},
     {YAML::ErrorMsg::FLOW_END, "a ] or } that nothing opened; expected none"},
     {YAML::ErrorMsg::TAB_IN_INDENTATION, "a tab before text; expected blanks"},
     {YAML::ErrorMsg::YAML_MAJOR_VERSION, kDirective},
     {YAML::ErrorMsg::YAML_VERSION, kDirective},
     {YAML::ErrorMsg::YAML_DIRECTIVE_ARGS, kDirective},
     {YAML::ErrorMsg::REPEATED_YAML_DIRECTIVE, kDirective},
     {YAML::ErrorMsg::TAG_DIRECTIVE_ARGS, kDirective},
     {YAML::ErrorMsg::REPEATED_TAG_DIRECTIVE, kDirective},
     {YAML::ErrorMsg::DOC_IN_SCALAR, "--- or ... within quotes; expected their end before it"},
     {YAML::ErrorMsg::EOF_IN_SCALAR, "a quote that nothing closes; expected its end"},
     {YAML::ErrorMsg::UNKNOWN_TOKEN, "a character that begins no value; expected quotes around it"},
     {YAML::ErrorMsg::INVALID_ESCAPE,
      "a backslash in \"\" before another character than \\, \", n, "
      "t and the like; expected \\\\ for a backslash"},
     {YAML::ErrorMsg::INVALID_HEX,
      "\\x, \\u or \\U in \"\"; expected hexadecimal digits behind it"},
     {YAML::ErrorMsg::INVALID_UNICODE, "\\u or \\U of no character; expected one of Unicode"},
     {YAML::ErrorMsg::UNKNOWN_ANCHOR, "an alias * of no anchor; expected & and its name before it"},
     {YAML::ErrorMsg::ALIAS_NOT_FOUND, kName},
     {YAML::ErrorMsg::ANCHOR_NOT_FOUND, kName},
     {YAML::ErrorMsg::CHAR_IN_ALIAS, kName},
     {YAML::ErrorMsg::CHAR_IN_ANCHOR, kName},
     {YAML::ErrorMsg::CHAR_IN_BLOCK, "text behind | or >; expected it in the next line"},
     {YAML::ErrorMsg::END_OF_VERBATIM_TAG, kTag},
     {YAML::ErrorMsg::MULTIPLE_TAGS, kTwice},
     {YAML::ErrorMsg::MULTIPLE_ANCHORS, kTwice}}};

/// Where it is wrong: at the end of the text, whose column yaml-cpp loses, or before it.
YamlMark PlaceOf(std::string_view text, const YAML::Exception& error) {
  YamlMark at = MarkOf(error.mark);
  if (at.offset < text.size()) return at;
  at.line = 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  at.column = static_cast<int>(text.size() - (text.rfind('\n') + 1)) + 1;  // npos + 1 is 0
  at.offset = text.size();
  return at;
}

/// In words of this project.
std::string ReasonOf(std::string_view text, const YAML::Exception& error) {
  const std::size_t at = std::min(MarkOf(error.mark).offset, text.size());
  const std::size_t begin = text.substr(0, at).rfind('\n') + 1;  // npos + 1 is 0
  const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
  const std::size_t indent = std::min(line.find_first_not_of(" \t"), line.size());
  if (line.substr(0, indent).find('\t') != line.npos) {
    return "no YAML; got a tab before the text of a line; expected blanks";
  }
  const auto* const reason =
      std::find_if(kReasons.begin(), kReasons.end(), [&](const Reason& candidate) {
        return std::string_view(error.msg).starts_with(candidate.said);
      });
  return fmt::format("no YAML; got {}", reason == kReasons.end()
                                            ? "what cannot be read; expected maps, lists and values"
                                            : reason->meant);
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
    throw YamlError(PlaceOf(text, error), ReasonOf(text, error));
  }
}

}  // namespace oca::models::internal
