// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "diagrams/package_paths.h"
#include "framework/error.h"
#include "models/opened_files.h"
#include "models/robot/collision_check.h"
#include "models/robot/srdf.h"
#include "models/robot/unseen_links.h"
#include "models/robot/urdf.h"
#include "tools/commands.h"
#include "tools/output_files.h"
#include "tools/terminal.h"

namespace oca::tools {
namespace {

using models::LinkPairCheck;
using models::PairKind;
using nlohmann::ordered_json;

const std::string& NameOf(const models::RobotModel& model, int link) {
  return model.links()[link].name.text();
}

std::string Table(const models::RobotModel& model, const std::vector<LinkPairCheck>& pairs,
                  const models::CollisionSampling& sampling) {
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
                        width, NameOf(model, pair.link_b), width, models::ToString(pair.kind),
                        pair.least_distance, pair.collisions);
  }
  return text + fmt::format("  to check: {}; not: {} adjacent, {} always, {} never in collision\n",
                            counts[PairKind::kSometimes], counts[PairKind::kAdjacent],
                            counts[PairKind::kAlways], counts[PairKind::kNever]);
}

ordered_json ToJson(const models::RobotModel& model, const std::vector<LinkPairCheck>& pairs,
                    const models::CollisionSampling& sampling) {
  ordered_json json{{"robot", model.name().text()},
                    {"samples", sampling.samples},
                    {"seed", sampling.seed},
                    {"margin", sampling.margin},
                    {"pairs", ordered_json::array()}};
  for (const LinkPairCheck& pair : pairs) {
    json["pairs"].push_back({{"link1", NameOf(model, pair.link_a)},
                             {"link2", NameOf(model, pair.link_b)},
                             {"kind", models::ToString(pair.kind)},
                             {"least_distance", pair.least_distance},
                             {"collisions", pair.collisions}});
  }
  return json;
}

std::vector<models::DisabledPair> DisabledPairs(const models::RobotModel& model,
                                                const std::vector<LinkPairCheck>& pairs) {
  std::vector<models::DisabledPair> disabled;
  for (const PairKind kind : {PairKind::kAdjacent, PairKind::kAlways, PairKind::kNever}) {
    for (const LinkPairCheck& pair : pairs) {
      if (pair.kind != kind) continue;
      disabled.push_back({NameOf(model, pair.link_a), NameOf(model, pair.link_b),
                          std::string(models::ToString(kind))});
    }
  }
  return disabled;
}

models::VisualAsCollision VisualsFrom(const std::string& name) {
  const auto names = EnumNames(models::VisualAsCollision{});
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw ConfigError(fmt::format("--visual-as-collision: got '{}'; expected one of: {}", name,
                                  fmt::join(names, ", ")));
  }
  return static_cast<models::VisualAsCollision>(found - names.begin());
}

}  // namespace

int CheckCollisionsCommand(const CheckCollisionsArguments& arguments) {
  models::LoadOptions options;
  options.package_directories = diagrams::PackageFolders();
  options.load_visuals = false;
  options.visual_as_collision = VisualsFrom(arguments.visual_as_collision);
  const auto warn = [&](const std::string& line) {
    Tell("{}: warning: {}\n", arguments.urdf, line);
  };
  options.warn = warn;
  models::OpenedFiles opened;
  const models::RobotModel model =
      models::LoadUrdf(diagrams::ResolvePath(arguments.urdf, {}, {}), options);
  CheckOutputs({{"--write-srdf", arguments.write_srdf}},
               InputsOf(opened.files(), "what the robot is read from"));
  if (const std::string unseen = models::DescribeUnseen(model, "--visual-as-collision missing");
      !unseen.empty())
    warn(unseen);
  const models::CollisionSampling sampling{arguments.samples, arguments.seed, arguments.margin};
  const std::vector<LinkPairCheck> pairs = models::CheckCollisions(model, sampling);
  if (!arguments.write_srdf.empty()) {
    models::SaveDisabledPairs(arguments.write_srdf, model.name().text(),
                              DisabledPairs(model, pairs));
  }
  if (arguments.json) {
    std::cout << ToJson(model, pairs, sampling).dump(2) << '\n';
  } else {
    std::cout << Table(model, pairs, sampling);
    if (!arguments.write_srdf.empty()) Tell("wrote {}\n", arguments.write_srdf);
  }
  return kFine;
}

}  // namespace oca::tools
