// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <utility>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/yaml_reader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::files {
namespace {

namespace fs = std::filesystem;

/// What a file includes by two ways counts once.
void AddOnce(Value::List& list, Value item) {
  const std::string place = item.location().ToString();
  const bool there = std::any_of(list.begin(), list.end(), [&](const Value& other) {
    return other.location().ToString() == place;
  });
  if (!there) list.push_back(std::move(item));
}

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
      for (Value& item : *entry.value.list()) AddOnce(*same->value.list(), std::move(item));
    } else {
      Merge(same->value, std::move(entry.value));
    }
  }
}

class Includer {
 public:
  Includer(const std::vector<Override>& overrides, Problems& problems) : problems_(problems) {
    constexpr std::string_view kParameters = "parameters.";
    for (const Override& change : overrides) {
      if (!change.path.starts_with(kParameters)) continue;
      Problems ignored;  // Apply reports them
      const Value value = ReadYaml(change.value, "-s " + change.path, ignored);
      if (value.string() == nullptr) continue;
      const std::string name = change.path.substr(kParameters.size());
      std::erase_if(texts_,
                    [&](const auto& text) { return text.first == name; });  // the last counts
      texts_.emplace_back(name, *value.string());
    }
  }

  Value Load(const fs::path& file, const Location& from) {
    std::error_code ignored;
    const fs::path canonical = fs::weakly_canonical(file, ignored);
    if (std::find(open_.begin(), open_.end(), canonical) != open_.end()) {
      problems_.Add(from, fmt::format("include: {} includes itself", file.string()));
      return {};
    }
    if (++files_ > kMostFiles) {
      if (files_ == kMostFiles + 1) {
        problems_.Add(from, fmt::format("include: more than {} files", kMostFiles));
      }
      return {};
    }
    open_.push_back(canonical);
    AddSource(canonical);
    if (choices_ > 0) sources_.chosen.insert(file.string());
    Value value;
    try {
      value = ReadYaml(ReadTextFile(file), file.string(), problems_);
    } catch (const ConfigError& error) {
      if (from.line == 0) throw;
      problems_.Add(from, fmt::format("include: {}{}", error.what(), Kin(file)));
    }
    Value merged = Expand(std::move(value), file.parent_path());
    open_.pop_back();
    return merged;
  }

  const DocumentSources& sources() const { return sources_; }

 private:
  void AddSource(const fs::path& file) {
    auto& files = sources_.files;
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }

  /// What there is in place of a file that is not there: those of its folder whose names begin
  /// alike, up to the first underscore, as methods of avoidance do.
  static std::string Kin(const fs::path& file) {
    const std::string name = file.filename().string();
    std::error_code error;
    const std::size_t end = name.find('_');
    if (fs::exists(file, error) || end == std::string::npos) return "";
    std::vector<std::string> kin;
    for (fs::directory_iterator at(file.parent_path(), error), last; !error && at != last;
         at.increment(error)) {
      const std::string other = at->path().filename().string();
      if (other.starts_with(name.substr(0, end + 1)) && other.ends_with(".yaml")) {
        kin.push_back(other);
      }
    }
    std::sort(kin.begin(), kin.end());
    return kin.empty() ? "" : fmt::format("; expected one of {}", fmt::join(kin, ", "));
  }

