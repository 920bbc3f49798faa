// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/override.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <iterator>
#include <memory>
#include <utility>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/plain_scalar.h"
#include "oca/diagrams/files/yaml_reader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::files {
namespace {

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

/// The sections whose entries the file names.
constexpr const char* kNamedByFile[] = {"parameters", "systems", "models"};

/// What a first key that is none may have been meant as: the entry of a section that is called so,
/// else one of `known` or an entry that is near; if nothing is, what is known.
std::string MeantBy(const std::string& key, const Value& root,
                    const std::vector<std::string>& known) {
  std::string near = DidYouMean(key, known);
  for (const std::string section : kNamedByFile) {
    const Value* const entries = root.Find(section);
    if (entries == nullptr) continue;
    const std::vector<std::string> names = KeysOf(*entries);
    if (std::find(names.begin(), names.end(), key) != names.end()) {
      return fmt::format("; did you mean '{}.{}'?", section, key);
    }
    if (!near.empty()) continue;
    near = DidYouMean(key, names);
    if (!near.empty()) near.insert(near.find('\'') + 1, section + ".");
  }
  if (!near.empty()) return near;
  return fmt::format("; expected one of {}", fmt::join(known, ", "));
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
    std::string key = keys_[depth_];
    for (std::size_t i = depth_ + 1; i < keys_.size(); ++i) key += "." + keys_[i];
    for (std::size_t end = keys_.size(); end > depth_; --end) {
      for (Value::Entry& entry : *map) {
        if (entry.key != key) continue;
        depth_ = end;
        return &entry.value;
      }
      key.resize(key.size() - std::min(key.size(), keys_[end - 1].size() + 1));
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
      for (std::string& name : UsedFilesOf(parent)) {
        if (name == key) {
          problems_.Add(location_, fmt::format("'{0}' is a file that is used; expected a path in "
                                               "it, {0}.PATH",
                                               key));
          return false;
        }
        known.push_back(std::move(name));
      }
    } else {
      const bool named_by_file = std::find(std::begin(kNamedByFile), std::end(kNamedByFile),
                                           keys_[0]) != std::end(kNamedByFile);
      if (depth_ > 1 || !named_by_file) return true;
      known = KeysOf(parent);
    }
    const std::string meant = depth_ == 0 ? MeantBy(key, parent, known) : DidYouMean(key, known);
    problems_.Add(location_, fmt::format("no '{}' there{}", key, meant));
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

/// A number or a word without a character that means more to YAML.
bool IsPlain(const std::string& text) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '+' || c == '-' || c == '_';
  };
  const bool sign = text.starts_with('-') || text.starts_with('+');
  const std::size_t first = sign ? 1 : 0;
  return text.size() > first && std::isalnum(static_cast<unsigned char>(text[first])) != 0 &&
         std::all_of(text.begin(), text.end(), plain) && text != "null" && text != "Null" &&
         text != "NULL";
}

void Apply(const Override& change, Value& root, Problems& problems) {
  const Location location{std::make_shared<const std::string>(change.Source()), 0, 0};
  if (change.path == "include" || change.path.starts_with("include.")) {
    problems.Add(location, "include: cannot be overridden; expected another path");
    return;
  }
  Problems syntax;
  Value value = change.Read(syntax);
  if (syntax.empty() && value.null()) {
    syntax.Add(location, fmt::format("got '{}'; expected a YAML value", change.value));
  }
  problems.Add(syntax);
  if (!syntax.empty()) return;
  if (Value* const at = Path(change.path, location, problems).Follow(root)) *at = std::move(value);
}

}  // namespace

std::string Override::Source() const {
  return (made_for.empty() ? "-s " : made_for + ": ") + (given_as.empty() ? path : given_as);
}

Value Override::Read(Problems& problems) const {
  const std::string name = Source();
  if (!IsPlain(value)) return ReadYaml(value, name, problems);
  std::string problem;
  Value::Data data = ReadPlainScalar(value, problem);
  const Location location{std::make_shared<const std::string>(name), 1, 1};
  if (!problem.empty()) problems.Add(location, problem);
  return Value(std::move(data), location);
}

Override Override::Parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigError(fmt::format("-s: got '{}'; expected PATH=VALUE", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<std::string> UsedFilesOf(const Value& root) {
  std::vector<std::string> names;
  const Value* const systems = root.Find("systems");
  if (systems == nullptr || systems->map() == nullptr) return names;
  for (const Value::Entry& entry : *systems->map()) {
    const Value* const type = entry.value.Find("type");
    if (type == nullptr || type->string() == nullptr || *type->string() != kDiagramType) continue;
    names.push_back(entry.key);
  }
  return names;
}

std::map<std::string, std::vector<Override>> TakeInner(std::vector<Override>& overrides,
                                                       const Value& root) {
  std::map<std::string, std::vector<Override>> inner;
  const std::vector<std::string> names = UsedFilesOf(root);
  const auto take = [&](const Override& change) {
    const std::size_t dot = change.path.find('.');
    const std::string first = change.path.substr(0, dot);
    const auto& sections = Sections();
    const bool section = std::any_of(sections.begin(), sections.end(),
                                     [&](const Section& known) { return known.key == first; });
    if (section || dot == std::string::npos) return false;
    bool taken = false;
    for (const std::string& name : names) {
      if (first != "*" && first != name) continue;
      taken = true;
      inner[name].push_back({change.path.substr(dot + 1), change.value,
                             change.given_as.empty() ? change.path : change.given_as,
                             change.made_for});
    }
    return taken;
  };
  std::erase_if(overrides, take);
  return inner;
}

void ApplyOverrides(const std::vector<Override>& overrides, Value& root, Problems& problems) {
  for (const Override& change : overrides) Apply(change, root, problems);
}

}  // namespace oca::files
