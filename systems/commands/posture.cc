// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/posture.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {

std::shared_ptr<const robot::RobotModel> RobotOfPostures(const ModelSet& models,
                                                         const std::string& name) {
  if (!name.empty()) return MovableModel(models, name);
  const auto only = models.HasOnly() ? models.Get(name) : nullptr;
  return only != nullptr && only->num_positions() > 0 ? only : nullptr;
}

PerComponent NumbersOf(const Posture& posture, const robot::RobotModel* model,
                       const Eigen::VectorXd& before, const std::string& where) {
  if (const PerComponent* const numbers = posture.numbers()) return *numbers;
  const auto* const state = std::get_if<std::string>(&posture.said);
  if (model == nullptr) {
    throw ConfigError(
        fmt::format("{}: got {}; expected numbers, or the key `model` to say whose "
                    "they are",
                    where, state == nullptr ? "names of joints" : "'" + *state + "'"));
  }
  const Eigen::VectorXd q = before.size() == 0 ? robot::ZeroPosture(*model) : before;
  try {
    if (q.size() != model->num_positions()) {
      throw models::ModelError(fmt::format("comes after a point of {} numbers; expected {}",
                                           q.size(), robot::OneAJoint(*model)));
    }
    return state == nullptr
               ? robot::WithPositions(*model, std::get<robot::NamedPositions>(posture.said), q)
               : robot::WithState(*model, *state, q);
  } catch (const models::ModelError& error) {
    throw ConfigError(fmt::format("{}: {}", where, error.what()));
  }
}

}  // namespace oca::systems

namespace oca {
namespace {

using nlohmann::ordered_json;
using systems::Posture;

class PostureType final : public ParamType {
 public:
  std::string Name() const override { return "list of numbers, name of a state or map of joints"; }
  void Read(const Value& value, const FieldInfo& field, const std::string& where, void* target,
            Problems& problems) const override {
    Posture& posture = *static_cast<Posture*>(target);
    double number = 0.0;
    if (value.string() != nullptr) {
      posture = *value.string();
    } else if (value.map() != nullptr) {
      ReadJoints(value, field, where, posture, problems);
    } else if (value.list() != nullptr || value.number(number)) {
      PerComponent numbers;
      Problems own;
      Numbers().Read(value, field, where, &numbers, own);
      problems.Add(own);
      if (own.empty()) posture = std::move(numbers);
    } else {
      problems.Add(value.location(),
                   fmt::format("{}: got {}; expected a {}", where, value.Show(), Name()));
    }
  }
  void Check(const void* value, const FieldInfo& field, const std::string& where,
             std::vector<std::string>& problems) const override {
    const Posture& posture = *static_cast<const Posture*>(value);
    if (const PerComponent* const numbers = posture.numbers()) {
      Numbers().Check(numbers, field, where, problems);
    } else if (const auto* const joints = std::get_if<robot::NamedPositions>(&posture.said)) {
      for (const auto& [name, position] : *joints) {
        ParamTypeOf<double>().Check(&position, field, fmt::format("{}.{}", where, name), problems);
      }
    }
  }
  ordered_json ToJson(const void* value) const override {
    const Posture& posture = *static_cast<const Posture*>(value);
    if (const PerComponent* const numbers = posture.numbers()) return Numbers().ToJson(numbers);
    if (const auto* const state = std::get_if<std::string>(&posture.said)) return *state;
    ordered_json joints = ordered_json::object();
    for (const auto& [name, position] : std::get<robot::NamedPositions>(posture.said)) {
      joints[name] = ParamTypeOf<double>().ToJson(&position);
    }
    return joints;
  }
  ordered_json Schema(const FieldInfo& field) const override {
    ordered_json schema = Numbers().Schema(field);
    schema["type"] = {"number", "array", "string", "object"};
    schema["additionalProperties"] = ParamTypeOf<double>().Schema(field);
    return schema;
  }

 private:
  static const ParamType& Numbers() { return ParamTypeOf<PerComponent>(); }

  static void ReadJoints(const Value& value, const FieldInfo& field, const std::string& where,
                         Posture& posture, Problems& problems) {
    robot::NamedPositions joints;
    for (const Value::Entry& entry : *value.map()) {
      joints.emplace_back(entry.key, 0.0);
      ParamTypeOf<double>().Read(entry.value, field, where + "." + entry.key, &joints.back().second,
                                 problems);
    }
    posture = std::move(joints);
  }
};

}  // namespace

template <>
const ParamType& ParamTypeOf<systems::Posture>() {
  static const PostureType type;
  return type;
}

}  // namespace oca
