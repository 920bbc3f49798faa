// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/yaml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "oca/diagrams/files/plain_scalar.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/yaml_events.h"

namespace oca::files {
namespace {

using models::internal::kDeepestYaml;
using models::internal::YamlError;
using models::internal::YamlMark;

/// Maps are searched key by key, so their size is limited.
constexpr std::size_t kMostKeys = 5000;
constexpr std::size_t kMostProblems = 50;

/// Builds the tree.
class TreeBuilder final : public models::internal::YamlEvents {
 public:
  TreeBuilder(std::string_view text, std::shared_ptr<const std::string> name, Problems& problems)
      : text_(text), name_(std::move(name)), problems_(problems) {}

  Value Take() { return std::move(root_); }

  void OnNull(const YamlMark& mark, std::size_t /*anchor*/) override {
    if (stack_.empty()) return;  // an empty file: the reader of the tree says what it misses
    problems_.Add(At(mark), stack_.back().has_key
                                ? fmt::format("{}: no value; expected one", stack_.back().key)
                                : std::string("an item without a value"));
    Put(Value({}, At(mark)));
  }
  void OnAlias(const YamlMark& mark, std::size_t /*anchor*/) override {
    problems_.Add(At(mark), "an alias; expected a value (parameters and ${name} serve repetition)");
    Put(Value({}, At(mark)));
  }
  void OnScalar(const Node& node, const std::string& value) override {
    CheckPlainNode(node);
    const YamlMark& mark = node.mark;
    const bool quoted = node.tag == "!";
    if (quoted) CheckClosed(mark);
    if (ExpectsKey()) return TakeKey(mark, value);
    std::string problem;
    Value::Data data = quoted ? Value::Data(value) : ReadPlainScalar(value, problem);
    if (!problem.empty()) problems_.Add(At(mark), Here() + problem);
    Put(Value(std::move(data), At(mark)));
  }
  void OnListStart(const Node& node) override { Open(node, Value::List()); }
  void OnListEnd() override { Close(); }
  void OnMapStart(const Node& node) override { Open(node, Value::Map()); }
  void OnMapEnd() override { Close(); }

 private:
  struct Frame {
    Value value;
    std::string key{};
    Location key_location{};
    bool has_key{false};
    bool drop{false};  // a map as a key: its contents go nowhere
  };

  Location At(const YamlMark& mark) const { return {name_, mark.line, mark.column}; }
  std::string Here() const {
    return !stack_.empty() && stack_.back().has_key ? stack_.back().key + ": " : "";
  }
  bool ExpectsKey() const {
    return !stack_.empty() && stack_.back().value.map() != nullptr && !stack_.back().has_key;
  }

  void CheckPlainNode(const Node& node) {
    const auto& [mark, tag, anchor] = node;
    if (anchor != 0) problems_.Add(At(mark), "an anchor; expected a value without one");
    // yaml-cpp gives quoted text the tag "!" too.
    const std::size_t at = mark.offset;
    const bool written = at < text_.size() && text_[at] == '!';
    if (written || (!tag.empty() && tag != "?" && tag != "!")) {
      problems_.Add(At(mark), fmt::format("the tag '{}'; expected a value without one", tag));
    }
    if (problems_.all().size() >= kMostProblems) {
      throw YamlError(mark, "too many problems; the rest of the file is not read");
    }
  }

  /// yaml-cpp takes the end of the file for a closing quote.
  void CheckClosed(const YamlMark& mark) {
    std::size_t i = mark.offset;
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

  void TakeKey(const YamlMark& mark, const std::string& key) {
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
      throw YamlError(mark, fmt::format("more than {} keys in one map", kMostKeys));
    }
  }

  void Open(const Node& node, Value::Data data) {
    CheckPlainNode(node);
    const YamlMark& mark = node.mark;
    if (stack_.size() >= kDeepestYaml) {
      throw YamlError(mark, fmt::format("nested deeper than {} levels", kDeepestYaml));
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
};

/// The brace of an unquoted `${...}` ends a map in braces: the commonest slip of all.
std::string Advice(std::string_view text, const YamlMark& mark) {
  const auto at = std::min(mark.offset, text.size());
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
  TreeBuilder builder(text, shared_name, problems);
  try {
    models::internal::ReadYamlEvents(text, builder);
  } catch (const YamlError& error) {
    problems.Add({shared_name, error.mark.line, error.mark.column},
                 error.what() + Advice(text, error.mark));
  }
  return builder.Take();
}

std::string ReadTextFile(const std::filesystem::path& file) {
  std::string text;
  try {
    text = models::ReadFile(file, kLargestFile);
  } catch (const models::ModelError& error) {
    const std::string place = file.string() + ": ", what = error.what();
    throw ConfigError(what.starts_with(place) ? place + "error: " + what.substr(place.size())
                                              : what);
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
