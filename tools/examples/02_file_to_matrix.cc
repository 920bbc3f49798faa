// SPDX-License-Identifier: BSD-3-Clause
// Runs a diagram file and keeps signals as a matrix:  02_file_to_matrix [FILE]
#include <cstdio>
#include <exception>

#include "oca/diagrams/runs/run_series.h"

int main(int argc, char** argv) {
  try {
    const auto loaded = oca::loading::LoadDiagram(argc > 1 ? argv[1] : "diagrams/first.yaml");
    oca::runs::RunSeries series(loaded, {"spline.position", "plant.position"}, oca::Period(1, 100));
    const auto result = oca::runs::Run(loaded, {.observers = {&series}});

    // A row a sample, a column a number: requested joints, then those of the robot.
    const Eigen::VectorXd t = series.log().times();
    const Eigen::MatrixXd values = series.log().Matrix();
    const Eigen::Index n = values.cols() / 2;
    const Eigen::VectorXd away =
        (values.rightCols(n) - values.leftCols(n)).cwiseAbs().rowwise().maxCoeff();
    Eigen::Index row = 0;
    const double most = away.maxCoeff(&row);
    std::printf("%s: %ld samples of %ld joints\n", loaded.name.c_str(),
                static_cast<long>(values.rows()), static_cast<long>(n));
    std::printf("first column: %s in %s\n", series.log().names()[0].c_str(),
                series.log().units()[0].c_str());
    std::printf("farthest from the request: %.2f rad at %.2f s; at the end %.1g rad\n", most,
                t[row], away[away.size() - 1]);
    std::printf("%s\n", result.ExpectationsMet() ? "as expected" : "not as expected");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
