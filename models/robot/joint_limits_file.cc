// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/joint_limits_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/xml_file.h"
#include "oca/models/robot/xml_numbers.h"
#include "oca/models/yaml_events.h"

namespace oca::robot {
namespace {

using models::internal::YamlError;
using models::internal::YamlMark;

constexpr const char* kSection = "joint_limits";
constexpr double kLeastEffort = 1e-6;  // N m, N; as little as nothing

struct Scalar {
  std::string text;
  int line;
};
/// What a joint is said to have, by key.
using Said = std::map<std::string, Scalar>;
struct SaidOfJoint {
  int line;
  Said said;
};

/// Takes JOINT.KEY: TEXT below `joint_limits`, wherever that stands.
class LimitsReader final : public models::internal::YamlEvents {
 public:
  std::map<std::string, SaidOfJoint> joints;
  bool found{false};

  void OnNull(const YamlMark& mark, std::size_t /*anchor*/) override { Put("", mark); }
  void OnAlias(const YamlMark& mark, std::size_t /*anchor*/) override {
    throw YamlError(mark, "an alias; expected the value itself");
  }
  void OnScalar(const Node& node, const std::string& value) override { Put(value, node.mark); }
  void OnListStart(const Node& node) override { Open(node.mark, false); }
  void OnListEnd() override { Close(); }
  void OnMapStart(const Node& node) override { Open(node.mark, true); }
  void OnMapEnd() override { Close(); }

 private:
  struct Frame {
    bool map;
    bool keyed{false};
    std::string key{};
    int line{0};  // of the key
  };

  /// Of the key that the frames above joint and key have; whether these two are all below it.
  bool InSection(std::size_t below) const {
    return stack_.size() > below && stack_[stack_.size() - 1 - below].key == kSection &&
           std::all_of(stack_.begin(), stack_.end(), [](const Frame& frame) { return frame.map; });
  }

  void Open(const YamlMark& mark, bool map) {
    if (stack_.size() >= static_cast<std::size_t>(models::internal::kDeepestYaml)) {
      throw YamlError(mark,
                      fmt::format("nested deeper than {} levels", models::internal::kDeepestYaml));
    }
    if (!stack_.empty() && stack_.back().map && !stack_.back().keyed) {
      throw YamlError(mark, "a key that is a list or a map; expected a name");
    }
    if (InSection(0)) {
      if (!map) throw YamlError(mark, "joint_limits; got a list; expected a map of joints");
      found = true;
    }
    if (InSection(1)) {
      const std::string& joint = stack_.back().key;
      if (!map || !joints.emplace(joint, SaidOfJoint{stack_.back().line, {}}).second) {
        throw YamlError(mark, fmt::format("joint '{}'; got {}; expected a map of its limits, once",
                                          joint, map ? "it twice" : "a list"));
      }
    }
    stack_.push_back({map});
  }

  void Close() {
    stack_.pop_back();
    if (!stack_.empty()) stack_.back().keyed = false;
  }

  void Put(const std::string& text, const YamlMark& mark) {
    if (stack_.empty()) return;
    Frame& top = stack_.back();
    if (top.map && !std::exchange(top.keyed, true)) {
      top.key = text;
      top.line = mark.line;
      return;
    }
    top.keyed = false;
    if (InSection(1)) {
      throw YamlError(
          mark, fmt::format("joint '{}'; got '{}'; expected a map of its limits", top.key, text));
    }
    if (!InSection(2)) return;
    Said& said = joints.at(stack_[stack_.size() - 2].key).said;
    if (said.emplace(top.key, Scalar{text, mark.line}).second) return;
    throw YamlError(mark, fmt::format("{}; got it twice; expected it once", top.key));
  }

  std::vector<Frame> stack_;
};

const std::vector<std::string>& KnownKeys() {
  static const std::vector<std::string> keys{"has_position_limits",
                                             "min_position",
                                             "max_position",
                                             "has_velocity_limits",
                                             "min_velocity",
                                             "max_velocity",
                                             "has_effort_limits",
                                             "max_effort",
                                             "has_acceleration_limits",
                                             "min_acceleration",
                                             "max_acceleration",
                                             "has_deceleration_limits",
                                             "max_deceleration",
                                             "has_jerk_limits",
                                             "min_jerk",
                                             "max_jerk",
                                             "angle_wraparound",
                                             "has_soft_limits",
                                             "soft_lower_limit",
                                             "soft_upper_limit",
                                             "k_position",
                                             "k_velocity"};
  return keys;
}

/// What one joint is said to have, as numbers.
class Limits {
 public:
  Limits(const std::string& where, const std::string& joint, const SaidOfJoint& of,
         models::ModelErrors& errors)
      : where_(where), joint_(joint), of_(of), errors_(errors) {
    for (const auto& [key, scalar] : of.said) {
      const std::string meant = models::MisspeltName(key, KnownKeys());
      if (!meant.empty()) Add(scalar.line, "unknown key", key, meant);
    }
  }

