// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/yaml_reader.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "oca/diagrams/files/plain_scalar.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/opened_files.h"

namespace oca::files {
namespace {

constexpr int kDeepestYaml = 64;
/// Maps are searched key by key, so their size is limited.
constexpr std::size_t kMostKeys = 5000;
constexpr std::size_t kMostProblems = 50;

/// Builds the tree from yaml-cpp's events, which carry true positions.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(std::string_view text, std::shared_ptr<const std::string> name, Problems& problems)
      : text_(text), name_(std::move(name)), problems_(problems) {}

  Value Take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    // Thrown, because yaml-cpp starts one document after another at a stray bracket.
    if (documents_++ > 0) {
      throw YAML::ParserException(mark, "a second document or a stray bracket; expected the end");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    if (stack_.empty()) return;  // an empty file: the reader of the tree says what it misses
    problems_.Add(At(mark), stack_.back().has_key
                                ? fmt::format("{}: no value; expected one", stack_.back().key)
                                : std::string("an item without a value"));
    Put(Value({}, At(mark)));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    problems_.Add(At(mark), "an alias; expected a value (parameters and ${name} serve repetition)");
    Put(Value({}, At(mark)));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    CheckPlainNode(mark, tag, anchor);
    const bool quoted = tag == "!";
    if (quoted) CheckClosed(mark);
    if (ExpectsKey()) return TakeKey(mark, value);
    std::string problem;
    Value::Data data = quoted ? Value::Data(value) : ReadPlainScalar(value, problem);
    if (!problem.empty()) problems_.Add(At(mark), Here() + problem);
    Put(Value(std::move(data), At(mark)));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    Open(mark, tag, anchor, Value::List());
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    Open(mark, tag, anchor, Value::Map());
  }
  void OnMapEnd() override { Close(); }

 private:
  struct Frame {
    Value value;
    std::string key{};
    Location key_location{};
    bool has_key{false};
    bool drop{false};  // a map as a key: its contents go nowhere
  };

  Location At(const YAML::Mark& mark) const { return {name_, mark.line + 1, mark.column + 1}; }
  std::string Here() const {
    return !stack_.empty() && stack_.back().has_key ? stack_.back().key + ": " : "";
  }
  bool ExpectsKey() const {
    return !stack_.empty() && stack_.back().value.map() != nullptr && !stack_.back().has_key;
  }

  void CheckPlainNode(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != 0) problems_.Add(At(mark), "an anchor; expected a value without one");
    // yaml-cpp gives quoted text the tag "!" too.
    const std::size_t at = static_cast<std::size_t>(mark.pos);
    const bool written = at < text_.size() && text_[at] == '!';
    if (written || (!tag.empty() && tag != "?" && tag != "!")) {
      problems_.Add(At(mark), fmt::format("the tag '{}'; expected a value without one", tag));
    }
    if (problems_.all().size() >= kMostProblems) {
      throw YAML::ParserException(mark, "too many problems; the rest of the file is not read");
    }
  }

  /// yaml-cpp takes the end of the file for a closing quote.
  void CheckClosed(const YAML::Mark& mark) {
    std::size_t i = static_cast<std::size_t>(mark.pos);
    if (i >= text_.size()) return;
    const char quote = text_[i];
    if (quote != '"' && quote != '\'') return;  // a block scalar
    for (++i; i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\') {
        ++i;
      } else if (text_[i] == quote) {
        if (quote == '\'' && i + 1 < text_.size() && text_[i + 1] == quote) {
          ++i;
          continue;
        }
        return;
      }
    }
    problems_.Add(At(mark), fmt::format("a quote {} that is not closed", quote));
  }

  void TakeKey(const YAML::Mark& mark, const std::string& key) {
    Frame& frame = stack_.back();
    frame.key = key;
    frame.key_location = At(mark);
    frame.has_key = true;
    if (key == "<<") {
      problems_.Add(At(mark), "the merge key '<<'; expected a plain key (include serves reuse)");
    }
    const Value::Map& map = *frame.value.map();
    const auto before = std::find_if(map.begin(), map.end(),
                                     [&](const Value::Entry& entry) { return entry.key == key; });
    if (before != map.end()) {
      problems_.Add(At(mark), fmt::format("{}: duplicate key; the first is at {}", key,
                                          before->location.ToString()));
    }
    if (map.size() >= kMostKeys) {
      throw YAML::ParserException(mark, fmt::format("more than {} keys in one map", kMostKeys));
    }
  }

  void Open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            Value::Data data) {
    CheckPlainNode(mark, tag, anchor);
    if (stack_.size() >= kDeepestYaml) {
      throw YAML::ParserException(mark, fmt::format("nested deeper than {} levels", kDeepestYaml));
    }
    const bool as_key = ExpectsKey();
    if (as_key) problems_.Add(At(mark), "a map or list as a key; expected text");
    Frame frame{Value(std::move(data), At(mark))};
    frame.drop = as_key;
    stack_.push_back(std::move(frame));
  }

  void Close() {
    Frame frame = std::move(stack_.back());
    stack_.pop_back();
    if (frame.drop) {
      stack_.back().key.clear();
      stack_.back().has_key = true;
      return;
    }
    Put(std::move(frame.value));
  }

  void Put(Value value) {
    if (stack_.empty()) {
      root_ = std::move(value);
      return;
    }
    Frame& frame = stack_.back();
    if (Value::List* const list = frame.value.list()) {
      list->push_back(std::move(value));
      return;
    }
    if (!frame.has_key) {  // a null as a key
      frame.has_key = true;
      return;
    }
    if (frame.value.Find(frame.key) == nullptr) {
      frame.value.map()->push_back({frame.key, frame.key_location, std::move(value)});
    }
    frame.has_key = false;
  }

  std::string_view text_;
  std::shared_ptr<const std::string> name_;
  Problems& problems_;
  std::vector<Frame> stack_;
  Value root_;
  int documents_{0};
};

