// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/blueprint.h"

#include <fmt/format.h>

#include <utility>

#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/files/section.h"
#include "oca/diagrams/loading/assembly.h"
#include "oca/diagrams/loading/part.h"
#include "oca/diagrams/loading/resolved_document.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/file_cache.h"
#include "oca/models/opened_files.h"

namespace oca::loading {
namespace {

namespace fs = std::filesystem;

/// Goes through a diagram file section by section and collects every problem on the way.
class Loader {
 public:
  Loader(const fs::path& file, const std::vector<files::Override>& overrides,
         const files::Catalogue& catalogue)
      : file_(file), catalogue_(catalogue) {
    loaded_.file = file.string();
    loaded_.overrides = overrides;
  }

  LoadedDiagram Load(const Part& part, bool movable) {
    ReadDocument();
    ReadNames();
    ReadSimulator();
    files::ModelSection models(root(), problems_);
    loaded_.models = models.models();
    Warn(models.warnings());
    Assembly assembly(root(), part, catalogue_, models, problems_);
    Warn(assembly.systems().warnings());
    loaded_.systems = assembly.systems().blocks();
    CheckTolerances(assembly.systems());
    part.CheckNames(assembly.systems().names(), root().location(), problems_);
    problems_.Throw();
    loaded_.diagram = assembly.Build(movable);
    loaded_.metrics = assembly.Metrics();
    loaded_.opened = opened_.files();
    if (part.whole()) ReadOutputs(assembly.systems().Outputs());
    problems_.Throw();
    return std::move(loaded_);
  }

 private:
  const Value& root() const { return loaded_.resolved; }
  const Value::Map& Map(const char* key) { return files::SectionOf(root(), key, problems_); }

  void Warn(const std::vector<std::string>& lines) {
    loaded_.warnings.insert(loaded_.warnings.end(), lines.begin(), lines.end());
  }

  void ReadDocument() {
    ResolvedDocument read = ReadResolved(file_, loaded_.overrides, catalogue_, problems_);
    loaded_.sources = std::move(read.sources.files);
    loaded_.candidates = std::move(read.sources.candidates);
    loaded_.document = std::move(read.document);
    loaded_.scenario = std::move(read.scenario);
    loaded_.resolved = std::move(read.root);
    loaded_.warnings = std::move(read.warnings);
  }

  void ReadNames() {
    loaded_.name = file_.stem().string();
    for (const auto& [key, target] :
         {std::pair{"name", &loaded_.name}, std::pair{"description", &loaded_.description}}) {
      const Value* const value = root().Find(key);
      if (value == nullptr || value->null()) continue;
      if (value->string() == nullptr) {
        problems_.Add(value->location(),
                      fmt::format("{}: got {}; expected text", key, value->Show()));
      } else {
        *target = *value->string();
      }
    }
  }

  void ReadSimulator() {
    if (const Value* const value = root().Find("simulator")) {
      ReadFields(*value, FieldsOf<files::SimulatorParams>(), "simulator", &loaded_.simulator,
                 problems_);
    }
    for (const Value::Entry& entry : Map("simulator_tolerances")) {
      ReadFields(entry.value, FieldsOf<Tolerances>(), "simulator_tolerances." + entry.key,
                 &loaded_.simulator.integration.tolerances[entry.key], problems_);
    }
  }

  void CheckTolerances(const SystemSection& systems) {
    for (const Value::Entry& entry : Map("simulator_tolerances")) {
      if (systems.Names(entry.key)) continue;
      problems_.Add(entry.location, fmt::format("simulator_tolerances: no system '{}'{}", entry.key,
                                                DidYouMean(entry.key, systems.names())));
    }
  }

  void ReadOutputs(const files::NamedOutputs& outputs) {
    loaded_.record = files::ReadRecord(root(), outputs, problems_);
    loaded_.scene_period = files::ReadSceneRate(root(), loaded_.scene_period, problems_);
    loaded_.expectations =
        files::ReadExpectations(root(), outputs, loaded_.metrics, loaded_.diagram.get(),
                                loaded_.simulator.duration, problems_);
  }

  const fs::path file_;
  const files::Catalogue& catalogue_;
  models::OpenedFiles opened_;
  LoadedDiagram loaded_;
  Problems problems_;
};

}  // namespace

Blueprint::Blueprint(fs::path file, files::Catalogue catalogue)
    : file_(std::move(file)),
      catalogue_(std::move(catalogue)),
      read_(std::make_shared<models::FileCache>()) {}

LoadedDiagram Blueprint::Build(const std::vector<files::Override>& overrides,
                               const BuildOptions& options) const {
  if (options.part && options.part->empty()) {
    throw ConfigError("part: got no system; expected at least one");
  }
  const models::FileCache::Use use(*read_);
  const Part part(options.part.value_or(std::vector<std::string>{}));
  return Loader(file_, overrides, catalogue_).Load(part, options.movable);
}

}  // namespace oca::loading
