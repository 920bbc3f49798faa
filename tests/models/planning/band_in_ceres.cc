// SPDX-License-Identifier: BSD-3-Clause
#include "tests/models/planning/band_in_ceres.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oca/models/random.h"
#include "oca/models/robot/urdf.h"

namespace oca::planning::test {
namespace {

using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// All residuals of one sample: of deviation, speed and acceleration, of three limits a joint, and
/// of each link and body.
class SampleCost final : public ceres::CostFunction {
 public:
  SampleCost(const BandScene& scene, const BandSettings& settings, const BandCurve& curve,
             double time, double weight, robot::Clearance& clearance)
      : scene_(scene),
        settings_(settings),
        basis_(curve.BasisAt(time)),
        time_(time),
        weight_(weight),
        clearance_(clearance),
        n_(static_cast<int>(curve.size())) {
    for (int i = 0; i < 4; ++i) mutable_parameter_block_sizes()->push_back(n_);
    const auto bodies = static_cast<int>(scene.bodies.size());
    set_num_residuals(6 * n_ + scene.model->num_links() * bodies);
  }
  int first() const { return basis_.first; }

  bool Evaluate(double const* const* controls, double* residuals,
                double** jacobians) const override {
    Eigen::Map<VectorXd> r(residuals, num_residuals());
    r.setZero();
    VectorXd x[3];
    for (int d = 0; d < 3; ++d) {
      x[d].setZero(n_);
      for (int i = 0; i < 4; ++i) {
        x[d] += basis_.weights[d][i] * Eigen::Map<const VectorXd>(controls[i], n_);
      }
    }
    RowMajor slopes[3];  // of the residuals by x, x', x''
    for (RowMajor& slope : slopes) slope.setZero(num_residuals(), n_);
    AddMotion(x, r, slopes);
    AddDistances(x[0], jacobians != nullptr, r, slopes[0]);
    if (jacobians == nullptr) return true;
    for (int i = 0; i < 4; ++i) {
      if (jacobians[i] == nullptr) continue;
      Eigen::Map<RowMajor> J(jacobians[i], num_residuals(), n_);
      J.setZero();
      for (int d = 0; d < 3; ++d) J += basis_.weights[d][i] * slopes[d];
    }
    return true;
  }

 private:
  void AddMotion(const VectorXd x[3], Eigen::Map<VectorXd>& r, RowMajor slopes[3]) const {
    const robot::RobotModel& model = *scene_.model;
    const double prices[3] = {settings_.nearness, settings_.calm, settings_.smoothness};
    const VectorXd middle = 0.5 * (model.upper_limits() + model.lower_limits());
    const VectorXd half = 0.5 * (model.upper_limits() - model.lower_limits());
    const VectorXd ranges[3] = {half.array() - 0.02,
                                settings_.limit_share * model.velocity_limits(),
                                settings_.limit_share * model.acceleration_limits()};
    const VectorXd units[3] = {VectorXd::Constant(n_, 0.1), model.velocity_limits(),
                               model.acceleration_limits()};
    VectorXd request(n_);
    for (int d = 0; d < 3; ++d) {
      scene_.request(time_, d, request);
      if (d == 0) request -= middle;
      for (int j = 0; j < n_; ++j) {
        const int near = d * n_ + j, limit = (3 + d) * n_ + j;
        const double price = std::sqrt(weight_ * prices[d]);
        r[near] = price * x[d][j];
        slopes[d](near, j) = price;
        const double at = request[j] + x[d][j];
        if (!(std::fabs(at) > ranges[d][j])) continue;
        const double over = (std::fabs(at) - ranges[d][j]) / units[d][j];
        const double dear = std::sqrt(weight_ * settings_.limits);
        r[limit] = dear * over;
        slopes[d](limit, j) = std::copysign(dear / units[d][j], at);
      }
    }
  }
  void AddDistances(const VectorXd& x, bool rows, Eigen::Map<VectorXd>& r, RowMajor& slope) const {
    VectorXd q(n_), row(n_);
    scene_.request(time_, 0, q);
    q += x;
    clearance_.MoveTo(q);
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const BandBody& body = scene_.bodies[b];
      if (!body.stands) clearance_.MoveBody(static_cast<int>(b), body.pose(time_));
    }
    std::vector<robot::NearPair> pairs;
    clearance_.Collect(settings_.margin, pairs);
    const double price = std::sqrt(weight_ * settings_.clearance);
    for (const robot::NearPair& pair : pairs) {
      const int i = 6 * n_ + pair.link * static_cast<int>(scene_.bodies.size()) + pair.body;
      r[i] = price * (settings_.margin - pair.distance);
      if (!rows) continue;
      clearance_.Gradient(pair, row);
      slope.row(i) = -price * row.transpose();
    }
  }

