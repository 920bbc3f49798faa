// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sampling/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "oca/diagrams/files/expression.h"
#include "oca/diagrams/files/run_params.h"
#include "oca/diagrams/sampling/acceptance.h"
#include "oca/diagrams/sampling/distribution.h"
#include "oca/diagrams/sampling/random_obstacles.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::sampling {
namespace {

constexpr int kTries = 10000;

Value* Find(Value* map, const std::string& key) {
  if (map == nullptr || map->map() == nullptr) return nullptr;
  for (Value::Entry& entry : *map->map()) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

Value FindOrNull(const Value& map, const char* key) {
  const Value* const found = map.Find(key);
  return found == nullptr ? Value({}, map.location()) : *found;
}

/// `map` with nothing but these keys.
Value Only(const Value& map, const std::vector<std::string>& keys) {
  Value::Map only;
  for (const Value::Entry& entry : *map.map()) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) only.push_back(entry);
  }
  return Value(std::move(only), map.location());
}

class Sampler {
 public:
  Sampler(const std::vector<files::Override>& overrides, const files::Catalogue& catalogue,
          Value& document, Problems& problems)
      : catalogue_(catalogue), document_(document), problems_(problems) {
    const Value* const written = document_.Find("sampling");
    if (written == nullptr || written->null()) return;
    const Value section = Resolved(*written);
    if (!CheckKeys(section)) return;
    for (const files::Override& change : overrides) overridden_.push_back(change.path);
    ReadDraws(section);
    // Its numbers may use what is drawn: here only the names count, and what is wrong with them.
    acceptance_.emplace(FindOrNull(section, "accept"), problems_);
    CheckName("models", acceptance_->names().model);
    CheckName("systems", acceptance_->names().request);
    CheckName("systems", acceptance_->names().obstacles);
    ReadSeed();
  }

  Scenario Draw() {
    Scenario scenario;
    if (!acceptance_ || !problems_.empty()) return scenario;
    Value* const parameters = Find(&document_, "parameters");
    for (int k = 0; k < tries_; ++k) {
      const std::uint64_t seed = models::Random::Seed(seed_, static_cast<std::uint64_t>(k));
      scenario.parameters.clear();
      for (const auto& [name, location, distribution] : draws_) {
        models::Random random(models::Random::Seed(seed, name));
        Value& parameter = *Find(parameters, name);
        parameter = distribution.Draw(random, location);
        scenario.parameters.push_back({name, location, parameter});
      }
      if (Try(seed, scenario) || !problems_.empty()) {
        scenario.tries = k + 1;
        std::erase_if(*document_.map(), [](const auto& entry) { return entry.key == "sampling"; });
        return scenario;
      }
    }
    problems_.Add(accept_location_,
                  fmt::format("sampling.accept: no scenario of seed {} in {} tries; refused: {}; "
                              "expected conditions that can be met",
                              seed_, tries_, acceptance_->Refusals()));
    return scenario;
  }

 private:
  struct NamedDraw {
    std::string name;
    Location location;
    Distribution distribution;
  };

  /// With the present parameters.
  Value Resolved(const Value& value) {
    return files::Expressions(FindOrNull(document_, "parameters"), problems_).Resolve(value);
  }

  bool CheckKeys(const Value& section) {
    if (section.map() == nullptr) {
      problems_.Add(section.location(),
                    fmt::format("sampling: got {}; expected a map", section.Show()));
      return false;
    }
    static const std::vector<std::string> kKeys{"draw", "obstacles", "accept", "tries"};
    for (const Value::Entry& entry : *section.map()) {
      if (std::find(kKeys.begin(), kKeys.end(), entry.key) != kKeys.end()) continue;
      problems_.Add(entry.location,
                    fmt::format("sampling.{}: unknown key{}; known: draw, obstacles, accept, tries",
                                entry.key, DidYouMean(entry.key, kKeys)));
    }
    const Value* const accept = section.Find("accept");
    accept_location_ = accept == nullptr ? section.location() : accept->location();
    if (const Value* const tries = section.Find("tries")) {
      const std::int64_t* const count = tries->integer();
      if (count == nullptr || *count < 1 || *count > 10000000) {
        problems_.Add(tries->location(),
                      fmt::format("sampling.tries: got {}; expected a whole number from 1 to 1e7",
                                  tries->Show()));
      } else {
        tries_ = static_cast<int>(*count);
      }
    }
    return true;
  }

  void CheckName(const char* section, const std::string& name) {
    std::vector<std::string> known;
    const Value* const map = document_.Find(section);
    if (map != nullptr && map->map() != nullptr) {
      for (const Value::Entry& entry : *map->map()) known.push_back(entry.key);
    }
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    problems_.Add(accept_location_, fmt::format("sampling.accept: no '{}' in {}{}", name, section,
                                                DidYouMean(name, known)));
  }

  void ReadDraws(const Value& section) {
    const Value* const draws = section.Find("draw");
    if (draws == nullptr || draws->null()) return;
    if (draws->map() == nullptr) {
      problems_.Add(draws->location(),
                    fmt::format("sampling.draw: got {}; expected a map of parameters and what they "
                                "are drawn from",
                                draws->Show()));
      return;
    }
    for (const Value::Entry& entry : *draws->map()) {
      const Distribution distribution(entry.value, "sampling.draw." + entry.key, problems_);
      if (!CheckParameter(entry)) continue;
      const std::string path = "parameters." + entry.key;
      if (std::find(overridden_.begin(), overridden_.end(), path) != overridden_.end()) continue;
      draws_.push_back({entry.key, entry.value.location(), distribution});
    }
  }

