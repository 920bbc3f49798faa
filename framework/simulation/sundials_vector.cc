// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/sundials_vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

namespace oca::internal {
namespace {

double* Data(N_Vector v) { return NV_DATA_S(v); }
std::size_t Length(N_Vector v) { return static_cast<std::size_t>(NV_LENGTH_S(v)); }

/// Two doubles in one register of every x86-64 and ARM64 processor.
using Pair = double __attribute__((vector_size(16)));

Pair LoadPair(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

void StorePair(Pair pair, double* to) { std::memcpy(to, &pair, sizeof pair); }

void LinearSum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const double *u = Data(x), *v = Data(y);
  double* out = Data(z);
  const std::size_t n = Length(z);
  std::size_t i = 0;
  for (; i + 2 <= n; i += 2) StorePair(a * LoadPair(u + i) + b * LoadPair(v + i), out + i);
  if (i < n) out[i] = a * u[i] + b * v[i];
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
    if (x != z) std::copy_n(Data(x), Length(z), Data(z));  // also of no numbers
    return;
  }
  const double* u = Data(x);
  double* out = Data(z);
  const std::size_t n = Length(z);
  std::size_t i = 0;
  for (; i + 2 <= n; i += 2) StorePair(c * LoadPair(u + i), out + i);
  if (i < n) out[i] = c * u[i];
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
  Pair even{}, odd{};  // two sums, so that one addition need not wait for the other
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    const Pair first = LoadPair(u + i) * LoadPair(v + i);
    const Pair second = LoadPair(u + i + 2) * LoadPair(v + i + 2);
    even += first * first;
    odd += second * second;
  }
  even += odd;
  double sum = even[0] + even[1];
  for (; i < n; ++i) sum += (u[i] * v[i]) * (u[i] * v[i]);
  return std::sqrt(sum / static_cast<double>(n));
}

double Minimum(N_Vector x) { return *std::min_element(Data(x), Data(x) + Length(x)); }

/// z = sum_k c_k x_k in one pass, with c in registers. z may be x[0].
template <std::size_t... K>
void Combine(const double* c, N_Vector* x, N_Vector z, std::index_sequence<K...>) {
  const std::array<double, sizeof...(K)> weight{c[K]...};
  const std::array<const double*, sizeof...(K)> in{Data(x[K])...};
  double* const out = Data(z);
  const std::size_t n = Length(z);
  std::size_t i = 0;
  for (; i + 2 <= n; i += 2) {
    StorePair((... + (weight[K] * LoadPair(in[K] + i))), out + i);
  }
  if (i < n) out[i] = (... + (weight[K] * in[K][i]));
}

int LinearCombination(int count, double* c, N_Vector* x, N_Vector z) {
  using Function = void (*)(const double*, N_Vector*, N_Vector);
  static constexpr auto kCombine = []<std::size_t... N>(std::index_sequence<N...>) {
    return std::array<Function, sizeof...(N)>{[](const double* a, N_Vector* v, N_Vector out) {
      Combine(a, v, out, std::make_index_sequence<N + 1>());
    }...};
  }
  (std::make_index_sequence<8>());
  const int first = std::min<int>(count, kCombine.size());
  kCombine[static_cast<std::size_t>(first - 1)](c, x, z);
  for (int k = first; k < count; ++k) LinearSum(1.0, z, c[k], x[k], z);
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
