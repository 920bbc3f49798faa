// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/loader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "diagrams/catalogue.h"
#include "diagrams/expression.h"
#include "diagrams/package_paths.h"
#include "framework/dynamic_port.h"
#include "framework/error.h"
#include "framework/nearest.h"
#include "models/error.h"
#include "models/robot/urdf.h"

namespace oca::diagrams {
namespace {

namespace fs = std::filesystem;

fs::path FolderOf(const Location& location) {
  return location.file && location.line > 0 ? fs::path(*location.file).parent_path() : fs::path();
}

/// Walks the resolved tree section by section and collects every problem on the way.
class Loader {
 public:
  explicit Loader(const fs::path& file) { loaded_.file = file.string(); }

  LoadedDiagram Load(const fs::path& file, const std::vector<Override>& overrides) {
    const Value document = LoadDocument(file, overrides, problems_);
    problems_.Throw();
    CheckKeys(document);
    root_ = Resolve(document);
    ReadNames();
    ReadSimulator();
    ReadPackages();
    ReadModels();
    ReadSystems();
    ReadConnections();
    CheckTolerances();
    problems_.Throw();
    Build();
    ReadRecord();
    ReadExpectations();
    problems_.Throw();
    return std::move(loaded_);
  }

 private:
  void CheckKeys(const Value& document) {
    std::vector<std::string> known;
    for (const Section& section : Sections()) known.emplace_back(section.key);
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
    Expressions expressions(parameters == nullptr ? Value() : *parameters, problems_);
    Value::Map resolved;
    for (const Value::Entry& entry : *document.map()) {
      if (entry.key == "parameters") continue;
      resolved.push_back({entry.key, entry.location, expressions.Resolve(entry.value)});
    }
    return Value(std::move(resolved), document.location());
  }

