// SPDX-License-Identifier: BSD-3-Clause
//
// How long the search for a path takes among what planning scenes of others hold: finds a way from
// start to goal of every problem of a folder, 1 mm from everything, own links counted, and prints a
// line a family and one of all.
//
//   oca_scene_search FOLDER ROBOT [SEED]
//
// FOLDER has FAMILY/sceneNNNN.yaml and FAMILY/requestNNNN.yaml as MoveIt writes them; ROBOT is a
// URDF, beside it a file named .srdf and the packages whose meshes it names; SEED of the search
// (0).
//
// Three times, of processor time, each from the begin: `search` until the trees meet, their edges
// looked at by samples; `proved` until a path is proved clear between them; `shortened` until
// shortcuts have been tried, each proved. Robot, bodies and what is made of them are there before:
// `scene` is the time to make the latter. The last columns are means: configurations that were
// looked at, and those of them that only exact distances could decide.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "oca/models/planning/certified_motion.h"
#include "oca/models/planning/rrt_connect.h"
#include "oca/models/planning/tree_pair.h"
#include "oca/models/robot/urdf.h"
#include "oca/models/scenes/motion_request.h"
#include "oca/models/scenes/planning_scene.h"

namespace oca::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kSearchMargin = 0.001;  // m
constexpr int kMostDraws = 200'000;

double Seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::shared_ptr<const robot::RobotModel> Robot(const fs::path& urdf) {
  robot::LoadOptions options;
  options.srdf = fs::path(urdf).replace_extension(".srdf");
  options.package_directories = {urdf.parent_path()};
  options.load_visuals = false;
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(urdf, options));
}

std::vector<robot::PlacedBody> Bodies(const fs::path& file) {
  std::vector<robot::PlacedBody> bodies;
  for (const scenes::SceneObject& object : scenes::ReadPlanningScene(file).objects) {
    for (const scenes::SceneBody& body : object.bodies) {
      bodies.push_back({geometry::MakeCollider(std::get<geometry::Shape>(body.shape), body.where),
                        object.X_FO * body.X_OB});
    }
  }
  return bodies;
}

Eigen::VectorXd Positions(const robot::RobotModel& model, const scenes::JointPositions& joints) {
  Eigen::VectorXd q(model.num_positions());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = *joints.Find(model.position_names()[static_cast<std::size_t>(i)].text());
  }
  return q;
}

struct Times {
  double scene{0.0}, search{0.0}, proved{0.0}, shortened{0.0};
  double looked_at{0.0}, undecided{0.0};
  bool found{false};
};

/// RrtConnect, with a look at the clock in between.
Times Search(robot::Clearance& clearance, const Eigen::VectorXd& start, const Eigen::VectorXd& goal,
             std::uint64_t seed) {
  Times times;
  const double made = Seconds();
  planning::CertifiedMotion motion(clearance, kSearchMargin);
  motion.batch();
  const double begin = Seconds();
  times.scene = begin - made;
  planning::TreePair trees(start, &goal);
  trees.LeaveRoom(motion, start, goal);
  const planning::SearchRoom room(clearance.model(), start, goal);
  models::Random random(seed);
  std::optional<std::vector<Eigen::VectorXd>> path;
  if (motion.SamplesClear(start, goal, planning::kSampleSpacing, 0.0)) {
    times.search = Seconds() - begin;
    if (motion.Clear(start, goal)) path = {start, goal};
  }
  for (int draw = 0; draw < kMostDraws && !path; ++draw) {
    if (!trees.Grow(room.Draw(random), planning::kLongestEdge, kMostDraws, motion)) continue;
    if (times.search == 0.0) times.search = Seconds() - begin;
    path = trees.Prove(motion);
  }
  times.proved = Seconds() - begin;
  times.found = path.has_value();
  times.looked_at = static_cast<double>(motion.batch().looked_at());
  times.undecided = static_cast<double>(motion.batch().undecided());
  if (path) planning::Shorten(clearance, {.seed = seed, .margin = kSearchMargin}, *path);
  times.shortened = Seconds() - begin;
  return times;
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(
      std::lround(share * static_cast<double>(values.size() - 1)))];
}

void Print(const std::string& family, const std::vector<Times>& all) {
  const auto found = std::count_if(all.begin(), all.end(), [](const Times& t) { return t.found; });
  const auto of = [&](double Times::*member) {
    std::vector<double> values;
    for (const Times& times : all) values.push_back(1e3 * times.*member);
    return values;
  };
  const auto mean = [&](double Times::*member) {
    double sum = 0.0;
    for (const Times& times : all) sum += times.*member;
    return sum / static_cast<double>(all.size());
  };
  const auto four = [&](double Times::*member) {
    const std::vector<double> values = of(member);
    return fmt::format("{:.3f} {:.3f} {:.3f} {:.1f}", Quantile(values, 0.5), Quantile(values, 0.95),
                       Quantile(values, 0.99), Quantile(values, 1.0));
  };
  fmt::print("| {:<21} | {:>3} of {:<3} | {:.3f} | {} | {} | {} | {:.0f} | {:.0f} |\n", family,
             found, all.size(), Quantile(of(&Times::scene), 0.5), four(&Times::search),
             four(&Times::proved), four(&Times::shortened), mean(&Times::looked_at),
             mean(&Times::undecided));
}

void Run(const fs::path& folder, const fs::path& urdf, std::uint64_t seed) {
  const auto model = Robot(urdf);
  robot::Clearance robot_alone(model, true);
  fmt::print("{} balls contain the links\n", planning::BatchClearance(robot_alone).num_balls());
  std::map<std::string, std::vector<fs::path>> families;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with("scene")) {
      families[entry.path().parent_path().filename().string()].push_back(entry.path());
    }
  }
  fmt::print(
      "p50 p95 p99 most, ms of processor time\n\n"
      "| family | found | scene | search | proved | shortened | looked at | exactly |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|\n");
  std::vector<Times> all;
  for (auto& [family, files] : families) {
    std::sort(files.begin(), files.end());
    std::vector<Times> of_family;
    for (const fs::path& file : files) {
      std::string request = file.filename().string();
      request.replace(0, 5, "request");
      const auto asked = scenes::ReadMotionRequest(file.parent_path() / request);
      robot::Clearance clearance = robot_alone;
      clearance.SetBodies(Bodies(file));
      of_family.push_back(
          Search(clearance, Positions(*model, asked.start), Positions(*model, asked.goal), seed));
    }
    Print(family, of_family);
    all.insert(all.end(), of_family.begin(), of_family.end());
  }
  if (!all.empty()) Print("all", all);
}

}  // namespace
}  // namespace oca::bench

int main(int count, char** arguments) {
  if (count < 3 || count > 4) {
    std::fputs("usage: oca_scene_search FOLDER ROBOT [SEED]\n", stderr);
    return 64;
  }
  try {
    oca::bench::Run(arguments[1], arguments[2], count > 3 ? std::stoull(arguments[3]) : 0);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
