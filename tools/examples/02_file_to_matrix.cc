// SPDX-License-Identifier: BSD-3-Clause
// Runs a diagram file and keeps signals as a matrix:  02_file_to_matrix [FILE]
#include <cmath>
#include <cstdio>
#include <exception>

#include "oca/diagrams/runs/in_memory.h"
#include "oca/diagrams/runs/run.h"

int main(int argc, char** argv) {
  try {
    const auto loaded = oca::loading::LoadDiagram(argc > 1 ? argv[1] : "diagrams/first.yaml");
    oca::runs::InMemory series({"spline.position", "plant.position"}, oca::Period(1, 100));
    const auto result = oca::runs::Run(loaded, {.outputs = {&series}});

    // A row a sample, a column a joint.
    const Eigen::VectorXd t = series.times();
    const Eigen::MatrixXd requested = series.Matrix("spline.position");
    const Eigen::MatrixXd reached = series.Matrix("plant.position");
    const Eigen::VectorXd away = (reached - requested).cwiseAbs().rowwise().maxCoeff();
    Eigen::Index row = 0;
    const double most = away.maxCoeff(&row);
    std::printf("%s: %ld samples of %ld joints\n", loaded.name.c_str(), static_cast<long>(t.size()),
                static_cast<long>(reached.cols()));
    std::printf("first column: %s in %s\n", series.names()[0].c_str(), series.units()[0].c_str());
    std::printf("farthest from the request: %.2f rad at %.2f s; at the end %.1g rad\n", most,
                t[row], away[away.size() - 1]);
    std::printf("nearest approach %.3f m; %s\n", result.metrics->min_distance.value_or(INFINITY),
                result.ExpectationsMet() ? "as expected" : "not as expected");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