  /// The section as a map; an empty one, with a problem, if it is something else.
  const Value::Map& Map(const char* key) {
    static const Value::Map kEmpty;
    const Value* const value = root_.Find(key);
    if (value == nullptr || value->null()) return kEmpty;
    if (value->map() != nullptr) return *value->map();
    problems_.Add(value->location(), fmt::format("{}: got {}; expected a map", key, value->Show()));
    return kEmpty;
  }

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
      ReadFields(*value, FieldsOf<SimulatorParams>(), "simulator", &loaded_.simulator, problems_);
    }
    const SimulatorParams& read = loaded_.simulator;
    IntegratorOptions& options = loaded_.integrator;
    options.integrator = read.integrator;
    options.relative_tolerance = read.relative_tolerance;
    options.absolute_tolerance = read.absolute_tolerance;
    if (read.max_step) options.max_step = *read.max_step;
    options.fixed_step = read.fixed_step;
    options.max_steps = read.max_steps;
    for (const Value::Entry& entry : Map("simulator_tolerances")) {
      ToleranceParams params;
      ReadFields(entry.value, FieldsOf<ToleranceParams>(), "simulator_tolerances." + entry.key,
                 &params, problems_);
      options.tolerances[entry.key] = {params.relative, params.absolute};
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

  void ReadPackages() {
    for (const Value::Entry& entry : Map("packages")) {
      if (entry.value.string() == nullptr) {
        problems_.Add(entry.value.location(), fmt::format("packages.{}: got {}; expected a folder",
                                                          entry.key, entry.value.Show()));
        continue;
      }
      const fs::path folder = *entry.value.string();
      packages_[entry.key] =
          folder.is_absolute() ? folder : FolderOf(entry.value.location()) / folder;
    }
  }

  fs::path Resolve(const std::string& name, const Location& location) const {
    return name.empty() ? fs::path() : ResolvePath(name, FolderOf(location), packages_);
  }

  void ReadModels() {
    for (const Value::Entry& entry : Map("models")) {
      const std::string where = "models." + entry.key;
      ModelParams params;
      Problems own;
      ReadFields(entry.value, FieldsOf<ModelParams>(), where, &params, own);
      if (!own.empty()) {
        problems_.Add(own);
        failed_models_ = true;
        continue;
      }
      try {
        models::LoadOptions options;
        options.X_WB = params.base_pose.Pose(where + ".base_pose");
        options.srdf = Resolve(params.srdf, LocationOf(entry.value, "srdf"));
        if (params.acceleration_limits) {
          options.acceleration_limits = params.acceleration_limits->values();
        }
        if (params.jerk_limits) options.jerk_limits = params.jerk_limits->values();
        options.find_package = [this](const std::string& package) -> fs::path {
          const auto found = packages_.find(package);
          return found == packages_.end() ? fs::path() : found->second;
        };
        options.package_directories = PackageFolders();
        loaded_.models.Add(entry.key,
                           std::make_shared<const models::RobotModel>(models::LoadUrdf(
                               Resolve(params.urdf, LocationOf(entry.value, "urdf")), options)));
      } catch (const std::runtime_error& error) {
        failed_models_ = true;
        problems_.Add(entry.location, fmt::format("{}: {}", where, error.what()));
      }
    }
  }

  static Location LocationOf(const Value& map, const char* key) {
    const Value* const value = map.Find(key);
    return value == nullptr ? map.location() : value->location();
  }

  /// Keys named `file` are paths relative to the file they stand in.
  Value ResolveFiles(const Value& value) {
    if (value.list() != nullptr) {
      Value::List list;
      for (const Value& item : *value.list()) list.push_back(ResolveFiles(item));
      return Value(std::move(list), value.location());
    }
    if (value.map() == nullptr) return value;
    Value::Map map;
    for (const Value::Entry& entry : *value.map()) {
      Value inner = ResolveFiles(entry.value);
      if (entry.key == "file" && inner.string() != nullptr) {
        try {
          inner = Value(Resolve(*inner.string(), inner.location()).string(), inner.location());
        } catch (const ConfigError& error) {
          problems_.Add(inner.location(), error.what());
        }
      }
      map.push_back({entry.key, entry.location, std::move(inner)});
    }
    return Value(std::move(map), value.location());
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
    try {
      const CatalogueRow& row = FindRow(*type->string());
      const Value params = ResolveFiles(Value(std::move(rest), entry.value.location()));
      // A model that did not load has been reported; its users would only repeat it.
      if (failed_models_ && row.needs_models) return;
      auto system = row.make(params, where, loaded_.models, problems_);
      if (!system) return;
      locations_[entry.key] = entry.location;
      systems_[entry.key] = &builder_.AddSystem(entry.key, std::move(system));
      loaded_.systems.push_back({entry.key, row.type});
    } catch (const WiringError& error) {
      problems_.Add(entry.location, fmt::format("{}: {}", where, error.what()));
    } catch (const ConfigError& error) {
      problems_.Add(type->location(), fmt::format("{}.type: {}", where, error.what()));
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
      const bool good =
          Locate(*from, item.location(),
                 [&](const System& system) { output = system.FindOutput(from->port); }) &
          Locate(*to, item.location(),
                 [&](const System& system) { input = system.FindInput(to->port); });
      if (!good) return;
      builder_.ConnectPorts(output, input);
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

  void Build() {
    try {
      loaded_.diagram = builder_.Build();
    } catch (const WiringError& error) {
      for (const std::string& problem : error.problems) problems_.Add(Place(problem), problem);
    }
    for (const auto& block : loaded_.systems) {
      if (block.type != "MotionMetrics") continue;
      loaded_.metrics.emplace_back(block.name, systems_.at(block.name)->FindOutput("metrics"));
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

  /// All outputs whose `system.output` matches the pattern.
  std::vector<std::pair<std::string, OutputHandle>> Match(const std::string& pattern) const {
    std::vector<std::pair<std::string, OutputHandle>> found;
    for (const auto& block : loaded_.systems) {
      for (const System::OutputInfo& output : systems_.at(block.name)->outputs()) {
        const std::string name = block.name + "." + output.name;
        if (fnmatch(pattern.c_str(), name.c_str(), 0) != 0) continue;
        found.emplace_back(name, systems_.at(block.name)->FindOutput(output.name));
      }
    }
    return found;
  }

  std::vector<std::string> AllOutputs() const {
    std::vector<std::string> names;
    for (const auto& output : Match("*")) names.push_back(output.first);
    return names;
  }

  std::optional<Period> ReadRate(const Value& value, const std::string& where) {
    double hertz = 0.0;
    if (!value.number(hertz) || !(hertz > 0.0)) {
      if (!value.null()) {
        problems_.Add(value.location(),
                      fmt::format("{}: got {}; expected a rate > 0 Hz", where, value.Show()));
      }
      return std::nullopt;
    }
    try {
      const Period inverse = Period::FromSeconds(hertz);
      return Period(inverse.denominator(), inverse.numerator());
    } catch (const ConfigError&) {
      problems_.Add(value.location(),
                    fmt::format("{}: got {} Hz; expected a ratio of integers", where, hertz));
      return std::nullopt;
    }
  }

  void ReadRecord() {
    for (const Value::Entry& entry : Map("record")) {
      if (entry.key == "scene") {
        ReadRate(entry.value, "record.scene");
      } else if (entry.key != "signals") {
        const std::vector<std::string> known{"signals", "scene"};
        problems_.Add(entry.location, fmt::format("record.{}: unknown key{}; known: signals, scene",
                                                  entry.key, DidYouMean(entry.key, known)));
      } else if (entry.value.map() == nullptr) {
        problems_.Add(entry.value.location(),
                      fmt::format("record.signals: got {}; expected a map from names to rates",
                                  entry.value.Show()));
      } else {
        for (const Value::Entry& signal : *entry.value.map()) ReadSignal(signal);
      }
    }
  }

  void ReadSignal(const Value::Entry& entry) {
    const auto matches = Match(entry.key);
    if (matches.empty()) {
      problems_.Add(entry.location, fmt::format("record.signals: no output matches '{}'{}",
                                                entry.key, DidYouMean(entry.key, AllOutputs())));
    }
    const auto period = ReadRate(entry.value, "record.signals." + entry.key);
    if (!period) return;
    for (const auto& [name, output] : matches) {
      const bool taken = std::any_of(loaded_.record.begin(), loaded_.record.end(),
                                     [&](const auto& other) { return other.name == name; });
      if (!taken) loaded_.record.push_back({name, output, *period});
    }
  }

  void ReadExpectations() {
    for (const Value::Entry& entry : Map("expect")) {
      Expectation expectation;
      expectation.name = entry.key;
      const std::string where = "expect." + entry.key;
      ReadFields(entry.value, FieldsOf<ExpectParams>(), where, &expectation.bound, problems_);
      const ExpectParams& bound = expectation.bound;
      if (!bound.at_least && !bound.at_most && !bound.equal) {
        problems_.Add(entry.location,
                      where + ": no bound; expected at_least, at_most or equal (with within)");
      }
      if (bound.at_least && bound.at_most && *bound.at_least > *bound.at_most) {
        problems_.Add(entry.location, fmt::format("{}: no value is at least {} and at most {}",
                                                  where, *bound.at_least, *bound.at_most));
      }
      if (bound.at && *bound.at > loaded_.simulator.duration) {
        problems_.Add(entry.location,
                      fmt::format("{}.at: got {} s; expected at most the duration {} s", where,
                                  *bound.at, loaded_.simulator.duration));
      }
      if (Aim(entry.key, entry.location, expectation)) {
        loaded_.expectations.push_back(std::move(expectation));
      }
    }
  }

  /// Finds what an expectation looks at: `metric`, `system.port[i]` or `system.port.member`.
  bool Aim(const std::string& key, const Location& location, Expectation& expectation) {
    const std::string where = "expect." + key;
    if (key.find('.') == std::string::npos) {
      if (loaded_.metrics.empty()) {
        problems_.Add(location, where + ": a metric needs a system of type MotionMetrics");
        return false;
      }
      expectation.output = loaded_.metrics.front().second;
      expectation.member = key;
      return CheckMember(expectation, location);
    }
    std::string port = key;
    if (const std::size_t bracket = key.find('['); bracket != std::string::npos) {
      port = key.substr(0, bracket);
      const auto [end, error] =
          std::from_chars(key.data() + bracket + 1, key.data() + key.size(), expectation.index);
      if (error != std::errc() || end + 1 != key.data() + key.size() || *end != ']' ||
          expectation.index < 0) {
        problems_.Add(location, where + ": expected system.port[i]");
        return false;
      }
    } else if (const std::size_t dot = key.find('.', key.find('.') + 1); dot != std::string::npos) {
      port = key.substr(0, dot);
      expectation.member = key.substr(dot + 1);
    }
    const auto outputs = Match("*");
    const auto named = std::find_if(outputs.begin(), outputs.end(),
                                    [&](const auto& output) { return output.first == port; });
    if (named == outputs.end()) {
      problems_.Add(location, fmt::format("{}: no output '{}'{}", where, port,
                                          DidYouMean(port, AllOutputs())));
      return false;
    }
    expectation.output = named->second;
    if (&TypeOfPort(expectation.output) != &kVectorType) return CheckMember(expectation, location);
    if (!loaded_.diagram) return false;  // wired wrongly: lengths are not known
    const int size = VectorSize(expectation.output, loaded_.diagram->MakeContext());
    if (expectation.index < 0 && size == 1 && expectation.member.empty()) expectation.index = 0;
    if (expectation.index < 0 || expectation.index >= size) {
      problems_.Add(location,
                    fmt::format("{}: expected {}[i] with i from 0 to {}", where, port, size - 1));
      return false;
    }
    return true;
  }

  bool CheckMember(const Expectation& expectation, const Location& location) {
    const SignalType& type = TypeOfPort(expectation.output);
    std::vector<std::string> names;
    const auto memory = std::make_unique<std::byte[]>(type.size + type.align);
    void* at = memory.get();
    std::size_t space = type.size + type.align;
    std::align(type.align, type.size, at, space);
    type.construct(at);
    std::string text;
    type.write_json(at, text);
    type.destroy(at);
    const auto json = nlohmann::ordered_json::parse(text);
    if (json.is_object()) {
      for (const auto& item : json.items()) names.push_back(item.key());
    }
    if (std::find(names.begin(), names.end(), expectation.member) != names.end()) return true;
    problems_.Add(location,
                  fmt::format("expect.{}: {} has no number '{}'{}", expectation.name, type.name,
                              expectation.member, DidYouMean(expectation.member, names)));
    return false;
  }

  LoadedDiagram loaded_;
  Problems problems_;
  Value root_;
  std::map<std::string, fs::path> packages_;
  bool failed_models_{false};
  DiagramBuilder builder_;
  std::vector<std::string> system_names_;
  std::map<std::string, const System*> systems_;
  std::map<std::string, Location> locations_;
  std::map<std::string, Location> connection_locations_;
};

}  // namespace

LoadedDiagram LoadDiagram(const fs::path& file, const std::vector<Override>& overrides) {
  return Loader(file).Load(file, overrides);
}

}  // namespace oca::diagrams
