// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <utility>

#include "diagrams/yaml_reader.h"
#include "framework/error.h"
#include "framework/nearest.h"

namespace oca::diagrams {
namespace {

namespace fs = std::filesystem;

/// `over` wins; lists named `connections` are joined.
void Merge(Value& base, Value over) {
  Value::Map* const into = base.map();
  if (into == nullptr || over.map() == nullptr) {
    base = std::move(over);
    return;
  }
  for (Value::Entry& entry : *over.map()) {
    const auto same = std::find_if(into->begin(), into->end(),
                                   [&](const auto& other) { return other.key == entry.key; });
    if (same == into->end()) {
      into->push_back(std::move(entry));
    } else if (entry.key == "connections" && same->value.list() != nullptr &&
               entry.value.list() != nullptr) {
      for (Value& item : *entry.value.list()) same->value.list()->push_back(std::move(item));
    } else {
      Merge(same->value, std::move(entry.value));
    }
  }
}

class Includer {
 public:
  explicit Includer(Problems& problems) : problems_(problems) {}

  Value Load(const fs::path& file, const Location& from) {
    std::error_code ignored;
    const fs::path canonical = fs::weakly_canonical(file, ignored);
    if (std::find(open_.begin(), open_.end(), canonical) != open_.end()) {
      problems_.Add(from, fmt::format("include: {} includes itself", file.string()));
      return {};
    }
    open_.push_back(canonical);
    Value value;
    try {
      value = ReadYaml(ReadTextFile(file), file.string(), problems_);
    } catch (const ConfigError& error) {
      if (from.line == 0) throw;
      problems_.Add(from, fmt::format("include: {}", error.what()));
    }
    Value merged = Expand(std::move(value), file.parent_path());
    open_.pop_back();
    return merged;
  }

 private:
  Value Expand(Value value, const fs::path& folder) {
    if (value.map() == nullptr) return value;
    Value::Map own;
    Value base(Value::Map{}, value.location());
    for (Value::Entry& entry : *value.map()) {
      if (entry.key != "include") {
        own.push_back(std::move(entry));
        continue;
      }
      if (entry.value.list() == nullptr) {
        problems_.Add(entry.value.location(),
                      fmt::format("include: got {}; expected a list of files", entry.value.Show()));
        continue;
      }
      for (const Value& item : *entry.value.list()) {
        if (item.string() == nullptr) {
          problems_.Add(item.location(),
                        fmt::format("include: got {}; expected a file name", item.Show()));
          continue;
        }
        Value included = Load(folder / *item.string(), item.location());
        if (included.map() != nullptr) Merge(base, std::move(included));
      }
    }
    Merge(base, Value(std::move(own), value.location()));
    return base;
  }

  Problems& problems_;
  std::vector<fs::path> open_;
};

std::vector<std::string> SplitPath(const std::string& path) {
  std::vector<std::string> keys;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t dot = std::min(path.find('.', from), path.size());
    keys.push_back(path.substr(from, dot - from));
    from = dot + 1;
  }
  return keys;
}

std::vector<std::string> KeysOf(const Value& value) {
  std::vector<std::string> keys;
  if (value.map() != nullptr) {
    for (const Value::Entry& entry : *value.map()) keys.push_back(entry.key);
  }
  return keys;
}

/// The child named `key`; nullptr, with a problem, if there is none and none may be made.
Value* Descend(Value& parent, const std::vector<std::string>& keys, std::size_t depth,
               const Location& location, Problems& problems) {
  const std::string& key = keys[depth];
  if (Value::List* const list = parent.list()) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error == std::errc() && end == key.data() + key.size() && index < list->size()) {
      return &(*list)[index];
    }
    problems.Add(location, fmt::format("got '{}'; expected an index below {}", key, list->size()));
    return nullptr;
  }
  Value::Map* const map = parent.map();
  if (map == nullptr) {
    problems.Add(location,
                 fmt::format("'{}' lies below {}; expected a key of a map", key, parent.Show()));
    return nullptr;
  }
  const auto found =
      std::find_if(map->begin(), map->end(), [&](const auto& entry) { return entry.key == key; });
  if (found != map->end()) return &found->value;
  // A key that the file leaves at its default may be set; the reader of the tree knows whether it
  // exists. Names that only the file gives must be there.
  const bool named_by_file =
      depth == 1 && (keys[0] == "parameters" || keys[0] == "systems" || keys[0] == "models");
  if (named_by_file || depth + 1 < keys.size()) {
    const bool section = depth == 0 && (key == "simulator" || key == "record");
    if (!section) {
      problems.Add(location, fmt::format("no '{}' there{}", key, DidYouMean(key, KeysOf(parent))));
      return nullptr;
    }
  }
  map->push_back({key, location,
                  depth + 1 < keys.size() ? Value(Value::Map{}, location) : Value({}, location)});
  return &map->back().value;
}

void Apply(const Override& change, Value& root, Problems& problems) {
  const Location location{std::make_shared<const std::string>("-s " + change.path), 0, 0};
  Problems syntax;
  Value value = ReadYaml(change.value, "-s " + change.path, syntax);
  if (!syntax.empty() || value.null()) {
    problems.Add(location, fmt::format("got '{}'; expected a YAML value", change.value));
    return;
  }
  const std::vector<std::string> keys = SplitPath(change.path);
  Value* at = &root;
  for (std::size_t depth = 0; depth < keys.size() && at != nullptr; ++depth) {
    at = Descend(*at, keys, depth, location, problems);
  }
  if (at != nullptr) *at = std::move(value);
}

}  // namespace

Override Override::Parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigError(fmt::format("-s: got '{}'; expected PATH=VALUE", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Value LoadDocument(const fs::path& file, const std::vector<Override>& overrides,
                   Problems& problems) {
  Value root = Includer(problems).Load(file, {});
  if (root.map() == nullptr && problems.empty()) {
    problems.Add({std::make_shared<const std::string>(file.string()), 1, 1},
                 root.null() ? "is empty; expected a map with systems"
                             : fmt::format("got {}; expected a map with systems", root.Show()));
  }
  if (!problems.empty()) return root;
  for (const Override& change : overrides) Apply(change, root, problems);
  return root;
}

}  // namespace oca::diagrams
