// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/foreign_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/geometry/rotation.h"
#include "oca/models/table_text.h"
#include "oca/models/yaml_events.h"

namespace oca::scenes::internal {
namespace {

using models::internal::YamlError;
using models::internal::YamlMark;
using Kind = ForeignValue::Kind;

/// Builds the tree.
class ForeignBuilder final : public models::internal::YamlEvents {
 public:
  ForeignValue Take() { return std::move(root_); }

  void OnNull(const YamlMark& mark, std::size_t /*anchor*/) override {
    Put({Kind::kNull, false, mark.line}, mark);
  }
  void OnAlias(const YamlMark& mark, std::size_t /*anchor*/) override {
    throw YamlError(mark, "an alias; expected the value itself");
  }
  void OnScalar(const Node& node, const std::string& value) override {
    const bool quoted = node.tag == "!";
    if (!quoted && (value == "~" || value == "null")) return OnNull(node.mark, 0);
    Put({Kind::kScalar, quoted, node.mark.line, value}, node.mark);
  }
  void OnListStart(const Node& node) override { Open(node.mark, Kind::kList); }
  void OnListEnd() override { Close(); }
  void OnMapStart(const Node& node) override { Open(node.mark, Kind::kMap); }
  void OnMapEnd() override { Close(); }

 private:
  struct Frame {
    ForeignValue value;
    bool keyed{false};
  };

  void Open(const YamlMark& mark, Kind kind) {
    if (stack_.size() >= static_cast<std::size_t>(models::internal::kDeepestYaml)) {
      throw YamlError(mark,
                      fmt::format("nested deeper than {} levels", models::internal::kDeepestYaml));
    }
    if (ExpectsKey()) throw YamlError(mark, "a key that is a list or a map; expected a name");
    stack_.push_back({{kind, false, mark.line}});
  }

  bool ExpectsKey() const {
    return !stack_.empty() && stack_.back().value.kind == Kind::kMap && !stack_.back().keyed;
  }

  void Close() {
    ForeignValue value = std::move(stack_.back().value);
    stack_.pop_back();
    const int line = value.line;
    Put(std::move(value), {line});
  }

  void Put(ForeignValue value, const YamlMark& mark) {
    if (++nodes_ > kMostNodes) {
      throw YamlError(mark, fmt::format("more than {} values", kMostNodes));
    }
    if (stack_.empty()) {
      root_ = std::move(value);
      return;
    }
    Frame& frame = stack_.back();
    if (ExpectsKey()) return TakeKey(frame, value, mark);
    frame.keyed = false;
    frame.value.items.push_back(std::move(value));
  }

  static void TakeKey(Frame& frame, const ForeignValue& key, const YamlMark& mark) {
    auto& keys = frame.value.keys;
    if (std::find(keys.begin(), keys.end(), key.text) != keys.end()) {
      throw YamlError(mark, fmt::format("key '{}'; got it twice; expected it once",
                                        models::internal::Shown(key.text)));
    }
    if (keys.size() >= kMostKeys) {
      throw YamlError(mark, fmt::format("more than {} keys in one map", kMostKeys));
    }
    keys.push_back(key.text);
    frame.keyed = true;
  }

