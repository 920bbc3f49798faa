// SPDX-License-Identifier: BSD-3-Clause
// Starts nearer than any plan may go, in contact, under what drops on the arm, and enclosed, by the
// recommended method in whole loops of two arms: out, never deeper, without a jump, and on or to
// rest.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "oca/models/random.h"
#include "oca/models/robot/clearance.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace bad_start_test {

using Eigen::VectorXd;

constexpr double kHard = 0.002;             // m; that the files' method keeps
constexpr double kMostAcceleration = 10.0;  // rad/s^2, of the files' motion limiter

/// What a run was like; distances are exact ones of the arm as it stands at each tick.
struct Course {
  double first{robot::kUnlimited};  ///< m; least distance when what is in the way was there first
  double least{robot::kUnlimited};
  double last{robot::kUnlimited};
  double contact_time{0.0};  ///< s
  double near_time{0.0};     ///< s; nearer than kHard
  double most_acceleration{0.0};
  double last_path{0.0};  ///< of the last 2 s, 2-norm
  double error{0.0};      ///< largest distance of a joint from the goal at the end
};

class Runner {
 public:
  Runner(const std::string& file, const std::string& arm, int seed) {
    models::Random random(models::Random::Seed(static_cast<std::uint64_t>(seed), file + arm));
    const double around = random.Uniform(0.0, 6.283);
    const double share = random.Unit();
    std::vector<files::Override> overrides{{"parameters.arm", arm}};
    if (file != "enclosed") {
      overrides.push_back({"parameters.around", fmt::format("{}", around)});
      const double gap = file == "start_near" ? 0.0003 + 0.0016 * share : -0.04 * share - 0.001;
      overrides.push_back({"parameters.gap", fmt::format("{}", gap)});
    } else {
      overrides.push_back({"parameters.gap", fmt::format("{}", 0.003 + 0.02 * share)});
    }
    run_ = std::make_unique<MethodRun>("scenarios/" + file, "recommended", overrides);
    clearance_ = std::make_unique<robot::Clearance>(run_->loaded().models.Get("arm"));
  }

  Course Run() {
    run_->Initialize();
    Course course;
    VectorXd last = run_->Vector("plant", "position");
    VectorXd velocity = VectorXd::Zero(last.size());
    const int ticks = static_cast<int>(std::lround(100.0 * run_->loaded().simulator.duration));
    for (int k = 1; k <= ticks; ++k) {
      Note(last, course);
      run_->AdvanceTo(0.01 * k);
      const VectorXd q = run_->Vector("plant", "position");
      EXPECT_TRUE(q.allFinite());
      const VectorXd now = 100.0 * (q - last);
      course.most_acceleration =
          std::max(course.most_acceleration, 100.0 * (now - velocity).cwiseAbs().maxCoeff());
      if (k > ticks - 200) course.last_path += (q - last).norm();
      last = q;
      velocity = now;
    }
    course.error = (last - run_->Vector("spline", "goal")).cwiseAbs().maxCoeff();
    return course;
  }

 private:
  void Note(const VectorXd& q, Course& course) {
    std::vector<robot::PlacedBody> bodies;
    for (const geometry::Obstacle& one :
         run_->Eval<systems::ObstacleSet>("obstacles", "obstacles").obstacles) {
      bodies.push_back({one.body->collider, one.X_WO});
    }
    if (bodies.empty()) return;
    clearance_->SetBodies(std::move(bodies));
    clearance_->MoveTo(q);
    const double distance = clearance_->Nearest().distance;
    if (course.first == robot::kUnlimited) course.first = distance;
    course.least = std::min(course.least, distance);
    course.last = distance;
    if (distance <= 0.0) course.contact_time += 0.01;
    if (distance < 0.99 * kHard) course.near_time += 0.01;
  }

  std::unique_ptr<MethodRun> run_;
  std::unique_ptr<robot::Clearance> clearance_;
};

struct Wanted {
  bool arrives;
  double contact_time, near_time;  ///< s; at most
  int seeds{5};
};

void ExpectOut(const std::string& file, const Wanted& wanted) {
  for (const char* arm : {"lwr4", "ur5e"}) {
    for (int seed = 0; seed < wanted.seeds; ++seed) {
      SCOPED_TRACE(fmt::format("{} {} {}", file, arm, seed));
      const Course course = Runner(file, arm, seed).Run();
      fmt::print(
          "{} {} {}: {:.4f} m at first, {:.4f} least, {:.2f} s in contact, {:.2f} s nearer than "
          "2 mm, {:.4f} rad off at the end, {:.5f} in the last 2 s\n",
          file, arm, seed, course.first, course.least, course.contact_time, course.near_time,
          course.error, course.last_path);
      EXPECT_GE(course.least, std::min(course.first, kHard) - 5e-4);
      EXPECT_LE(course.contact_time, wanted.contact_time);
      EXPECT_LE(course.near_time, wanted.near_time);
      EXPECT_GE(course.last, 0.99 * kHard);
      EXPECT_LE(course.most_acceleration, 1.001 * kMostAcceleration);
      EXPECT_LT(course.last_path, 0.01);
      if (wanted.arrives) {
        EXPECT_LT(course.error, 1e-3);
      }
    }
  }
}

TEST(BadStartTest, FromNearerThanTheHardDistanceAnArmLeavesAndArrives) {
  ExpectOut("start_near", {.arrives = true, .contact_time = 0.0, .near_time = 0.5});
}

TEST(BadStartTest, FromContactAnArmGoesOutAndArrives) {
  ExpectOut("start_in_contact", {.arrives = true, .contact_time = 0.6, .near_time = 0.7});
}

TEST(BadStartTest, FromUnderWhatAppearsOnItAnArmGoesOutAndRests) {
  ExpectOut("dropped_upon", {.arrives = false, .contact_time = 0.6, .near_time = 0.7});
}

TEST(BadStartTest, AnArmThatIsEnclosedRests) {
  ExpectOut("enclosed", {.arrives = false, .contact_time = 0.0, .near_time = 0.0, .seeds = 2});
}

}  // namespace bad_start_test
}  // namespace oca::runs
