// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/loader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "oca/diagrams/files/expression.h"
#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/files/section.h"
#include "oca/diagrams/foresight/tree_source.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/models/opened_files.h"
#include "oca/systems/signals/motion_metrics_value.h"
#include "oca/systems/signals/roles.h"

namespace oca::loading {

std::string ExportedName(std::string port) {
  std::replace(port.begin(), port.end(), '.', '_');
  return port;
}

std::vector<std::string> InsideOf(const Diagram& whole) {
  std::vector<std::string> inside;
  for (const auto& [path, system] : whole.systems()) {
    if (system->role<systems::Boundary>() == nullptr) inside.push_back(path);
  }
  return inside;
}

namespace {

namespace fs = std::filesystem;

/// Walks the resolved tree section by section and collects every problem on the way.
class Loader {
 public:
  Loader(const fs::path& file, const files::Catalogue& catalogue,
         std::vector<std::string> part = {}, bool movable = false)
      : catalogue_(catalogue), part_(std::move(part)), movable_(movable) {
    loaded_.file = file.string();
  }

  LoadedDiagram Load(const fs::path& file, const std::vector<files::Override>& overrides) {
    Value document = files::LoadFiles(file, overrides, problems_, &sources_);
    loaded_.sources = sources_.files;
    loaded_.candidates = sources_.candidates;
    loaded_.overrides = overrides;
    problems_.Throw();
    Draw(overrides, document);
    files::ApplyOverrides(overrides, document, problems_);
    problems_.Throw();
    CheckKeys(document);
    root_ = Resolve(document);
    loaded_.document = document;
    loaded_.resolved = root_;
    ReadNames();
    ReadSimulator();
    models_.emplace(root_, problems_);
    loaded_.models = models_->models();
    loaded_.warnings.insert(loaded_.warnings.end(), models_->warnings().begin(),
                            models_->warnings().end());
    ReadSystems();
    ReadConnections();
    CheckTolerances();
    CheckPart();
    problems_.Throw();
    Build();
    loaded_.opened = opened_.files();
    if (!part_.empty()) {
      problems_.Throw();
      return std::move(loaded_);
    }
    const files::NamedOutputs outputs = AllOutputs();
    loaded_.record = files::ReadRecord(root_, outputs, problems_);
    loaded_.scene_period = files::ReadSceneRate(root_, loaded_.scene_period, problems_);
    loaded_.expectations =
        files::ReadExpectations(root_, outputs, loaded_.metrics, loaded_.diagram.get(),
                                loaded_.simulator.duration, problems_);
    problems_.Throw();
    return std::move(loaded_);
  }

 private:
  /// Makes one scenario of a file that stands for many. Overrides count before, what the scenario
  /// depends on, and after, because they may change what was drawn; what they get wrong is said
  /// then.
  void Draw(const std::vector<files::Override>& overrides, Value& document) {
    if (document.Find("sampling") == nullptr) return;
    std::vector<files::Override> before = overrides;
    std::erase_if(before, [](const files::Override& change) {  // items that are yet to be drawn
      const std::size_t at = change.path.rfind(".obstacles.");
      return at != std::string::npos && change.path.find_first_of("0123456789", at) == at + 11;
    });
    Problems said_later;
    files::ApplyOverrides(before, document, said_later);
    loaded_.scenario = sampling::DrawScenario(overrides, catalogue_, document, problems_);
    problems_.Throw();
  }

  void CheckKeys(const Value& document) {
    std::vector<std::string> known;
    for (const files::Section& section : files::Sections()) known.emplace_back(section.key);
    for (const Value::Entry& entry : *document.map()) {
      if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
      problems_.Add(entry.location,
                    fmt::format("{}: unknown key{}; known: {}", entry.key,
                                DidYouMean(entry.key, known), fmt::join(known, ", ")));
    }
  }

  Value Resolve(const Value& document) {
    const Value* const parameters = document.Find("parameters");
    if (parameters != nullptr && parameters->map() == nullptr && !parameters->null()) {
      problems_.Add(parameters->location(),
                    fmt::format("parameters: got {}; expected a map", parameters->Show()));
    }
    files::Expressions expressions(parameters == nullptr ? Value() : *parameters, problems_);
    for (const std::string& name : sources_.choosing) expressions.MarkUsed(name);
    Value::Map resolved;
    for (const Value::Entry& entry : *document.map()) {
      if (entry.key == "parameters") continue;
      resolved.push_back({entry.key, entry.location, expressions.Resolve(entry.value)});
    }
    std::set<std::string> known = KnownToParts(document);
    loaded_.warnings = expressions.Unused(known);
    if (!loaded_.warnings.empty()) {  // read the others only where it matters
      known.merge(KnownToAlternatives());
      loaded_.warnings = expressions.Unused(known);
    }
    return Value(std::move(resolved), document.location());
  }