/// Length of the UTF-8 sequence that `text` begins with; 0 if it begins with none.
std::size_t SequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t length = byte(0) < 0xc2   ? 0
                             : byte(0) < 0xe0 ? 2
                             : byte(0) < 0xf0 ? 3
                             : byte(0) < 0xf5 ? 4
                                              : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // Longer than needed, a surrogate, or beyond the last code point.
  const bool wrong = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) > 0x9f) ||
                     (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f);
  return wrong ? 0 : length;
}

/// yaml-cpp replaces what is not UTF-8, and its positions then no longer fit the text.
bool IsUtf8(std::string_view text, int& line) {
  line = 1;
  while (!text.empty()) {
    const std::size_t length = SequenceLength(text);
    if (length == 0) return false;
    if (text[0] == '\n') ++line;
    text.remove_prefix(length);
  }
  return true;
}

/// yaml-cpp recurses a level; brackets that open deeper than any sane file are refused before.
bool NestsTooDeep(std::string_view text, int& line) {
  int depth = 0;
  line = 1;
  std::size_t dashes = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == '-' || c == '?' || c == ':') ++dashes;
    if (c != '-' && c != '?' && c != ':' && c != ' ') dashes = 0;
    if (c == '\n') ++line;
    if (depth > 4 * kDeepestYaml || dashes > 4 * kDeepestYaml) return true;
  }
  return false;
}

/// The brace of an unquoted `${...}` ends a map in braces: the commonest slip of all.
std::string Advice(std::string_view text, const YAML::Mark& mark) {
  const auto at = std::min(static_cast<std::size_t>(std::max(mark.pos, 0)), text.size());
  const auto line_end = text.substr(0, at).rfind('\n');
  const auto start = line_end == std::string_view::npos ? 0 : line_end + 1;
  const bool expression = text.substr(start, text.find('\n', at) - start).find("${") != text.npos;
  return expression ? "; inside {} and [] an expression needs quotes: \"${...}\"" : "";
}

}  // namespace

Value ReadYaml(std::string_view text, const std::string& name, Problems& problems) {
  const auto shared_name = std::make_shared<const std::string>(name);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  int line = 0;
  if (!IsUtf8(text, line)) {
    problems.Add({shared_name, line, 1}, "is not UTF-8; expected text");
    return {};
  }
  if (NestsTooDeep(text, line)) {
    problems.Add({shared_name, line, 1}, fmt::format("nested deeper than {} levels", kDeepestYaml));
    return {};
  }
  TreeBuilder builder(text, shared_name, problems);
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    problems.Add({shared_name, error.mark.line + 1, error.mark.column + 1},
                 error.msg + Advice(text, error.mark));
  }
  return builder.Take();
}

std::string ReadTextFile(const std::filesystem::path& file) {
  try {
    models::NoteOpened(file);
  } catch (const models::ModelError& refused) {
    throw ConfigError(refused.what());
  }
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw ConfigError(fmt::format("{}: error: is a folder; expected a file", file.string()));
  }
  const auto size = std::filesystem::file_size(file, error);
  if (error) {
    throw ConfigError(fmt::format("{}: error: cannot be read: {}", file.string(), error.message()));
  }
  if (size > kLargestFile) {
    throw ConfigError(fmt::format("{}: error: got {} bytes; expected at most {}", file.string(),
                                  size, kLargestFile));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(size, '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(size))) {
    throw ConfigError(fmt::format("{}: error: cannot be read", file.string()));
  }
  const auto control = [](unsigned char c) {
    return (c < 0x20 && c != '\n' && c != '\r' && c != '\t') || c == 0x7f;
  };
  if (std::any_of(text.begin(), text.end(), control)) {
    throw ConfigError(
        fmt::format("{}: error: holds control characters; expected a text file", file.string()));
  }
  return text;
}

}  // namespace oca::files
