// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "oca/diagrams/foresight/foresight.h"
#include "oca/diagrams/foresight/reference_length.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/blind_spots.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/models/planning/clairvoyant.h"
#include "oca/models/planning/first_sight.h"
#include "oca/models/planning/motion_way.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

using nlohmann::ordered_json;

constexpr double kArrived = 0.01;  // rad, m; of all joints

foresight::Foresight SceneOf(const loading::LoadedDiagram& loaded, const std::string& model,
                             double duration) {
  try {
    return {*loaded.diagram, loaded.models, model, duration};
  } catch (const ConfigError& error) {
    throw ConfigError(
        fmt::format("{}: {}{}", loaded.file, error.what(),
                    model.empty() && loaded.models.all().size() > 1 ? ", by --model NAME" : ""));
  }
}

ordered_json Describe(const robot::RobotModel& model, const planning::ClairvoyantPlan& plan) {
  const planning::MotionVerdict& verdict = plan.verdict;
  const bool near = verdict.min_distance < planning::kClairvoyantReach;
  ordered_json json{{"clear", verdict.clear()},
                    {"min_distance", verdict.min_distance},
                    {"min_distance_pair", nullptr},
                    {"min_distance_time", nullptr},
                    {"arrived", verdict.final_error <= kArrived},
                    {"final_error", verdict.final_error},
                    {"position", verdict.position},
                    {"speed", verdict.speed},
                    {"acceleration", verdict.acceleration},
                    {"speed_judged", model.velocity_limits().allFinite()},
                    {"acceleration_judged", model.acceleration_limits().allFinite()}};
  if (model.jerk_limits().array().isFinite().any()) json["jerk_judged"] = false;
  if (near) {
    json["min_distance_pair"] = {verdict.link.text(), verdict.body.text()};
    json["min_distance_time"] = verdict.time;
  }
  json["start"] = planning::kBandStartNames[static_cast<std::size_t>(plan.start)];
  json["tries"] = plan.tries;
  return json;
}

ordered_json OrNull(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json();
}

/// `first`: of several, which all have the same warnings to tell.
ordered_json Plan(const PlanArguments& arguments, const files::Catalogue& catalogue, int seed,
                  bool first) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<files::Override> overrides;
  for (const std::string& text : arguments.overrides) {
    overrides.push_back(files::Override::Parse(text));
  }
  if (seed >= 0) overrides.push_back({"simulator.seed", std::to_string(seed)});
  const auto loaded = loading::LoadDiagram(arguments.file, overrides, catalogue);
  if (first) {
    for (const std::string& warning : loaded.warnings) Tell("{}\n", warning);
  }
  const double duration = arguments.duration.value_or(loaded.simulator.duration);
  const foresight::Foresight scene = SceneOf(loaded, arguments.model, duration);
  planning::ClairvoyantTask task = scene.Task();
  task.seed = static_cast<std::uint64_t>(loaded.simulator.seed);
  task.starts = arguments.starts;
  using Seconds = std::chrono::duration<double>;
  const auto search_start = std::chrono::steady_clock::now();
  const auto plan = planning::PlanClairvoyantly(scene.model(), task);
  const Seconds search = std::chrono::steady_clock::now() - search_start;
  ordered_json json{{"seed", loaded.simulator.seed}};
  json.update(Describe(*scene.model(), plan));
  const planning::MotionWay way = planning::WayOf(task, plan.curve, scene.start().size(), kArrived);
  json["path_length"] = way.length;
  json["time_to_goal"] = OrNull(way.time);
  if (arguments.reference) {
    json["reference_length"] = OrNull(foresight::ReferenceLength(scene, *arguments.reference));
  }
  const planning::FirstSight sight = planning::LookAtFirstSight(scene.model(), task);
  json["first_sight"] = OrNull(sight.time);
  json["too_late"] = sight.too_late;
  json["model"] = scene.model_name();
  json["judge"] = scene.judge();
  json["sees"] = scene.sees();
  json["not_seen"] = runs::BlindSpots(loaded);
  json["search_seconds"] = search.count();
  json["seconds"] = Seconds(std::chrono::steady_clock::now() - start).count();
  return json;
}

}  // namespace

const char* PlanFooter() {
  return R"(Prints a JSON object a line, one for each sample:
  seed                 of the scenario
  clear                a motion was found that touches nothing and keeps the limits of the joints
  min_distance         m, of that motion, or of the best one found; every millisecond, 0.05 at most
  min_distance_pair    [link, obstacle]; null if everything is farther
  min_distance_time    s
  arrived              it ends within 0.01 of the request
  final_error          rad, m; largest distance of a joint from the request at the end
  position             largest share of the way from the middle of a joint's range to its limit
  speed, acceleration  largest shares of the limits; 1 is at the limit
  speed_judged, acceleration_judged
                       all joints of the model have such limits; false: judged without
  jerk_judged          false, if the model has limits of the jerk: they are not looked at
  start                what the motion was made from: request, pause, detour, random, path, escape
  tries                motions that it took; 0: the request itself is clear
  path_length          of the joints along that motion, the 2-norm of each step, summed
  time_to_goal         s; from which on it is within 0.01 of the request's end; null: it is not
  reference_length     of the shortest way found in ten searches of --reference seconds, seeds 0 to 9,
                       1 mm from everything; null if none was found, or something moves
  first_sight          s, at which something is first seen to move; null if nothing does
  too_late             true: nobody who sees it then can evade, proven
  model, judge         the robot, and the system by which a run of the file is judged
  sees                 what was looked at: all that the judge's distance block sees, and no more
  not_seen             what that block does not look at: links without collision shapes, other models
  search_seconds       of computing the motion
  seconds              of computing, loading included

Exit status: 0 if all samples are clear, 3 if for one of them no clear motion was found, 2 if the
file is bad or holds what nobody can know beforehand, 64 for wrong usage. More: docs/how-to/plan.md.)";
}

int PlanCommand(const PlanArguments& arguments, const files::Catalogue& catalogue) {
  bool all_clear = true;
  try {
    const int first = arguments.seed.value_or(-1);
    for (int i = 0; i < arguments.samples; ++i) {
      const auto plan = Plan(arguments, catalogue, first < 0 ? first : first + i, i == 0);
      WriteData(oca::internal::JsonText(plan) + "\n");
      std::fflush(stdout);
      all_clear = all_clear && plan.at("clear").get<bool>();
    }
  } catch (const std::exception& error) {
    Tell("{}\n", oca::internal::Explain(error));
    return kBadInput;
  }
  return all_clear ? kFine : kExpectationNotMet;
}

}  // namespace oca::tools
