// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/blueprint.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/files/section.h"
#include "oca/diagrams/loading/assembly.h"
#include "oca/diagrams/loading/construction.h"
#include "oca/diagrams/loading/part.h"
#include "oca/diagrams/loading/resolved_document.h"
#include "oca/diagrams/loading/used_file.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/file_cache.h"
#include "oca/models/foreign_text.h"
#include "oca/models/opened_files.h"

namespace oca::loading {
namespace {

namespace fs = std::filesystem;

/// Goes through a diagram file and those that it uses, section by section, and collects every
/// problem on the way.
class Loader {
 public:
  Loader(const fs::path& file, const std::vector<files::Override>& overrides,
         const files::Catalogue& catalogue, EarlierResolutions& earlier, const Part& part)
      : file_(file), part_(part), construction_(part, catalogue, earlier, builder_) {
    loaded_.file = file.string();
    loaded_.overrides = overrides;
  }

  LoadedDiagram Load(bool movable) {
    ReadDocument();
    loaded_.name = models::internal::AsUtf8(file_.stem().native());
    ReadRun(root(), loaded_, problems_);
    files::ModelSection models(root(), problems_);
    for (const Diagnostic& warning : models.warnings()) construction_.warnings.Add("", warning);
    const SystemSources sources{models, inner_overrides_};
    Assembly assembly(root(), level_, sources, construction_, builder_, problems_);
    loaded_.models = models.models();
    KeepUsedFiles(assembly.systems());
    CheckRuns(assembly.systems());
    ReadTolerances(root(), level_, assembly.systems(), problems_);
    loaded_.systems = assembly.systems().TakeBlocks();
    part_.CheckNames(assembly.systems().names(), root().location(), problems_);
    Throw();
    loaded_.diagram = assembly.Build(movable);
    loaded_.metrics = assembly.Metrics();
    loaded_.opened = opened_.files();
    if (part_.whole()) ReadOutputs(root(), level_, assembly, {}, problems_);
    Throw();
    for (const Diagnostic& warning : construction_.warnings.all()) {
      loaded_.warnings.push_back(warning.ToString());
    }
    return std::move(loaded_);
  }

 private:
  const Value& root() const { return loaded_.resolved; }

  void Throw() {
    for (const Diagnostic& problem : construction_.problems.all()) {
      problems_.Add(problem.location, problem.what);
    }
    problems_.Throw();
  }

  void ReadDocument() {
    ResolvedDocument read = ReadResolved(file_, loaded_.overrides, construction_, problems_);
    level_.files.push_back(read.sources->files.front());
    loaded_.sources = read.sources->files;
    loaded_.candidates = read.sources->candidates;
    loaded_.document = std::move(read.document);
    loaded_.scenario = std::move(read.scenario);
    loaded_.resolved = std::move(read.root);
    inner_overrides_ = std::move(read.inner_overrides);
    for (const Diagnostic& warning : read.warnings) construction_.warnings.Add("", warning);
  }

  /// What a file says of the run: its name and how it is simulated.
  static void ReadRun(const Value& root, LoadedDiagram& loaded, Problems& problems) {
    for (const auto& [key, target] :
         {std::pair{"name", &loaded.name}, std::pair{"description", &loaded.description}}) {
      const Value* const value = root.Find(key);
      if (value == nullptr || value->null()) continue;
      if (value->string() == nullptr) {
        problems.Add(value->location(),
                     fmt::format("{}: got {}; expected text", key, value->Show()));
      } else {
        *target = *value->string();
      }
    }
    if (const Value* const value = root.Find("simulator")) {
      ReadFields(*value, FieldsOf<files::SimulatorParams>(), "simulator", &loaded.simulator,
                 problems);
    }
  }

  /// What used files say of a run is not of this one, and must be right all the same.
  static void CheckRuns(const SystemSection& systems) {
    ForUsedFiles(systems, [](const UsedFile& used, Problems& own) {
      LoadedDiagram ignored;
      ReadRun(used.document().root, ignored, own);
      files::ReadSceneRate(used.document().root, ignored.scene_period, own);
      CheckRuns(used.assembly().systems());
    });
  }

  void KeepUsedFiles(const SystemSection& systems) {
    for (const auto& used : systems.used_files()) {
      const ResolvedDocument& read = used->document();
      AddNew(read.sources->files, loaded_.sources);
      AddNew(read.sources->candidates, loaded_.candidates);
      loaded_.models.AddInner(used->models());
      loaded_.used_files.push_back(
          {used->level().path, used->file(), read.document, read.root, *used->given().map()});
      KeepUsedFiles(used->assembly().systems());
    }
  }

  static void AddNew(const std::vector<fs::path>& files, std::vector<fs::path>& all) {
    for (const fs::path& file : files) {  // as texts: paths compare part by part
      const bool there = std::any_of(all.begin(), all.end(), [&](const fs::path& other) {
        return other.native() == file.native();
      });
      if (!there) all.push_back(file);
    }
  }

  /// The file's own win over those of files that it uses.
  void ReadTolerances(const Value& root, const Level& level, const SystemSection& systems,
                      Problems& problems) {
    ForUsedFiles(systems, [&](const UsedFile& used, Problems& own) {
      ReadTolerances(used.document().root, used.level(), used.assembly().systems(), own);
    });
    for (const Value::Entry& entry : files::SectionOf(root, "simulator_tolerances", problems)) {
      ReadFields(entry.value, FieldsOf<Tolerances>(), "simulator_tolerances." + entry.key,
                 &loaded_.simulator.integration.tolerances[level.Full(entry.key)], problems);
      if (entry.value.map() != nullptr) {
        for (const Value::Entry& field : *entry.value.map()) {
          RefuseOverridesBelow(systems, level.Full(entry.key + "." + field.key));
        }
      }
      if (systems.Names(entry.key)) continue;
      problems.Add(entry.location, fmt::format("simulator_tolerances: no system '{}'{}", entry.key,
                                               DidYouMean(entry.key, systems.names())));
    }
  }

