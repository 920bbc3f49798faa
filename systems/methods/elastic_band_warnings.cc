// SPDX-License-Identifier: BSD-3-Clause
// What an ElasticBand says of its plans in words.
#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/log.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/methods/elastic_band.h"

namespace oca::systems {
namespace {

std::string PairText(models::Name link, models::Name other) {
  return fmt::format("{} to {}", link.text(), other.text());
}

/// Why the goal cannot be had, and by how much.
std::string BlockText(const BandReport& report, const char* unit) {
  using planning::BandBlock;
  switch (report.block) {
    case BandBlock::kLimit:
      return fmt::format("it is {:.3g} {} beyond a limit of {}", report.block_amount, unit,
                         report.block_link.text());
    case BandBlock::kContact:
      return fmt::format("there {} is {:.3g} m deep in {}", report.block_link.text(),
                         report.block_amount, report.block_body.text());
    case BandBlock::kWay:
      return fmt::format(
          "no way there was found; where the arm comes nearest to it, {} are {:.3g} m "
          "apart",
          PairText(report.block_link, report.block_body), report.block_amount);
    case BandBlock::kNone:
      break;
  }
  return "nothing was found to be in the way";
}

}  // namespace

std::optional<Obstruction> ElasticBand::WhatBlocks(const BandReport& report) const {
  if (report.block == planning::BandBlock::kNone) return std::nullopt;
  const char* const unit = UnitOf(report.block_link);
  return Obstruction{.kind = planning::kBandBlockNames[static_cast<std::size_t>(report.block)],
                     .one = report.block_link,
                     .other = report.block_body,
                     .amount = report.block_amount,
                     .unit = unit,
                     .text = "the goal cannot be reached: " + BlockText(report, unit)};
}

void ElasticBand::Tell(double time, const BandReport& report, const BandReport& before,
                       Log& log) const {
  const auto warn = [&](const std::string& text) { log.Write(LogLevel::kWarning, time, text); };
  if (report.overruns > 0 && before.overruns == 0) {
    warn(fmt::format(
        "a plan counts as {:.3g} s of work, more than the time there is to make one: it is thrown "
        "away, and the next one begins later (counted in plan.overruns from now on)",
        report.charged));
  }
  const std::optional<Obstruction> block = WhatBlocks(report);
  if (report.block != before.block && block) {
    warn(block->text + "; the arm is to rest as near to it as was found");
  }
  if (report.stuck && !before.stuck) {
    const std::string pair =
        block ? block->text
        : report.link.empty()
            ? "nothing near"
            : fmt::format("{}, {:.3f} m", PairText(report.link, report.obstacle), report.distance);
    warn(fmt::format("the arm is stuck: no progress to its goal for {} s; what blocks: {}",
                     params_.stuck_time, pair));
  }
  if (report.tight && !before.tight) {
    const std::string pair =
        report.distance < 0.0
            ? fmt::format("{} {:.3g} m deep in {}", report.link.text(), -report.distance,
                          report.obstacle.text())
            : fmt::format("{} {:.3g} m apart", PairText(report.link, report.obstacle),
                          report.distance);
    warn(fmt::format("{} leaves {}, less than hard_distance, {} m: its own distance is kept there",
                     report.lack == planning::BandLack::kGoal ? "the goal" : "where the arm is",
                     pair, params_.hard_distance));
  }
}

const char* ElasticBand::UnitOf(models::Name joint) const {
  const auto& names = model_->position_names();
  const auto at = std::find(names.begin(), names.end(), joint);
  if (at == names.end()) return "m";
  const int number = model_->FindJoint(at->text());
  return robot::PositionUnit(model_->joints()[static_cast<std::size_t>(number)]);
}

}  // namespace oca::systems
