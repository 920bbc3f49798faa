// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/period.h"
#include "oca/framework/dataflow/port.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/name.h"

namespace oca {
class Context;
class Diagram;
}  // namespace oca

namespace oca::systems {

// What recorder, plots, picture, planner, checks and a robot's own loop need to know of a block.
// They know no block by its type: a block declares in its constructor what it is to them,
//
//     DeclareRole(Limits{.shown = Limits::Shown::kListed, .signal = clips, .member = "clips"});
//
// and is then treated like every other that does. A handle of a role without a system stands for
// a port that the block does not have.

/// A port of the block that declares a role: an output, or an input, which stands for what drives
/// it.
struct RolePort {
  RolePort() = default;
  RolePort(const OutputHandle& port) : output(port) {}  // NOLINT: an output is a port
  RolePort(const InputHandle& port) : input(port) {}    // NOLINT: an input is a port

  /// The output that is meant; none if nothing drives the input.
  std::optional<OutputHandle> In(const Diagram& diagram) const;

  OutputHandle output{};
  InputHandle input{};
};

/// It may hold a motion back or bend it, and a signal shows when: "who limited what" in records.
struct Limits {
  enum class Shown {
    kRate,    ///< the signal's rate of change is at the bound
    kBelow,   ///< it is below the bound
    kAbove,   ///< it is above the bound
    kListed,  ///< its member `member` lists what is active, as {"joint", "limit"} or {"link",
              ///< "obstacle"}; forces of 0 do not count
  };
  Shown shown;
  RolePort signal{};
  std::vector<double> bound{};  ///< one number, or one a column of the signal
  std::string member{};         ///< of a signal that is no Vector: the number that is compared
  std::string how{};            ///< what the block does then: "slowed"; empty: as `shown` says
  Period period{};              ///< of the signal's changes; 0: as often as the picture is taken
};

/// It judges a run: `metrics` is a MotionMetricsValue.
struct Judges {
  OutputHandle metrics{};
  InputHandle position{}, request{}, delta{}, proximities{};
  std::string model{};  ///< of the robot; empty: not said
};

/// It stands for something outside, whose place a robot's own loop takes: joints, a camera, a
/// judge.
struct Boundary {
  const char* stands_for;
};

/// It stands for the joints of a robot.
struct Plant {
  InputHandle command{};
  OutputHandle position{}, velocity{};
};

/// It says where obstacles really are.
struct HoldsObstacles {
  /// One that stands still and that a user may move.
  struct Standing {
    std::string id;
    std::string parameter;           ///< of the block, which says where it is, a list of three
    std::vector<double> position{};  ///< m, in the world
    int first;                       ///< of its three numbers in `offsets`
  };
  OutputHandle obstacles{};
  InputHandle offsets{};  ///< adds to the positions, three numbers an obstacle
  std::vector<Standing> standing{};
  /// The same block, with every instant instead of samples; its `obstacles` are as here.
  std::function<std::unique_ptr<System>()> unsampled{};
};

/// It computes the poses of a robot's links.
struct Kinematics {
  InputHandle position{}, velocity{};
  OutputHandle links{};
};

/// It measures the distances of a robot's links to what is around them.
struct MeasuresDistances {
  /// Another model whose links it looks at; `links` says where, if it has joints.
  struct Other {
    std::string model;
    InputHandle links{};
  };
  OutputHandle proximities{};
  InputHandle obstacles{};
  std::string model{};  ///< of the robot
  bool own_links{false};
  double self_distance{0.0};  ///< m; that own links keep at most; 0: as from obstacles
  std::vector<Other> others{};
  std::vector<std::pair<std::string, std::string>> ignored{};  ///< link; obstacle or model/link
};

/// What it does not see, or makes others not see: phrases for who takes a run for clear.
struct BlindSpots {
  /// `own_name`: of the block in its diagram; `one_robot`: the only one there is need not be named.
  std::function<std::vector<std::string>(const std::string& own_name, bool one_robot)> spots{};
  InputHandle behind{};  ///< what drives it has blind spots of its own that count too
};

/// What keeps a robot from its goal.
struct Obstruction {
  std::string kind;    ///< limit, contact or way
  models::Name one;    ///< a link, or the joint whose limit it is
  models::Name other;  ///< a body or another link; empty: of a limit
  double amount;       ///< how deep or how far apart, or how far beyond the limit
  std::string unit;    ///< m or rad
  std::string text;    ///< all of it, for people
};

/// It knows what keeps its robot from its goal.
struct KnowsWhatBlocks {
  /// Nothing while nothing does.
  std::function<std::optional<Obstruction>(const Context& context)> what{};
};

/// It pushes links away from what is nearer than its range, m.
struct Repels {
  double range;
};

/// A plot that a record deserves. Those of one id are one plot; `requested`, `delta`, `final`,
/// `distance` and `speed` come first.
struct Plots {
  std::string id{};
  std::string title{};
  RolePort signal{};
  std::string unit{};  ///< empty: the signal's
};

/// Signals are drawn by their type: ObstacleSet, ProximitySet, LinkForceSet, WrenchSet. This output
/// is not, for another one shows the same.
struct NotDrawn {
  OutputHandle output{};
};

/// An output shows an input as it came in.
struct PassesOn {
  InputHandle in{};
  OutputHandle out{};
};

/// What people should know of it: `warnings` when a file is loaded, `notes` when it is checked.
struct Remarks {
  std::vector<std::string> warnings{};
  std::function<std::vector<std::string>()> notes{};
};

// The loop of an avoidance by forces, kinematics -> ... -> MapsForces -> CarriesDelta -> ... ->
// AddsDelta, so that its gain can be estimated (diagrams/runs/chatter_check.h).

/// It maps forces on links to a delta of the joints.
struct MapsForces {
  InputHandle links{};
  OutputHandle delta{};
  /// A block that estimates the gain of a loop through it, once a period: with inputs `slopes` and
  /// `more_slopes` (optional), ContactSlopes, `links`, LinkPoses, and the output `gain`.
  std::function<std::unique_ptr<System>(const Period& period)> make_gain{};
};

/// A delta passes through it, altered.
struct CarriesDelta {
  InputHandle in{};
  OutputHandle out{};
  std::optional<double> relaxation_time{};  ///< s, if it is there to calm the loop
  InputHandle adapts{};                     ///< if driven: gives another relaxation time
};

/// It adds the delta to the request.
struct AddsDelta {
  InputHandle delta{}, request{};
  Period period{};  ///< of control
};

/// The roles of a block that are declared here, a phrase each: "limits, as `clips` shows".
std::vector<std::string> DescribeRoles(const System& system);

}  // namespace oca::systems
