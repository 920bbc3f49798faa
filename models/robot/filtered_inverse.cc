// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/filtered_inverse.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace oca::robot {
namespace {

using Spectrum = Eigen::SelfAdjointEigenSolver<JointMatrix>;

}  // namespace

JointVector SolveFiltered(const JointMatrix& M, const JointVector& b, const Damping& damping) {
  const Spectrum spectrum(M);
  JointVector x = spectrum.eigenvectors().transpose() * b;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double sigma_squared = std::max(spectrum.eigenvalues()[k], 0.0);
    const double divisor = sigma_squared + damping.Squared(sigma_squared);
    x[k] = divisor > 0.0 ? x[k] / divisor : 0.0;
  }
  return spectrum.eigenvectors() * x;
}

JointMatrix FilteredNullspace(const JointMatrix& M, const Damping& damping) {
  const Spectrum spectrum(M);
  JointVector kept = spectrum.eigenvalues();
  for (double& value : kept) {
    const double sigma_squared = std::max(value, 0.0);
    const double lambda_squared = damping.Squared(sigma_squared);
    const double sum = sigma_squared + lambda_squared;
    value = sum > 0.0 ? lambda_squared / sum : 1.0;
  }
  const JointMatrix& V = spectrum.eigenvectors();
  return V * kept.asDiagonal() * V.transpose();
}

}  // namespace oca::robot
