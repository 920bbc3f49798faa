// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/runs/output_files.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/models/opened_files.h"
#include "oca/models/robot/collision_check.h"
#include "oca/models/robot/srdf.h"
#include "oca/models/robot/unseen_links.h"
#include "oca/models/robot/urdf.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

using nlohmann::ordered_json;
using robot::LinkPairCheck;
using robot::PairKind;

const std::string& NameOf(const robot::RobotModel& model, int link) {
  return model.links()[link].name.text();
}

/// Names the pairs that the posture 0 has in contact, which a person should look at; empty if none.
std::string InContactAtZero(const robot::RobotModel& model,
                            const std::vector<LinkPairCheck>& pairs) {
  std::vector<std::string> names;
  for (const LinkPairCheck& pair : pairs) {
    if (pair.kind != PairKind::kDefault) continue;
    names.push_back(NameOf(model, pair.link_a) + " " + NameOf(model, pair.link_b));
  }
  if (names.empty()) return "";
  return fmt::format(
      "  in collision at the zero posture: {}; taken for by design (Default) and disabled: enable "
      "by hand what is not\n",
      fmt::join(names, ", "));
}

std::string Table(const robot::RobotModel& model, const std::vector<LinkPairCheck>& pairs,
                  const robot::CollisionSampling& sampling) {
  std::size_t width = 4;
  std::map<PairKind, int> counts;
  for (const LinkPairCheck& pair : pairs) {
    width = std::max({width, NameOf(model, pair.link_a).size(), NameOf(model, pair.link_b).size()});
    ++counts[pair.kind];
  }
  std::string text = fmt::format(
      "{}: {} pairs of links with solids, {} samples, seed {}, margin {:g} m\n",
      model.name().text(), pairs.size(), sampling.samples, sampling.seed, sampling.margin);
  text += fmt::format("  {:<{}}  {:<{}}  {:<9}  {:>8}  {:>10}\n", "link", width, "link", width,
                      "kind", "least m", "collisions");
  for (const LinkPairCheck& pair : pairs) {
    text += fmt::format("  {:<{}}  {:<{}}  {:<9}  {:>8.4f}  {:>10}\n", NameOf(model, pair.link_a),
                        width, NameOf(model, pair.link_b), width, robot::ToString(pair.kind),
                        pair.least_distance, pair.collisions);
  }
  text += fmt::format("  to check: {}; not: {} adjacent, {} always, {} never in collision\n",
                      counts[PairKind::kSometimes], counts[PairKind::kAdjacent],
                      counts[PairKind::kAlways], counts[PairKind::kNever]);
  return text + InContactAtZero(model, pairs);
}

/// Shows how far it is.
std::vector<LinkPairCheck> Look(const robot::RobotModel& model, robot::CollisionSampling sampling) {
  TaskProgress progress;
  sampling.progress = [&progress](double share) {
    progress.Show("looking at pairs of links", share);
    return true;
  };
  return robot::CheckCollisions(model, sampling);
}

ordered_json ToJson(const robot::RobotModel& model, const std::vector<LinkPairCheck>& pairs,
                    const robot::CollisionSampling& sampling) {
  ordered_json json{{"robot", model.name().text()},
                    {"samples", sampling.samples},
                    {"seed", sampling.seed},
                    {"margin", sampling.margin},
                    {"pairs", ordered_json::array()}};
  for (const LinkPairCheck& pair : pairs) {
    json["pairs"].push_back({{"link1", NameOf(model, pair.link_a)},
                             {"link2", NameOf(model, pair.link_b)},
                             {"kind", robot::ToString(pair.kind)},
                             {"least_distance", pair.least_distance},
                             {"collisions", pair.collisions}});
  }
  return json;
}

}  // namespace

int CheckCollisionsCommand(const CheckCollisionsArguments& arguments) {
  robot::LoadOptions options = LoadOptionsOf(arguments.robot);
  options.load_visuals = false;
  const auto warn = [&](const std::string& line) {
    Tell("{}: warning: {}\n", arguments.robot.urdf, line);
  };
  options.warn = warn;
  models::OpenedFiles opened;
  const robot::RobotModel model =
      robot::LoadUrdf(files::ResolvePath(arguments.robot.urdf, {}, {}), options);
  runs::CheckOutputs({{"--write-srdf", arguments.write_srdf}},
                     runs::InputsOf(opened.files(), "what the robot is read from"));
  if (const std::string unseen = robot::DescribeUnseen(model, "--visual-as-collision missing");
      !unseen.empty())
    warn(unseen);
  const robot::CollisionSampling sampling{arguments.samples, arguments.seed, arguments.margin};
  const std::vector<LinkPairCheck> pairs = Look(model, sampling);
  if (!arguments.write_srdf.empty()) {
    robot::SaveDisabledPairs(arguments.write_srdf, model.name().text(),
                             robot::PairsToDisable(model, pairs));
  }
  if (arguments.json) {
    WriteData(oca::internal::JsonText(ToJson(model, pairs, sampling), 2) + "\n");
  } else {
    WriteOutput(Table(model, pairs, sampling));
    if (!arguments.write_srdf.empty()) Tell("wrote {}\n", arguments.write_srdf);
  }
  return kFine;
}

}  // namespace oca::tools
