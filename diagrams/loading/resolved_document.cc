// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/resolved_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/expression.h"
#include "oca/diagrams/files/section.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/file_cache.h"
#include "oca/models/opened_files.h"

namespace oca::loading {
namespace {

namespace fs = std::filesystem;

/// Makes one scenario of a file that stands for many. Overrides count before, what the scenario
/// depends on, and after, because they may change what was drawn; what they get wrong is said
/// then.
void Draw(const std::vector<files::Override>& overrides, const files::Catalogue& catalogue,
          ResolvedDocument& read, Problems& problems) {
  if (read.document.Find("sampling") == nullptr) return;
  std::vector<files::Override> before = overrides;
  std::erase_if(before, [](const files::Override& change) {  // items that are yet to be drawn
    const std::size_t at = change.path.rfind(".obstacles.");
    return at != std::string::npos && change.path.find_first_of("0123456789", at) == at + 11;
  });
  Problems said_later;
  files::ApplyOverrides(before, read.document, said_later);
  read.scenario = sampling::DrawScenario(overrides, catalogue, read.document, problems);
  problems.Throw();
}

void CheckKeys(const Value& document, Problems& problems) {
  const auto& sections = files::Sections();
  for (const Value::Entry& entry : *document.map()) {
    const auto named = [&](const files::Section& section) { return section.key == entry.key; };
    if (std::any_of(sections.begin(), sections.end(), named)) continue;
    std::vector<std::string> known;
    for (const files::Section& section : sections) known.emplace_back(section.key);
    problems.Add(entry.location, fmt::format("{}: unknown key{}; known: {}", entry.key,
                                             DidYouMean(entry.key, known), fmt::join(known, ", ")));
  }
}

/// Parameters of the parts that were chosen: the file need not use all that they offer.
std::set<std::string> KnownToParts(const ResolvedDocument& read) {
  std::set<std::string> known;
  Problems ignored;                   // reported above
  const std::string* last = nullptr;  // what one file says stands together
  bool chosen = false;
  for (const Value::Entry& entry : files::SectionOf(read.document, "parameters", ignored)) {
    const std::string* const file = entry.location.file.get();
    if (file != std::exchange(last, file)) {
      chosen = file != nullptr && read.sources->chosen.contains(*file);
    }
    if (chosen) known.insert(entry.key);
  }
  return known;
}

/// Parameters that a part has or uses, as far as it can be read.
std::set<std::string> ParametersOf(const fs::path& file) {
  std::set<std::string> known;
  Problems ignored;  // of a part on its own
  try {
    const Value part = files::LoadFiles(file, {}, ignored).root;
    const Value* const parameters = part.Find("parameters");
    files::Expressions expressions(parameters == nullptr ? Value() : *parameters, ignored);
    expressions.Resolve(part);
    known = expressions.used();
    for (const Value::Entry& entry : files::SectionOf(part, "parameters", ignored)) {
      known.insert(entry.key);
    }
  } catch (const ConfigError&) {  // not to be read; whoever chooses it is told
  }
  return known;
}

/// Those of all parts that could have been chosen, as one of avoidance_*.yaml: a file says for all
/// of them what each may need.
std::set<std::string> KnownToAlternatives(const files::DocumentSources& sources) {
  std::set<std::string> known;
  // The diagram is not made from them.
  const models::OpenedFiles looked_at(models::OpenedFiles::Elder::kNotesNot);
  for (const fs::path& file : sources.alternatives) {
    const auto own = models::ReadOnce<std::set<std::string>>(file, "parameters",
                                                             [&] { return ParametersOf(file); });
    known.insert(own->begin(), own->end());
  }
  return known;
}

void Resolve(EarlierResolutions& earlier, const std::string& use, const GivenParameters* given,
             ResolvedDocument& read, Problems& problems) {
  const Value* const parameters = read.document.Find("parameters");
  if (parameters != nullptr && parameters->map() == nullptr && !parameters->null()) {
    problems.Add(parameters->location(),
                 fmt::format("parameters: got {}; expected a map", parameters->Show()));
  }
  files::Expressions expressions(parameters == nullptr ? Value() : *parameters, problems,
                                 earlier.Of(use));
  for (const std::string& name : read.sources->choosing) expressions.MarkUsed(name);
  Value::Map resolved;
  resolved.reserve(read.document.map()->size());
  for (const Value::Entry& entry : *read.document.map()) {
    if (entry.key == "parameters") continue;
    resolved.push_back({entry.key, entry.location, expressions.Resolve(entry.value)});
  }
  read.root = Value(std::move(resolved), read.document.location());
  std::set<std::string> known = KnownToParts(read);
  if (given != nullptr) {  // what the other file gives to all its uses, not all need to use
    for (const Value::Entry& entry : *given->map.map()) known.insert(entry.key);
  }
  read.warnings = expressions.Unused(known);
  if (!read.warnings.empty()) {  // read the others only where it matters
    known.merge(KnownToAlternatives(*read.sources));
    read.warnings = expressions.Unused(known);
  }
  if (problems.empty()) earlier.Keep(use, expressions.TakeResolution());
}

/// The entry of a map, to be changed; nullptr if there is none.
Value* FindOwn(Value& map, const std::string& key) {
  for (Value::Entry& entry : *map.map()) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

/// Puts the parameters that another file gives in place of those of the document.
void Give(const GivenParameters& given, const fs::path& file, ResolvedDocument& read) {
  Value* section = nullptr;
  for (Value::Entry& entry : *read.document.map()) {
    if (entry.key == "parameters" && entry.value.map() != nullptr) section = &entry.value;
  }
  std::optional<std::set<std::string>> elsewhere;  // looked up if need be
  for (const Value::Entry& entry : *given.map.map()) {
    if (Value* const own = section == nullptr ? nullptr : FindOwn(*section, entry.key)) {
      if (!entry.value.null()) *own = entry.value;  // of nothing has been told
      continue;
    }
    if (!elsewhere) elsewhere = KnownToAlternatives(*read.sources);
    if (elsewhere->contains(entry.key)) continue;
    std::vector<std::string> names;
    if (section != nullptr) {
      for (const Value::Entry& one : *section->map()) names.push_back(one.key);
    }
    given.problems->Add(entry.location,
                        fmt::format("{}.{}: {} has no such parameter{}", given.where, entry.key,
                                    file.string(), DidYouMean(entry.key, names)));
  }
}

void RefuseSampling(const Value& document, Problems& problems) {
  for (const Value::Entry& entry : *document.map()) {
    if (entry.key != "sampling") continue;
    problems.Add(entry.location,
                 "sampling: got a file that draws scenarios; expected none in a file that another "
                 "one uses: what a run draws, its own file says");
  }
}

}  // namespace

ResolvedDocument ReadResolved(const fs::path& file, const std::vector<files::Override>& overrides,
                              Construction& construction, Problems& problems,
                              const std::string& use, const GivenParameters* given) {
  ResolvedDocument read;
  auto [document, sources] =
      files::LoadFiles(file, overrides, problems, given == nullptr ? nullptr : &given->map);
  read.document = std::move(document);
  read.sources = std::move(sources);
  problems.Throw();
  std::vector<files::Override> own = overrides;
  read.inner_overrides = files::TakeInner(own, read.document);
  if (given != nullptr) {
    RefuseSampling(read.document, problems);
    Give(*given, file, read);
  } else {
    Draw(own, construction.catalogue, read, problems);
  }
  files::ApplyOverrides(own, read.document, problems);
  problems.Throw();
  CheckKeys(read.document, problems);
  Resolve(construction.earlier, use, given, read, problems);
  return read;
}

}  // namespace oca::loading