  bool CheckParameter(const Value::Entry& draw) {
    const Value* const parameters = document_.Find("parameters");
    std::vector<std::string> known;
    if (parameters != nullptr && parameters->map() != nullptr) {
      for (const Value::Entry& entry : *parameters->map()) {
        if (entry.key == draw.key) return true;
        known.push_back(entry.key);
      }
    }
    problems_.Add(draw.location, fmt::format("sampling.draw.{}: no parameter '{}'{}", draw.key,
                                             draw.key, DidYouMean(draw.key, known)));
    return false;
  }

  void ReadSeed() {
    files::SimulatorParams simulator;
    Problems own;
    if (const Value* const value = document_.Find("simulator")) {
      ReadFields(Resolved(*value), FieldsOf<files::SimulatorParams>(), "simulator", &simulator,
                 own);
    }
    problems_.Add(own);
    seed_ = static_cast<std::uint64_t>(simulator.seed);
  }

  /// What the geometry of the scenario depends on, with the present parameters.
  Value ResolvedTask() {
    const TaskNames names = acceptance_->names();
    Value task = Only(document_, {"simulator", "packages", "models", "systems"});
    if (Value* const models = Find(&task, "models");
        models != nullptr && models->map() != nullptr) {
      *models = Only(*models, {names.model});
    }
    if (Value* const systems = Find(&task, "systems");
        systems != nullptr && systems->map() != nullptr) {
      *systems = Only(*systems, {names.request, names.obstacles});
    }
    task.map()->push_back({"sampling", {}, *document_.Find("sampling")});
    return Resolved(task);
  }

  /// Whether the scenario with the present parameters is accepted; its obstacles are then those of
  /// the document.
  bool Try(std::uint64_t seed, Scenario& scenario) {
    Value root = ResolvedTask();
    if (!problems_.empty()) return false;
    try {
      const TaskNames names = acceptance_->names();
      TaskGeometry task(root, names, catalogue_, cache_, problems_);
      if (!problems_.empty()) return false;
      Value::List drawn;
      if (const Value* const obstacles = root.Find("sampling")->Find("obstacles")) {
        const RandomObstacles random(*obstacles, problems_);
        if (!problems_.empty()) return false;
        drawn = random.Draw(models::Random::Seed(seed, "obstacles"), task, obstacles->location());
        Append(root, names.obstacles, drawn);
      }
      task.SetObstacles(root, problems_);
      if (!problems_.empty()) return false;
      if (!acceptance_->Accepts(task, models::Random::Seed(seed, "planner"))) return false;
      if (!drawn.empty()) Append(document_, names.obstacles, drawn);
      scenario.obstacles = static_cast<int>(drawn.size());
      return true;
    } catch (const Error& error) {
      problems_.Add(accept_location_, fmt::format("sampling: {}", error.what()));
    }
    return false;
  }

  /// Adds obstacles to those of a system.
  void Append(Value& root, const std::string& system, const Value::List& obstacles) {
    Value* const params = Find(Find(&root, "systems"), system);
    if (params == nullptr || params->map() == nullptr) return;  // a problem to all that follows
    Value* list = Find(params, "obstacles");
    if (list == nullptr) {
      params->map()->push_back({"obstacles", params->location(), {}});
      list = &params->map()->back().value;
    }
    if (list->null()) *list = Value(Value::List{}, list->location());
    if (list->list() == nullptr) {
      problems_.Add(list->location(), fmt::format("systems.{}.obstacles: got {}; expected a list",
                                                  system, list->Show()));
      return;
    }
    list->list()->insert(list->list()->end(), obstacles.begin(), obstacles.end());
  }

  const files::Catalogue& catalogue_;
  Value& document_;
  Problems& problems_;
  std::vector<std::string> overridden_;  // paths
  std::vector<NamedDraw> draws_;
  std::optional<Acceptance> acceptance_;
  Location accept_location_;
  ModelCache cache_;
  std::uint64_t seed_{0};
  int tries_{kTries};
};

}  // namespace

Scenario DrawScenario(const std::vector<files::Override>& overrides,
                      const files::Catalogue& catalogue, Value& document, Problems& problems) {
  return Sampler(overrides, catalogue, document, problems).Draw();
}

nlohmann::ordered_json SamplingSchema() {
  using nlohmann::ordered_json;
  const auto schema = [](const ParamType& type, const char* meaning) {
    ordered_json result = type.Schema({});
    result["description"] = meaning;
    return result;
  };
  const ordered_json draw{{"type", "object"},
                          {"additionalProperties", schema(ParamTypeOf<DistributionParams>(),
                                                          "what a parameter is drawn from")},
                          {"description", "parameters of the file that the seed sets, by name"}};
  const ordered_json tries{{"type", "integer"},
                           {"minimum", 1},
                           {"default", kTries},
                           {"description", "draws until none that is accepted is an error"}};
  return ordered_json{{"type", "object"},
                      {"additionalProperties", false},
                      {"properties",
                       {{"draw", draw},
                        {"obstacles", schema(ParamTypeOf<RandomObstacleParams>(),
                                             "added to those of systems.obstacles")},
                        {"accept", schema(ParamTypeOf<AcceptParams>(),
                                          "all must hold, else the scenario is drawn again")},
                        {"tries", tries}}}};
}

}  // namespace oca::sampling
