// SPDX-License-Identifier: BSD-3-Clause
#include "framework/sundials_vector.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace oca::internal {
namespace {

double* Data(N_Vector v) { return NV_DATA_S(v); }
std::size_t Length(N_Vector v) { return static_cast<std::size_t>(NV_LENGTH_S(v)); }

void LinearSum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const double *u = Data(x), *v = Data(y);
  double* out = Data(z);
  for (std::size_t i = 0, n = Length(z); i < n; ++i) out[i] = a * u[i] + b * v[i];
}

void Const(double c, N_Vector z) { std::fill_n(Data(z), Length(z), c); }

void Product(N_Vector x, N_Vector y, N_Vector z) {
  const double *u = Data(x), *v = Data(y);
  double* out = Data(z);
  for (std::size_t i = 0, n = Length(z); i < n; ++i) out[i] = u[i] * v[i];
}

void Quotient(N_Vector x, N_Vector y, N_Vector z) {
  const double *u = Data(x), *v = Data(y);
  double* out = Data(z);
  for (std::size_t i = 0, n = Length(z); i < n; ++i) out[i] = u[i] / v[i];
}

/// z_i = f(x_i)
template <class F>
void Transform(N_Vector x, N_Vector z, const F& f) {
  const double* u = Data(x);
  double* out = Data(z);
  for (std::size_t i = 0, n = Length(z); i < n; ++i) out[i] = f(u[i]);
}

void Scale(double c, N_Vector x, N_Vector z) {
  if (c == 1.0) {
    if (x != z) std::memcpy(Data(z), Data(x), sizeof(double) * Length(z));
    return;
  }
  Transform(x, z, [c](double u) { return c * u; });
}

void Absolute(N_Vector x, N_Vector z) {
  Transform(x, z, [](double u) { return std::fabs(u); });
}

void Inverse(N_Vector x, N_Vector z) {
  Transform(x, z, [](double u) { return 1.0 / u; });
}

void AddConst(N_Vector x, double b, N_Vector z) {
  Transform(x, z, [b](double u) { return u + b; });
}

double Dot(N_Vector x, N_Vector y) {
  const double *u = Data(x), *v = Data(y);
  double sum = 0.0;
  for (std::size_t i = 0, n = Length(x); i < n; ++i) sum += u[i] * v[i];
  return sum;
}

double MaxNorm(N_Vector x) {
  const double* u = Data(x);
  double norm = 0.0;
  for (std::size_t i = 0, n = Length(x); i < n; ++i) norm = std::max(norm, std::fabs(u[i]));
  return norm;
}

double WeightedRms(N_Vector x, N_Vector w) {
  const double *u = Data(x), *v = Data(w);
  const std::size_t n = Length(x);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double term = u[i] * v[i];
    sum += term * term;
  }
  return std::sqrt(sum / static_cast<double>(n));
}

double Minimum(N_Vector x) { return *std::min_element(Data(x), Data(x) + Length(x)); }

/// Two terms a pass: short vectors spend their time in passes. z may be x[0], never a later one.
int LinearCombination(int count, double* c, N_Vector* x, N_Vector z) {
  double* out = Data(z);
  const std::size_t n = Length(z);
  if (count == 1) {
    Scale(c[0], x[0], z);
    return 0;
  }
  LinearSum(c[0], x[0], c[1], x[1], z);
  int k = 2;
  for (; k + 1 < count; k += 2) {
    const double *x1 = Data(x[k]), *x2 = Data(x[k + 1]);
    const double c1 = c[k], c2 = c[k + 1];
    for (std::size_t i = 0; i < n; ++i) out[i] += c1 * x1[i] + c2 * x2[i];
  }
  if (k < count) {
    const double* x1 = Data(x[k]);
    const double c1 = c[k];
    for (std::size_t i = 0; i < n; ++i) out[i] += c1 * x1[i];
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
