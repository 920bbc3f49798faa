// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/near_balls.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace oca::geometry::internal {

unsigned NearBallsPortable(const double* leaf, const Eigen::Vector3d& point, double reach) {
  unsigned near = 0;
  for (int k = 0; k < kBallsOfLeaf; ++k) {
    const double x = leaf[k] - point.x();
    const double y = leaf[kBallsOfLeaf + k] - point.y();
    const double z = leaf[2 * kBallsOfLeaf + k] - point.z();
    const double sum = reach + leaf[3 * kBallsOfLeaf + k];
    // Of a gap in the leaf both are infinite, and their difference is no number.
    if (((x * x + y * y) + z * z) - sum * sum <= 0.0) near |= 1u << k;
  }
  return near;
}

#if defined(__x86_64__)
namespace {

// Without FMA, which would round otherwise than the portable one.
__attribute__((target("avx2"))) unsigned NearBallsAvx2(const double* leaf,
                                                       const Eigen::Vector3d& point, double reach) {
  const __m256d px = _mm256_set1_pd(point.x());
  const __m256d py = _mm256_set1_pd(point.y());
  const __m256d pz = _mm256_set1_pd(point.z());
  const __m256d r = _mm256_set1_pd(reach);
  unsigned near = 0;
  for (int k = 0; k < kBallsOfLeaf; k += 4) {
    const __m256d x = _mm256_sub_pd(_mm256_loadu_pd(leaf + k), px);
    const __m256d y = _mm256_sub_pd(_mm256_loadu_pd(leaf + kBallsOfLeaf + k), py);
    const __m256d z = _mm256_sub_pd(_mm256_loadu_pd(leaf + 2 * kBallsOfLeaf + k), pz);
    const __m256d sum = _mm256_add_pd(r, _mm256_loadu_pd(leaf + 3 * kBallsOfLeaf + k));
    const __m256d square =
        _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(x, x), _mm256_mul_pd(y, y)), _mm256_mul_pd(z, z));
    const __m256d beyond = _mm256_sub_pd(square, _mm256_mul_pd(sum, sum));
    const __m256d is_near = _mm256_cmp_pd(beyond, _mm256_setzero_pd(), _CMP_LE_OQ);
    near |= static_cast<unsigned>(_mm256_movemask_pd(is_near)) << k;
  }
  return near;
}

const bool kNearBallsHasAvx2 = __builtin_cpu_supports("avx2");

}  // namespace
#endif

unsigned NearBalls(const double* leaf, const Eigen::Vector3d& point, double reach) {
#if defined(__x86_64__)
  if (kNearBallsHasAvx2) return NearBallsAvx2(leaf, point, reach);
#endif
  return NearBallsPortable(leaf, point, reach);
}

}  // namespace oca::geometry::internal