  /// Parameters of the parts that were chosen: the file need not use all that they offer.
  std::set<std::string> KnownToParts(const Value& document) const {
    std::set<std::string> known;
    Problems ignored;  // reported above
    for (const Value::Entry& entry : files::SectionOf(document, "parameters", ignored)) {
      const auto& file = entry.location.file;
      if (file && sources_.chosen.contains(*file)) known.insert(entry.key);
    }
    return known;
  }

  /// The same of all parts that could have been chosen, as one of avoidance_*.yaml, with what they
  /// use: a file says for all of them what each may need.
  std::set<std::string> KnownToAlternatives() const {
    std::set<std::string> known;
    // The diagram is not made from them.
    models::OpenedFiles looked_at(models::OpenedFiles::Elder::kNotesNot);
    for (const fs::path& file : sources_.alternatives) {
      Problems ignored;  // of a part on its own
      try {
        const Value part = files::LoadFiles(file, {}, ignored);
        const Value* const parameters = part.Find("parameters");
        files::Expressions expressions(parameters == nullptr ? Value() : *parameters, ignored);
        expressions.Resolve(part);
        known.insert(expressions.used().begin(), expressions.used().end());
        for (const Value::Entry& entry : files::SectionOf(part, "parameters", ignored)) {
          known.insert(entry.key);
        }
      } catch (const ConfigError&) {  // not to be read; whoever chooses it is told
      }
    }
    return known;
  }

  const Value::Map& Map(const char* key) { return files::SectionOf(root_, key, problems_); }