  std::vector<Frame> stack_;
  ForeignValue root_;
  std::size_t nodes_{0};
};

std::string Joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

}  // namespace

ForeignValue ReadForeignYaml(const std::filesystem::path& file) {
  ForeignBuilder builder;
  try {
    models::internal::ReadYamlEvents(models::ReadFile(file, kLargestScene), builder);
  } catch (const YamlError& error) {
    throw models::ModelError(
        fmt::format("{}:{}: {}", file.string(), error.mark.line, error.what()));
  }
  return builder.Take();
}

std::string Foreign::where() const { return fmt::format("{}:{}", *file_, value_->line); }

void Foreign::Refuse(std::string_view got, std::string_view expected) const {
  throw models::ModelError(fmt::format("{}: {}; got {}; expected {}", where(),
                                       path_.empty() ? "the file" : path_, got, expected));
}

std::string Foreign::Shown() const {
  switch (value_->kind) {
    case Kind::kNull:
      return "nothing";
    case Kind::kList:
      return fmt::format("a list of {}", size());
    case Kind::kMap:
      return "a map";
    case Kind::kScalar:
      break;
  }
  return fmt::format("'{}'", models::internal::Shown(value_->text));
}

void Foreign::CheckMap() const {
  if (!is_map()) Refuse("a map");
}

std::optional<Foreign> Foreign::Find(std::string_view key) const {
  CheckMap();
  const auto found = std::find(value_->keys.begin(), value_->keys.end(), key);
  if (found == value_->keys.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(found - value_->keys.begin());
  if (value_->items[i].kind == Kind::kNull) return std::nullopt;
  return Child(i, Joined(path_, key));
}

Foreign Foreign::Get(std::string_view key) const {
  const auto found = Find(key);
  if (found) return *found;
  throw models::ModelError(
      fmt::format("{}: {}; got none; expected one", where(), Joined(path_, key)));
}

std::vector<Foreign> Foreign::Items() const {
  if (!is_list()) Refuse("a list");
  std::vector<Foreign> items;
  for (std::size_t i = 0; i < size(); ++i) {
    items.push_back(Child(i, fmt::format("{}[{}]", path_, i)));
  }
  return items;
}

std::vector<Foreign> Foreign::Items(std::string_view key) const {
  const auto list = Find(key);
  return list ? list->Items() : std::vector<Foreign>();
}

std::vector<std::string> Foreign::Unknown(std::initializer_list<std::string_view> known) const {
  CheckMap();
  std::vector<std::string> unknown;
  for (std::size_t i = 0; i < size(); ++i) {
    if (std::find(known.begin(), known.end(), value_->keys[i]) != known.end()) continue;
    unknown.push_back(fmt::format("{}:{}: {}", *file_, value_->items[i].line,
                                  models::internal::Shown(Joined(path_, value_->keys[i]))));
  }
  return unknown;
}

double Foreign::Number() const {
  const auto number = is_scalar() && !value_->quoted ? models::internal::ToNumber(value_->text)
                                                     : std::optional<double>();
  if (!number || !std::isfinite(*number)) Refuse("a finite number");
  return *number;
}

std::vector<double> Foreign::Numbers() const {
  if (!is_list()) Refuse("a list of numbers");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < size(); ++i) {
    numbers.push_back(Child(i, fmt::format("{}[{}]", path_, i)).Number());
  }
  return numbers;
}

std::vector<double> Foreign::Numbers(std::string_view key) const {
  const auto list = Find(key);
  return list ? list->Numbers() : std::vector<double>();
}

std::size_t Foreign::Count(std::size_t most) const {
  const auto count = is_scalar() && !value_->quoted ? models::internal::ToCount(value_->text, most)
                                                    : std::optional<std::uint64_t>();
  if (!count) Refuse(fmt::format("a whole number up to {}", most));
  return *count;
}

bool Foreign::Bool() const {
  if (is_scalar()) {
    for (const char* yes : {"true", "True", "TRUE", "1"}) {
      if (value_->text == yes) return true;
    }
    for (const char* no : {"false", "False", "FALSE", "0"}) {
      if (value_->text == no) return false;
    }
  }
  Refuse("true or false");
}

std::string Foreign::Text() const {
  if (!is_scalar()) Refuse("a text");
  return value_->text;
}

std::string Foreign::Text(std::string_view key) const {
  const auto text = Find(key);
  return text ? text->Text() : "";
}

std::vector<std::string> Foreign::Texts(std::string_view key) const {
  std::vector<std::string> texts;
  for (const Foreign& item : Items(key)) texts.push_back(item.Text());
  return texts;
}

std::vector<double> Foreign::Components(std::initializer_list<std::string_view> names) const {
  std::vector<double> numbers;
  if (is_map()) {
    for (const std::string_view name : names) numbers.push_back(Get(name).Number());
    return numbers;
  }
  numbers = Numbers();
  if (numbers.size() != names.size()) {
    Refuse(fmt::format("{} numbers", numbers.size()), fmt::format("{}", names.size()));
  }
  return numbers;
}

Eigen::Vector3d Foreign::Vector() const {
  const auto xyz = Components({"x", "y", "z"});
  return {xyz[0], xyz[1], xyz[2]};
}

Eigen::Quaterniond Foreign::Rotation() const {
  const auto xyzw = Components({"x", "y", "z", "w"});
  return geometry::FromQuaternion({xyzw[0], xyzw[1], xyzw[2], xyzw[3]}, where() + ": " + path_);
}

Eigen::Isometry3d Foreign::Pose() const {
  CheckMap();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (const char* key : {"position", "translation"}) {
    if (const auto position = Find(key)) X.translation() = position->Vector();
  }
  for (const char* key : {"orientation", "rotation"}) {
    if (const auto rotation = Find(key)) X.linear() = rotation->Rotation().toRotationMatrix();
  }
  return X;
}

}  // namespace oca::scenes::internal