  /// The number of `key`, `least` or more, if `has` is not false; then it is required if `has` is
  /// true, unless there is one of the key `or_else`.
  std::optional<double> Get(const char* has, const char* key, double least,
                            const char* or_else = "") {
    const auto said = of_.said.find(has);
    const std::optional<bool> wanted =
        said == of_.said.end() ? std::nullopt : Truth(has, said->second);
    if (wanted == false) return std::nullopt;
    const auto found = of_.said.find(key);
    if (found == of_.said.end()) {
      if (wanted && !of_.said.contains(or_else)) {
        Add(said->second.line, key, "none", fmt::format("a number, as {} is true", has));
      }
      return std::nullopt;
    }
    const auto numbers = ParseFiniteNumbers(found->second.text);
    if (!numbers || numbers->size() != 1 || !(numbers->front() >= least)) {
      Add(found->second.line, key, "'" + found->second.text + "'",
          least > kAny ? fmt::format("a number of {:g} or more", least) : "a finite number");
      return std::nullopt;
    }
    return numbers->front();
  }

  static constexpr double kAny = -kUnlimited;

 private:
  void Add(int line, const std::string& what, const std::string& got, const std::string& expected) {
    errors_.Add(fmt::format("{}:{}: joint '{}': {}; got {}; expected {}", where_, line, joint_,
                            what, got, expected));
  }

  /// None of what is neither.
  std::optional<bool> Truth(const char* key, const Scalar& scalar) {
    for (const char* yes : {"true", "True", "TRUE", "1"}) {
      if (scalar.text == yes) return true;
    }
    for (const char* no : {"false", "False", "FALSE", "0"}) {
      if (scalar.text == no) return false;
    }
    Add(scalar.line, key, "'" + scalar.text + "'", "true or false");
    return std::nullopt;
  }

  const std::string& where_;
  const std::string& joint_;
  const SaidOfJoint& of_;
  models::ModelErrors& errors_;
};

std::optional<double> Lesser(std::optional<double> a, std::optional<double> b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

void Narrow(const std::optional<double>& limit, double& of_joint) {
  if (limit) of_joint = std::min(of_joint, *limit);
}

/// An own limit of 0 counts as none: see LimitsOfPositions.
void NarrowGiven(const std::optional<double>& limit, double& of_joint) {
  if (limit) of_joint = of_joint == 0.0 ? *limit : std::min(of_joint, *limit);
}

}  // namespace

JointLimitsFile::JointLimitsFile(const std::filesystem::path& file) : where_(file.string()) {
  LimitsReader reader;
  try {
    models::internal::ReadYamlEvents(ReadXmlFile(file), reader);
  } catch (const YamlError& error) {
    throw models::ModelError(fmt::format("{}:{}: {}", where_, error.mark.line, error.what()));
  }
  if (!reader.found) {
    throw models::ModelError(
        fmt::format("{}: joint_limits; got none; expected a map of joints", where_));
  }
  models::ModelErrors errors;
  for (const auto& joint : reader.joints) {
    Limits limits(where_, joint.first, joint.second, errors);
    Entry& entry = entries_[joint.first];
    entry.line = joint.second.line;
    entry.lower = limits.Get("has_position_limits", "min_position", Limits::kAny, "max_position");
    entry.upper = limits.Get("has_position_limits", "max_position", Limits::kAny, "min_position");
    entry.velocity = limits.Get("has_velocity_limits", "max_velocity", kLeastVelocity);
    entry.effort = limits.Get("has_effort_limits", "max_effort", kLeastEffort);
    entry.acceleration =
        Lesser(limits.Get("has_acceleration_limits", "max_acceleration", kLeastAcceleration),
               limits.Get("has_deceleration_limits", "max_deceleration", kLeastAcceleration));
    entry.jerk = limits.Get("has_jerk_limits", "max_jerk", kLeastJerk);
  }
  errors.Throw();
}

void JointLimitsFile::TightenRanges(std::vector<Joint>& joints) const {
  std::vector<std::string> names;
  for (const Joint& joint : joints) names.push_back(joint.name.text());
  models::ModelErrors errors;
  for (const auto& [name, entry] : entries_) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      errors.Add(
          fmt::format("{}:{}: unknown joint; got '{}'; expected a joint of the robot, nearest is "
                      "'{}'",
                      where_, entry.line, name, models::NearestName(name, names)));
      continue;
    }
    Joint& joint = joints[static_cast<std::size_t>(found - names.begin())];
    if (!joint.movable()) continue;
    const double lower = std::max(joint.lower_limit, entry.lower.value_or(-kUnlimited));
    const double upper = std::min(joint.upper_limit, entry.upper.value_or(kUnlimited));
    if (lower > upper) {
      errors.Add(fmt::format(
          "{}:{}: joint '{}': position limits; got {} to {}; expected a part of {} to {}, those of "
          "the robot",
          where_, entry.line, name, entry.lower.value_or(-kUnlimited),
          entry.upper.value_or(kUnlimited), joint.lower_limit, joint.upper_limit));
      continue;
    }
    joint.lower_limit = lower;
    joint.upper_limit = upper;
  }
  errors.Throw();
}

void JointLimitsFile::TightenRates(std::vector<Joint>& joints) const {
  for (Joint& joint : joints) {
    const auto found = entries_.find(joint.name.text());
    if (found == entries_.end() || !joint.movable()) continue;
    const Entry& entry = found->second;
    NarrowGiven(entry.velocity, joint.velocity_limit);
    NarrowGiven(entry.effort, joint.effort_limit);
    Narrow(entry.acceleration, joint.acceleration_limit);
    Narrow(entry.jerk, joint.jerk_limit);
  }
}

}  // namespace oca::robot
