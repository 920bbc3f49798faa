// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/files/yaml_reader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/file_cache.h"
#include "oca/models/opened_files.h"

namespace oca::files {
namespace {

namespace fs = std::filesystem;

/// A file as it was read, by itself or with all that it includes.
struct ReadDocument {
  Value root;
  Problems problems;
  DocumentSources sources;
};

ReadDocument ReadFile(const fs::path& file) {
  ReadDocument read;
  read.root = ReadYaml(ReadTextFile(file), file.string(), read.problems);
  return read;
}

/// A file by the way that led to it, for what it names in turn lies from there: a link to it or to
/// a folder above is not followed. In short, if that is the same file.
fs::path AsReached(const fs::path& file) {
  const fs::path plain = models::PlainPath(file);
  std::error_code error;
  return fs::equivalent(plain, file, error) ? plain : fs::absolute(file, error);
}

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

/// Parameters that are texts, which may choose files; the first one of a name wins.
using Texts = std::vector<std::pair<std::string, std::string>>;

Texts TextsOf(const std::vector<Override>& overrides) {
  constexpr std::string_view kParameters = "parameters.";
  Texts texts;
  for (const Override& change : overrides) {
    if (!change.path.starts_with(kParameters)) continue;
    Problems ignored;  // Apply reports them
    const Value value = change.Read(ignored);
    if (value.string() == nullptr) continue;
    const std::string name = change.path.substr(kParameters.size());
    std::erase_if(texts, [&](const auto& text) { return text.first == name; });  // the last counts
    texts.emplace_back(name, *value.string());
  }
  return texts;
}

/// Texts among the parameters of a file or that it is given, behind those that win over them.
void AddTexts(const Value* parameters, Texts& texts) {
  if (parameters == nullptr || parameters->map() == nullptr) return;
  for (const Value::Entry& entry : *parameters->map()) {
    if (entry.value.string() != nullptr) texts.emplace_back(entry.key, *entry.value.string());
  }
}

class Includer {
 public:
  Includer(Texts texts, Problems& problems) : problems_(problems), texts_(std::move(texts)) {}

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
    AddSource(AsReached(file));
    if (choices_ > 0) sources_.chosen.insert(file.string());
    Value value;
    try {
      const auto read =
          models::ReadOnce<ReadDocument>(file, "YAML", [&] { return ReadFile(file); });
      value = read->root;
      problems_.Add(read->problems);
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
      if (at->path().extension() == ".yaml") found.push_back(AsReached(at->path()));
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

  /// Empty, with a problem, if it is of a package that is nowhere.
  fs::path PathOf(const std::string& name, const fs::path& folder, const Location& location) {
    try {
      return ResolvePath(name, folder, {});
    } catch (const ConfigError& error) {
      problems_.Add(location, fmt::format("include: {}", error.what()));
      return {};
    }
  }

  Value Expand(Value value, const fs::path& folder) {
    if (value.map() == nullptr) return value;
    AddTexts(value.Find("parameters"), texts_);
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
        if (item.string() == nullptr || item.string()->empty()) {
          problems_.Add(item.location(),
                        fmt::format("include: got {}; expected a file name", item.Show()));
          continue;
        }
        const std::string name = FileName(*item.string(), item.location());
        if (name.empty()) continue;
        const fs::path file = PathOf(name, folder, item.location());
        if (file.empty()) continue;
        const bool choice = name != *item.string();
        choices_ += choice ? 1 : 0;
        Value included = Load(file, item.location());
        choices_ -= choice ? 1 : 0;
        if (choice) {
          AddCandidates(file.parent_path(), fs::path(*item.string()).filename());
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
  Texts texts_;
  DocumentSources sources_;
  int files_{0};
  int choices_{0};  // that led to the file at hand
};

}  // namespace

MergedFiles LoadFiles(const fs::path& file, const std::vector<Override>& overrides,
                      Problems& problems, const Value* parameters) {
  if (file.empty()) throw ConfigError("diagram: got an empty file name; expected a path");
  Texts texts = TextsOf(overrides);
  AddTexts(parameters, texts);
  std::string form = "with includes";
  for (const auto& [name, text] : texts) {
    form.append(1, '\0').append(name).append(1, '\0').append(text);
  }
  const auto read = models::MakeOnce<ReadDocument>(file, form, [&] {
    ReadDocument merged;
    Includer includer(texts, merged.problems);
    merged.root = includer.Load(file, {});
    merged.sources = includer.sources();
    return merged;
  });
  problems.Add(read->problems);
  const Value& root = read->root;
  if (root.map() == nullptr && problems.empty()) {
    problems.Add({std::make_shared<const std::string>(file.string()), 1, 1},
                 root.null() ? "is empty; expected a map with systems"
                             : fmt::format("got {}; expected a map with systems", root.Show()));
  }
  return {root, {read, &read->sources}};
}

}  // namespace oca::files