  /// An override in a used file of a tolerance that a file around it gives, by its whole path.
  static void RefuseOverridesBelow(const SystemSection& systems, const std::string& tolerance) {
    ForUsedFiles(systems, [&](const UsedFile& used, Problems& own) {
      const std::string prefix = used.level().path + ".";
      if (!tolerance.starts_with(prefix)) return;
      RefuseOverrides(used.overrides(), used.level(),
                      "simulator_tolerances." + tolerance.substr(prefix.size()), own);
      RefuseOverridesBelow(used.assembly().systems(), tolerance);
    });
  }

  /// Those of what a file around that one has its own value for, which wins.
  static void RefuseOverrides(const std::vector<files::Override>& overrides, const Level& level,
                              const std::string& path, Problems& problems) {
    for (const files::Override& change : overrides) {
      if (change.path != path && !path.starts_with(change.path + ".") &&
          !change.path.starts_with(path + ".") &&
          fnmatch(change.path.c_str(), path.c_str(), 0) != 0) {
        continue;
      }
      problems.Add({std::make_shared<const std::string>(change.Source()), 0, 0},
                   fmt::format("{}: without effect; a file that uses this one says it of '{}', and "
                               "its word counts; expected an override of that",
                               path, level.path));
    }
  }

  /// What the file says to record and to expect of its systems, it says wherever it is used, unless
  /// the file there says otherwise.
  void ReadOutputs(const Value& root, const Level& level, Assembly& assembly,
                   const std::vector<files::Override>& overrides, Problems& problems) {
    files::NamedOutputs outputs = assembly.systems().Outputs();
    const files::NamedOutputs named = assembly.systems().NamedByUsedFiles();
    for (auto& signal : files::ReadRecord(root, outputs, named, problems)) {
      const std::string name = std::exchange(signal.name, level.Full(signal.name));
      if (!IsIn(signal.name, loaded_.record)) {
        loaded_.record.push_back(std::move(signal));
      } else {
        RefuseOverrides(overrides, level, "record.signals." + name, problems);
      }
    }
    outputs.insert(outputs.end(), named.begin(), named.end());
    const bool own = level.path.empty();
    const files::NamedOutputs metrics = own ? loaded_.metrics : assembly.Metrics();
    const double duration = loaded_.simulator.duration;
    if (own) loaded_.scene_period = files::ReadSceneRate(root, loaded_.scene_period, problems);
    for (auto& expectation : files::ReadExpectations(root, outputs, metrics, loaded_.diagram.get(),
                                                     own ? duration : kEver, problems)) {
      const std::string name = std::exchange(expectation.name, level.Full(expectation.name));
      if (IsIn(expectation.name, loaded_.expectations)) {
        RefuseOverrides(overrides, level, "expect." + name, problems);
      } else if (expectation.bound.at.value_or(0.0) > duration) {  // the file runs longer
        WarnOfExpectation(root, level, name, *expectation.bound.at);
      } else {
        loaded_.expectations.push_back(std::move(expectation));
      }
    }
    ForUsedFiles(assembly.systems(), [&](const UsedFile& used, Problems& of_used) {
      ReadOutputs(used.document().root, used.level(), used.assembly(), used.overrides(), of_used);
    });
  }

  void WarnOfExpectation(const Value& root, const Level& level, const std::string& name,
                         double at) {
    construction_.warnings.Add(
        level.path,
        {root.Find("expect")->Find(name)->location(),
         fmt::format("expect.{}.at: got {} s, after the run, which ends at {} s: it is not checked",
                     name, at, loaded_.simulator.duration),
         Diagnostic::Kind::kWarning});
  }

  template <class Named>
  static bool IsIn(const std::string& name, const std::vector<Named>& all) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Named& other) { return other.name == name; });
  }

  template <class Visit>
  static void ForUsedFiles(const SystemSection& systems, const Visit& visit) {
    for (const auto& used : systems.used_files()) {
      Problems own;
      visit(*used, own);
      used->Tell(own);
    }
  }

  static constexpr double kEver = std::numeric_limits<double>::infinity();

  const fs::path file_;
  const Part& part_;
  models::OpenedFiles opened_;
  LoadedDiagram loaded_;
  Problems problems_;
  DiagramBuilder builder_;
  Construction construction_;
  Level level_;
  std::map<std::string, std::vector<files::Override>> inner_overrides_;
};

}  // namespace

Blueprint::Blueprint(fs::path file, files::Catalogue catalogue)
    : file_(std::move(file)),
      catalogue_(std::move(catalogue)),
      read_(std::make_shared<models::FileCache>()),
      earlier_(std::make_shared<EarlierResolutions>()) {}

LoadedDiagram Blueprint::Build(const std::vector<files::Override>& overrides,
                               const BuildOptions& options) const {
  if (options.part && options.part->empty()) {
    throw ConfigError("part: got no system; expected at least one");
  }
  const models::FileCache::Use use(*read_);
  const Part part(options.part.value_or(std::vector<std::string>{}));
  return Loader(file_, overrides, catalogue_, *earlier_, part).Load(options.movable);
}

}  // namespace oca::loading
