// SPDX-License-Identifier: BSD-3-Clause
#include "framework/sundials_vector.h"

#include <algorithm>
#include <cmath>

namespace oca::internal {
namespace {

double* Data(N_Vector v) { return NV_DATA_S(v); }
sunindextype Length(N_Vector v) { return NV_LENGTH_S(v); }

void LinearSum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const double *u = Data(x), *v = Data(y);
  double* out = Data(z);
  for (sunindextype i = 0; i < Length(z); ++i) out[i] = a * u[i] + b * v[i];
}

void Const(double c, N_Vector z) { std::fill_n(Data(z), Length(z), c); }

void Product(N_Vector x, N_Vector y, N_Vector z) {
  for (sunindextype i = 0; i < Length(z); ++i) Data(z)[i] = Data(x)[i] * Data(y)[i];
}

void Quotient(N_Vector x, N_Vector y, N_Vector z) {
  for (sunindextype i = 0; i < Length(z); ++i) Data(z)[i] = Data(x)[i] / Data(y)[i];
}

void Scale(double c, N_Vector x, N_Vector z) {
  for (sunindextype i = 0; i < Length(z); ++i) Data(z)[i] = c * Data(x)[i];
}

void Absolute(N_Vector x, N_Vector z) {
  for (sunindextype i = 0; i < Length(z); ++i) Data(z)[i] = std::fabs(Data(x)[i]);
}

void Inverse(N_Vector x, N_Vector z) {
  for (sunindextype i = 0; i < Length(z); ++i) Data(z)[i] = 1.0 / Data(x)[i];
}

void AddConst(N_Vector x, double b, N_Vector z) {
  for (sunindextype i = 0; i < Length(z); ++i) Data(z)[i] = Data(x)[i] + b;
}

double Dot(N_Vector x, N_Vector y) {
  double sum = 0.0;
  for (sunindextype i = 0; i < Length(x); ++i) sum += Data(x)[i] * Data(y)[i];
  return sum;
}

double MaxNorm(N_Vector x) {
  double norm = 0.0;
  for (sunindextype i = 0; i < Length(x); ++i) norm = std::max(norm, std::fabs(Data(x)[i]));
  return norm;
}

double WeightedRms(N_Vector x, N_Vector w) {
  double sum = 0.0;
  for (sunindextype i = 0; i < Length(x); ++i) {
    const double term = Data(x)[i] * Data(w)[i];
    sum += term * term;
  }
  return std::sqrt(sum / static_cast<double>(Length(x)));
}

double Minimum(N_Vector x) { return *std::min_element(Data(x), Data(x) + Length(x)); }

int LinearCombination(int count, double* c, N_Vector* x, N_Vector z) {
  double* out = Data(z);
  const sunindextype n = Length(z);
  // z may be x[0], so its own term comes first.
  for (sunindextype i = 0; i < n; ++i) out[i] = c[0] * Data(x[0])[i];
  for (int k = 1; k < count; ++k) {
    const double* v = Data(x[k]);
    for (sunindextype i = 0; i < n; ++i) out[i] += c[k] * v[i];
  }
  return 0;
}

int ScaleAddMulti(int count, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int k = 0; k < count; ++k) LinearSum(a[k], x, 1.0, y[k], z[k]);
  return 0;
}

}  // namespace

N_Vector MakeSerialVector(sunindextype size, double* data, SUNContext context) {
  N_Vector vector = N_VMake_Serial(size, data, context);
  if (vector == nullptr) return nullptr;
  N_Vector_Ops ops = vector->ops;
  ops->nvlinearsum = LinearSum;
  ops->nvconst = Const;
  ops->nvprod = Product;
  ops->nvdiv = Quotient;
  ops->nvscale = Scale;
  ops->nvabs = Absolute;
  ops->nvinv = Inverse;
  ops->nvaddconst = AddConst;
  ops->nvdotprod = Dot;
  ops->nvmaxnorm = MaxNorm;
  ops->nvwrmsnorm = WeightedRms;
  ops->nvmin = Minimum;
  ops->nvlinearcombination = LinearCombination;
  ops->nvscaleaddmulti = ScaleAddMulti;
  return vector;
}

}  // namespace oca::internal