  const BandScene& scene_;
  const BandSettings& settings_;
  const BandCurve::Basis basis_;
  const double time_, weight_;
  robot::Clearance& clearance_;
  const int n_;
};

}  // namespace

BandScene MakeBandScene(std::uint64_t seed) {
  robot::LoadOptions options;
  options.X_WB.translation() = Eigen::Vector3d(0.0, 0.0, 0.85);
  BandScene scene;
  scene.model = std::make_shared<const robot::RobotModel>(
      robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf", options));
  models::Random random(seed);
  for (int b = 0; b < 1 + static_cast<int>(seed % 3); ++b) {
    const auto edge = [&] { return random.Uniform(0.1, 0.4); };
    const double azimuth = random.Uniform(0.5, 2.4), radius = random.Uniform(0.4, 0.9);
    Eigen::Isometry3d X(Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()));
    X.translation() << radius * std::cos(azimuth), radius * std::sin(azimuth),
        random.Uniform(0.8, 1.4);
    const Eigen::Vector3d size(edge(), edge(), edge());
    scene.bodies.push_back({models::Name("box"), geometry::MakeCollider(geometry::Box{size}, "box"),
                            [X](double) { return X; }, true});
  }
  scene.request = [](double time, int derivative, Eigen::Ref<VectorXd> out) {
    constexpr double kTurn = 1.75 * std::numbers::pi / 2.0;
    const double s = std::clamp(time / 10.0, 0.0, 1.0);
    const double shape[3] = {s * s * (3.0 - 2.0 * s), 0.6 * s * (1.0 - s), 0.06 * (1.0 - 2.0 * s)};
    out.setZero();
    if (derivative == 0) out << 0.0, 1.48, 0.0, -0.61, 0.0, 0.52, 0.0;
    out[0] += (derivative > 0 && s == 1.0 ? 0.0 : shape[derivative]) * kTurn;
  };
  return scene;
}

BandCurve StraightBand() {
  std::vector<double> times;
  for (int i = 0; i <= 26; ++i) times.push_back(0.4 * i);
  return {7, times};
}

CeresAnswer RelaxByCeres(const BandScene& scene, const BandSettings& settings, int most,
                         double least_gain, BandCurve& curve) {
  std::vector<robot::PlacedBody> placed;
  for (const BandBody& body : scene.bodies) placed.push_back({body.collider, body.pose(0.0)});
  robot::Clearance clearance(scene.model, false, placed);
  Eigen::MatrixXd& controls = curve.controls();
  ceres::Problem problem;
  const std::vector<double> times = curve.times();
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double step = (times[i + 1] - times[i]) / 4.0;
    for (int k = 0; k < 4; ++k) {
      auto cost = std::make_unique<SampleCost>(scene, settings, curve, times[i] + (k + 0.5) * step,
                                               step, clearance);
      const auto column = [&](int c) { return controls.col(cost->first() + c).data(); };
      const std::vector<double*> blocks{column(0), column(1), column(2), column(3)};
      problem.AddResidualBlock(cost.release(), nullptr, blocks);
    }
  }
  for (int i = 0; i < 3; ++i) {
    problem.SetParameterBlockConstant(controls.col(i).data());
    problem.SetParameterBlockConstant(controls.col(controls.cols() - 1 - i).data());
  }
  ceres::Solver::Options options;
  options.max_num_iterations = most;
  options.function_tolerance = least_gain;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {2.0 * summary.initial_cost, 2.0 * summary.final_cost,
          static_cast<int>(summary.iterations.size()) - 1};
}

}  // namespace oca::planning::test