  /// Every diagram file of a folder; those that fit `pattern`, the name of one with `${...}` in it,
  /// are alternatives.
  void AddCandidates(const fs::path& folder, const std::string& pattern) {
    std::error_code error;
    std::vector<fs::path> found;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      if (at->path().extension() == ".yaml") found.push_back(fs::weakly_canonical(at->path()));
    }
    std::sort(found.begin(), found.end());
    const std::string head = pattern.substr(0, pattern.find("${"));
    const std::string tail = pattern.substr(pattern.rfind('}') + 1);
    for (const fs::path& file : found) {
      sources_.candidates.push_back(file);
      const std::string name = file.filename().string();
      if (head == pattern || !name.starts_with(head) || !name.ends_with(tail)) continue;
      sources_.alternatives.push_back(file);
    }
  }

  /// Texts among the parameters of a file, behind those that win over them.
  void AddTexts(const Value& file) {
    const Value* const parameters = file.Find("parameters");
    if (parameters == nullptr || parameters->map() == nullptr) return;
    for (const Value::Entry& entry : *parameters->map()) {
      if (entry.value.string() != nullptr) texts_.emplace_back(entry.key, *entry.value.string());
    }
  }

  /// The file name with each `${name}` replaced by that parameter; empty, with a problem, if it is
  /// no text. Includes come before arithmetic, so nothing else may stand in the braces.
  std::string FileName(const std::string& text, const Location& location) {
    std::string name;
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t open = std::min(text.find("${", from), text.size());
      name += text.substr(from, open - from);
      if (open == text.size()) break;
      const std::size_t close = text.find('}', open);
      if (close == std::string::npos) {
        problems_.Add(location,
                      fmt::format("include: got '{}'; expected a '}}' after '${{'", text));
        return {};
      }
      const std::string key = text.substr(open + 2, close - open - 2);
      const auto found = std::find_if(texts_.begin(), texts_.end(),
                                      [&](const auto& entry) { return entry.first == key; });
      if (found == texts_.end()) {
        std::vector<std::string> known;
        for (const auto& entry : texts_) known.push_back(entry.first);
        problems_.Add(location, fmt::format("include: {}: no parameter '{}' that is a text{}", text,
                                            key, DidYouMean(key, known)));
        return {};
      }
      name += found->second;
      sources_.choosing.push_back(key);
      from = close + 1;
    }
    return name;
  }

  Value Expand(Value value, const fs::path& folder) {
    if (value.map() == nullptr) return value;
    AddTexts(value);
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
        const std::string name = FileName(*item.string(), item.location());
        if (name.empty()) continue;
        const bool choice = name != *item.string();
        choices_ += choice ? 1 : 0;
        Value included = Load(folder / name, item.location());
        choices_ -= choice ? 1 : 0;
        if (choice) {
          AddCandidates((folder / name).parent_path(), fs::path(*item.string()).filename());
        }
        if (included.map() != nullptr) {
          Merge(base, std::move(included));
        } else if (!included.null()) {
          problems_.Add(item.location(), fmt::format("include: {}: got {}; expected a map",
                                                     *item.string(), included.Show()));
        }
      }
    }
    Merge(base, Value(std::move(own), value.location()));
    return base;
  }

  Problems& problems_;
  static constexpr int kMostFiles = 200;
  std::vector<fs::path> open_;
  std::vector<std::pair<std::string, std::string>> texts_;  // parameters; the first one wins
  DocumentSources sources_;
  int files_{0};
  int choices_{0};  // that led to the file at hand
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

/// Follows the path of an override into the tree.
class Path {
 public:
  Path(const std::string& path, const Location& location, Problems& problems)
      : keys_(SplitPath(path)), location_(location), problems_(problems) {}

  /// What the path leads to, made where it may be; nullptr, with a problem, if it leads nowhere.
  Value* Follow(Value& root) {
    Value* at = &root;
    while (at != nullptr && depth_ < keys_.size()) {
      at = at->list() != nullptr ? Item(*at->list()) : Child(*at);
    }
    return at;
  }

 private:
  Value* Item(Value::List& list) {
    const std::string& key = keys_[depth_++];
    std::size_t index = 0;
    const char* const last = key.data() + key.size();
    const auto [end, error] = std::from_chars(key.data(), last, index);
    if (error == std::errc() && end == last && index < list.size()) return &list[index];
    problems_.Add(location_, fmt::format("got '{}'; expected an index below {}", key, list.size()));
    return nullptr;
  }

