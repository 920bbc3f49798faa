// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "oca/tools/simulator/simulator_main.h"
#include "tools/simulator/robot_options.h"
#include "tools/simulator/run_files.h"

namespace oca::tools {

struct RunArguments {
  std::string file;
  std::vector<std::string> overrides;
  std::optional<double> duration;
  std::optional<int> seed;
  FileArguments files;
  std::optional<int> live;  ///< port to show the run on; 0: any that is free
  std::string live_address{"127.0.0.1"};
  std::vector<std::string> live_origins;  ///< of other pages that may connect
  std::optional<double> realtime;         ///< simulated seconds a second
  bool profile{false};
  bool json{false};
  bool no_progress{false};
  std::string log_level{"debug"};
};
/// `catalogue` has the types of the systems, here and below.
int RunCommand(const RunArguments& arguments, const files::Catalogue& catalogue);

struct ViewArguments {
  std::string file;
  int port{8765};
  std::string address{"127.0.0.1"};
};
/// Serves the page on a record until it is interrupted.
int ViewCommand(const ViewArguments& arguments);

int CheckCommand(const std::vector<std::string>& files, const std::vector<std::string>& overrides,
                 const files::Catalogue& catalogue);

struct PlanArguments {
  std::string file;
  std::vector<std::string> overrides;
  std::optional<int> seed;  ///< of the first sample; none: the file's
  int samples{1};           ///< seeds seed, seed + 1, ...
  int starts{30};
  std::string model;                ///< empty: the only one that is judged
  std::optional<double> duration;   ///< s; instead of the file's
  std::optional<double> reference;  ///< s; of each search for the shortest way; none: not sought
};
/// Whether an optimiser that knows the whole script finds a clear motion: a JSON object a line,
/// as docs/how-to/plan.md says. kExpectationNotMet if it finds none for any of the samples.
int PlanCommand(const PlanArguments& arguments, const files::Catalogue& catalogue);
/// What it prints and how it ends, for its help.
const char* PlanFooter();

struct GraphArguments {
  std::string file;
  std::string format{"dot"};
  std::vector<std::string> overrides;
};
int GraphCommand(const GraphArguments& arguments, const files::Catalogue& catalogue);

struct CheckCollisionsArguments {
  RobotArguments robot;
  std::string write_srdf;  ///< empty: print only
  int samples{10000};
  std::uint64_t seed{0};
  double margin{0.02};  ///< m
  bool json{false};
};
/// Which pairs of links of a robot need no check for collision, for its SRDF.
int CheckCollisionsCommand(const CheckCollisionsArguments& arguments);

struct ExpandArguments {
  std::string xacro;
  std::vector<std::string> arguments;  ///< NAME=VALUE
  std::string output;                  ///< empty: print it
};
/// The URDF that a xacro file stands for.
int ExpandCommand(const ExpandArguments& arguments);

struct NewArguments {
  std::string robot;                   ///< URDF or xacro
  std::vector<std::string> arguments;  ///< NAME=VALUE, of a xacro
  std::string srdf;                    ///< empty: one is written
  std::string group;                   ///< of the SRDF, that is the arm
  std::string avoidance{"recommended"};
  std::string folder;  ///< empty: the name of the robot's file
  std::uint64_t seed{0};
  int tries{12};
};
/// Writes a first diagram for a robot, runs it and makes a report of the run. kExpectationNotMet if
/// the arm does not evade.
int NewCommand(const NewArguments& arguments);

int ListCommand(const files::Catalogue& catalogue);
int DescribeCommand(const std::string& type, const files::Catalogue& catalogue);
int SchemaCommand(const files::Catalogue& catalogue);
/// A page of docs/reference in Markdown: `systems` or `diagram_file`.
int DocsCommand(const std::string& page, const files::Catalogue& catalogue);

struct EvalArguments {
  std::string type;
  std::string params{"{}"};
  std::vector<std::string> models;     ///< NAME=URDF, or a xacro, or JSON
  std::vector<std::string> arguments;  ///< MODEL.NAME=VALUE, of a xacro
};
/// Serves one JSON object a line from `in` until it ends.
int EvalCommand(const EvalArguments& arguments, const files::Catalogue& catalogue, std::istream& in,
                std::ostream& out);

}  // namespace oca::tools