  void ReadNames() {
    loaded_.name = fs::path(loaded_.file).stem().string();
    for (const auto& [key, target] :
         {std::pair{"name", &loaded_.name}, std::pair{"description", &loaded_.description}}) {
      const Value* const value = root_.Find(key);
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
    if (const Value* const value = root_.Find("simulator")) {
      ReadFields(*value, FieldsOf<files::SimulatorParams>(), "simulator", &loaded_.simulator,
                 problems_);
    }
    for (const Value::Entry& entry : Map("simulator_tolerances")) {
      ReadFields(entry.value, FieldsOf<Tolerances>(), "simulator_tolerances." + entry.key,
                 &loaded_.simulator.integration.tolerances[entry.key], problems_);
    }
  }

  void CheckTolerances() {
    for (const Value::Entry& entry : Map("simulator_tolerances")) {
      const auto& names = system_names_;
      if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
      problems_.Add(entry.location, fmt::format("simulator_tolerances: no system '{}'{}", entry.key,
                                                DidYouMean(entry.key, names)));
    }
  }

  void ReadSystems() {
    if (root_.Find("systems") == nullptr) {
      problems_.Add(root_.location(), "systems: missing; expected a map of named systems");
    } else if (Map("systems").empty() && problems_.empty()) {
      problems_.Add(root_.Find("systems")->location(), "systems: got none; expected at least one");
    }
    for (const Value::Entry& entry : Map("systems")) ReadSystem(entry);
  }

  void ReadSystem(const Value::Entry& entry) {
    const std::string where = "systems." + entry.key;
    system_names_.push_back(entry.key);
    if (entry.value.map() == nullptr) {
      if (entry.value.null()) return;
      problems_.Add(entry.value.location(), fmt::format("{}: got {}; expected a map with a type",
                                                        where, entry.value.Show()));
      return;
    }
    const Value* const type = entry.value.Find("type");
    if (type == nullptr || type->string() == nullptr) {
      if (type == nullptr || !type->null()) {
        problems_.Add(entry.location,
                      fmt::format("{}.type: {}; expected the name of a system type", where,
                                  type == nullptr ? "missing" : "got " + type->Show()));
      }
      return;
    }
    Value::Map rest;
    for (const Value::Entry& field : *entry.value.map()) {
      if (field.key != "type") rest.push_back(field);
    }
    foresight::TellGoal(Map("systems"), catalogue_, rest);
    try {
      const files::Catalogue::Row& row = catalogue_.Find(*type->string());
      const Value params = models_->ResolveFiles(Value(std::move(rest), entry.value.location()));
      // A model that did not load has been reported; its users would only repeat it.
      if (models_->failed() && row->needs_models) return;
      auto system = row->Make(params, where, loaded_.models, problems_);
      if (!system) return;
      locations_[entry.key] = entry.location;
      KeepWarnings(*system, where, entry.location);
      if (!Inside(entry.key)) {
        systems_[entry.key] = outside_.emplace_back(std::move(system)).get();
        return;
      }
      systems_[entry.key] = &builder_.AddSystem(entry.key, std::move(system));
      loaded_.systems.push_back({entry.key, row->type, params, row});
    } catch (const WiringError& error) {
      problems_.Add(entry.location, fmt::format("{}: {}", where, error.what()));
    } catch (const ConfigError& error) {
      problems_.Add(type->location(), fmt::format("{}.type: {}", where, error.what()));
    }
  }

  void KeepWarnings(const System& system, const std::string& where, const Location& location) {
    for (const auto* const remarks : system.roles<systems::Remarks>()) {
      for (const std::string& line : remarks->warnings) {
        loaded_.warnings.push_back(
            fmt::format("{}: warning: {}: {}", location.ToString(), where, line));
      }
    }
  }

  void ReadConnections() {
    const Value* const value = root_.Find("connections");
    if (value == nullptr || value->null()) return;
    if (value->list() == nullptr) {
      problems_.Add(value->location(),
                    fmt::format("connections: got {}; expected a list of 'system.output -> "
                                "system.input'",
                                value->Show()));
      return;
    }
    for (const Value& item : *value->list()) ReadConnection(item);
  }

  void ReadConnection(const Value& item) {
    if (item.null()) return;
    const std::string* const text = item.string();
    const std::size_t arrow = text == nullptr ? std::string::npos : text->find("->");
    if (arrow == std::string::npos) {
      problems_.Add(item.location(), fmt::format("connections: got {}; expected 'system.output -> "
                                                 "system.input'",
                                                 item.Show()));
      return;
    }
    const auto from = SplitPort(text->substr(0, arrow), item.location());
    const auto to = SplitPort(text->substr(arrow + 2), item.location());
    if (!from || !to) return;
    try {
      OutputHandle output;
      InputHandle input;
      const bool from_there = Locate(*from, item.location(), [&](const System& system) {
        output = system.FindOutput(from->port);
      });
      const bool to_there = Locate(
          *to, item.location(), [&](const System& system) { input = system.FindInput(to->port); });
      if (!from_there || !to_there || !Inside(to->system)) return;
      if (Inside(from->system)) {
        builder_.ConnectPorts(output, input);
      } else {
        Import(*from, output, input, item.location());
      }
      connection_locations_[to->system + "." + to->port] = item.location();
    } catch (const WiringError& error) {
      problems_.Add(item.location(), error.what());
    }
  }

  struct PortName {
    std::string system;
    std::string port;
  };

  std::optional<PortName> SplitPort(std::string text, const Location& location) {
    const auto first = text.find_first_not_of(" \t");
    const auto last = text.find_last_not_of(" \t");
    text = first == std::string::npos ? "" : text.substr(first, last - first + 1);
    const std::size_t dot = text.find('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == text.size()) {
      problems_.Add(location, fmt::format("connections: got '{}'; expected system.port", text));
      return std::nullopt;
    }
    return PortName{text.substr(0, dot), text.substr(dot + 1)};
  }

  /// Calls find(system); adds a problem if the system or the port does not exist.
  template <class Find>
  bool Locate(const PortName& name, const Location& location, const Find& find) {
    const auto system = systems_.find(name.system);
    if (system == systems_.end()) {
      const bool named =
          std::find(system_names_.begin(), system_names_.end(), name.system) != system_names_.end();
      if (!named) {  // one that is named but could not be made has been reported
        problems_.Add(location, fmt::format("connections: no system '{}'{}", name.system,
                                            DidYouMean(name.system, system_names_)));
      }
      return false;
    }
    try {
      find(*system->second);
      return true;
    } catch (const WiringError& error) {
      problems_.Add(location, fmt::format("connections: {}: {}", name.system, error.what()));
      return false;
    }
  }

  bool Inside(const std::string& system) const {
    return part_.empty() || std::find(part_.begin(), part_.end(), system) != part_.end();
  }

  void CheckPart() {
    for (const std::string& name : part_) {
      const auto& names = system_names_;
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      problems_.Add(root_.location(),
                    fmt::format("part: no system '{}'{}", name, DidYouMean(name, names)));
    }
  }

  /// Exports an input of the part under the name of the output outside that drives it.
  void Import(const PortName& from, const OutputHandle& output, const InputHandle& input,
              const Location& location) {
    const SignalType& got = TypeOfPort(output);
    const SignalType& expected = TypeOfPort(input);
    const std::string port = from.system + "." + from.port;
    const std::string name = ExportedName(port);
    const auto [imported, fresh] = imports_.emplace(name, port);
    if (!fresh && imported->second != port) {
      problems_.Add(location, fmt::format("part: {} and {} would both become the input {}",
                                          imported->second, port, name));
    } else if (&got != &expected) {
      problems_.Add(location,
                    fmt::format("{} -> {}: type; got {}; expected {}", port,
                                input.system->inputs()[input.index].name, got.name, expected.name));
    } else {
      builder_.ExportInput(name, input);
    }
  }

  void ExportOutputs() {
    for (const auto& block : loaded_.systems) {
      const System& system = *systems_.at(block.name);
      for (const System::OutputInfo& output : system.outputs()) {
        builder_.ExportOutput(ExportedName(block.name + "." + output.name),
                              system.FindOutput(output.name));
      }
    }
  }

  void ExportOffsets() {
    for (const auto& block : loaded_.systems) {
      const auto* const holds = systems_.at(block.name)->role<systems::HoldsObstacles>();
      if (holds == nullptr || holds->offsets.system == nullptr) continue;
      const std::string port = block.name + "." + NameOfPort(holds->offsets);
      if (!connection_locations_.contains(port)) {
        builder_.ExportInput(ExportedName(port), holds->offsets);
      }
    }
  }

  static const std::string& NameOfPort(const InputHandle& input) {
    return input.system->inputs()[static_cast<std::size_t>(input.index)].name;
  }

  void Build() {
    try {
      if (!part_.empty()) ExportOutputs();
      if (movable_) ExportOffsets();
      loaded_.diagram = builder_.Build();
      loaded_.diagram->schedule().CheckStart(loaded_.diagram->MakeContext(), false);
    } catch (const SimulationError& error) {  // a state starts where it cannot be
      problems_.Add(locations_.at(error.system), error.what());
    } catch (const WiringError& error) {
      for (const std::string& problem : error.problems) problems_.Add(Place(problem), problem);
    }
    for (const auto& block : loaded_.systems) AddMetricsOf(block.name);
  }

  void AddMetricsOf(const std::string& name) {
    const auto* const judges = systems_.at(name)->role<systems::Judges>();
    if (judges == nullptr) return;
    try {
      Typed<systems::MotionMetricsValue>(judges->metrics);
      loaded_.metrics.emplace_back(name, judges->metrics);
    } catch (const WiringError& error) {
      problems_.Add(locations_.at(name), fmt::format("systems.{}: judge: {}", name, error.what()));
    }
  }

  /// Where in the file a wiring problem lies: its connection, else its system.
  Location Place(const std::string& problem) const {
    for (const auto& [input, location] : connection_locations_) {
      if (problem.find("-> " + input + ":") != std::string::npos ||
          problem.starts_with(input + ":")) {
        return location;
      }
    }
    const auto system = locations_.find(problem.substr(0, problem.find('.')));
    return system == locations_.end() ? root_.location() : system->second;
  }

  files::NamedOutputs AllOutputs() const {
    files::NamedOutputs outputs;
    for (const auto& block : loaded_.systems) {
      const System& system = *systems_.at(block.name);
      for (const System::OutputInfo& output : system.outputs()) {
        outputs.emplace_back(block.name + "." + output.name, system.FindOutput(output.name));
      }
    }
    return outputs;
  }

  const files::Catalogue& catalogue_;
  const std::vector<std::string> part_;  // systems to build; empty: all
  const bool movable_;
  models::OpenedFiles opened_;
  LoadedDiagram loaded_;
  files::DocumentSources sources_;
  Problems problems_;
  Value root_;
  std::optional<files::ModelSection> models_;
  DiagramBuilder builder_;
  std::vector<std::string> system_names_;
  std::map<std::string, const System*> systems_;
  std::vector<std::unique_ptr<System>> outside_;  // of the part
  std::map<std::string, std::string> imports_;    // exported inputs and the outputs they stand for
  std::map<std::string, Location> locations_;
  std::map<std::string, Location> connection_locations_;
};

}  // namespace

const LoadedDiagram::Block& LoadedDiagram::BlockOf(const System& system) const {
  const std::string path = diagram->PathOf(system);
  return *std::find_if(systems.begin(), systems.end(),
                       [&](const Block& block) { return block.name == path; });
}

LoadedDiagram LoadDiagram(const fs::path& file, const std::vector<files::Override>& overrides,
                          const files::Catalogue& catalogue) {
  return Loader(file, catalogue).Load(file, overrides);
}

LoadedDiagram LoadMovable(const fs::path& file, const std::vector<files::Override>& overrides,
                          const files::Catalogue& catalogue) {
  return Loader(file, catalogue, {}, true).Load(file, overrides);
}

LoadedDiagram LoadPart(const fs::path& file, const std::vector<std::string>& systems,
                       const std::vector<files::Override>& overrides,
                       const files::Catalogue& catalogue) {
  if (systems.empty()) throw ConfigError("part: got no system; expected at least one");
  return Loader(file, catalogue, systems).Load(file, overrides);
}

}  // namespace oca::loading