  Value* Child(Value& parent) {
    Value::Map* const map = parent.map();
    if (map == nullptr) {
      problems_.Add(location_, fmt::format("'{}' lies below {}; expected a key of a map",
                                           keys_[depth_], parent.Show()));
      return nullptr;
    }
    // A key may hold dots itself: the longest that fits.
    for (std::size_t end = keys_.size(); end > depth_; --end) {
      const std::string key =
          fmt::format("{}", fmt::join(keys_.begin() + static_cast<std::ptrdiff_t>(depth_),
                                      keys_.begin() + static_cast<std::ptrdiff_t>(end), "."));
      for (Value::Entry& entry : *map) {
        if (entry.key != key) continue;
        depth_ = end;
        return &entry.value;
      }
    }
    return MayBeMade(parent) ? Make(*map) : nullptr;
  }

  /// A key that the file leaves at its default may be set; the reader of the tree knows whether it
  /// exists. Names that only the file gives must be there.
  bool MayBeMade(const Value& parent) {
    const std::string& key = keys_[depth_];
    std::vector<std::string> known;
    if (depth_ == 0) {
      for (const Section& section : Sections()) known.emplace_back(section.key);
      if (std::find(known.begin(), known.end(), key) != known.end()) return true;
    } else {
      const bool named_by_file =
          keys_[0] == "parameters" || keys_[0] == "systems" || keys_[0] == "models";
      if (depth_ > 1 || !named_by_file) return true;
      known = KeysOf(parent);
    }
    problems_.Add(location_, fmt::format("no '{}' there{}", key, DidYouMean(key, known)));
    return false;
  }

  Value* Make(Value::Map& map) {
    const std::string& key = keys_[depth_++];
    Value::Data data;
    if (depth_ < keys_.size()) data = Value::Map{};
    map.push_back({key, location_, Value(std::move(data), location_)});
    return &map.back().value;
  }

  const std::vector<std::string> keys_;
  const Location& location_;
  Problems& problems_;
  std::size_t depth_{0};
};

void Apply(const Override& change, Value& root, Problems& problems) {
  const std::string name = "-s " + change.path;
  const Location location{std::make_shared<const std::string>(name), 0, 0};
  if (change.path == "include" || change.path.starts_with("include.")) {
    problems.Add(location, "include: cannot be overridden; expected another path");
    return;
  }
  Problems syntax;
  Value value = ReadYaml(change.value, name, syntax);
  if (syntax.empty() && value.null()) {
    syntax.Add(location, fmt::format("got '{}'; expected a YAML value", change.value));
  }
  problems.Add(syntax);
  if (!syntax.empty()) return;
  if (Value* const at = Path(change.path, location, problems).Follow(root)) *at = std::move(value);
}

}  // namespace

Override Override::Parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigError(fmt::format("-s: got '{}'; expected PATH=VALUE", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Value LoadFiles(const fs::path& file, const std::vector<Override>& overrides, Problems& problems,
                DocumentSources* sources) {
  Includer includer(overrides, problems);
  Value root = includer.Load(file, {});
  if (sources != nullptr) *sources = includer.sources();
  if (root.map() == nullptr && problems.empty()) {
    problems.Add({std::make_shared<const std::string>(file.string()), 1, 1},
                 root.null() ? "is empty; expected a map with systems"
                             : fmt::format("got {}; expected a map with systems", root.Show()));
  }
  return root;
}

void ApplyOverrides(const std::vector<Override>& overrides, Value& root, Problems& problems) {
  for (const Override& change : overrides) Apply(change, root, problems);
}

Value LoadDocument(const fs::path& file, const std::vector<Override>& overrides, Problems& problems,
                   DocumentSources* sources) {
  Value root = LoadFiles(file, overrides, problems, sources);
  if (problems.empty()) ApplyOverrides(overrides, root, problems);
  return root;
}

}  // namespace oca::files
