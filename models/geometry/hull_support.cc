// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/hull_support.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace oca::geometry::internal {

int FarthestVertexPortable(const ConvexHull& hull, const Eigen::Vector3d& direction) {
  const int n = hull.column_size;
  const double* const x = hull.columns.data();
  const double* const y = x + n;
  const double* const z = y + n;
  int best = 0;
  double farthest = x[0] * direction.x() + y[0] * direction.y() + z[0] * direction.z();
  for (int i = 1; i < n; ++i) {
    const double along = x[i] * direction.x() + y[i] * direction.y() + z[i] * direction.z();
    if (along > farthest) farthest = along, best = i;
  }
  return best < static_cast<int>(hull.vertices.size()) ? best : 0;
}

#if defined(__x86_64__)
namespace {

// Two accumulators of four lanes each hide the latency of the comparison.
__attribute__((target("avx2,fma"))) int FarthestVertexAvx2(const ConvexHull& hull,
                                                           const Eigen::Vector3d& direction) {
  const int n = hull.column_size;
  const double* const x = hull.columns.data();
  const double* const y = x + n;
  const double* const z = y + n;
  const __m256d dx = _mm256_set1_pd(direction.x());
  const __m256d dy = _mm256_set1_pd(direction.y());
  const __m256d dz = _mm256_set1_pd(direction.z());
  const __m256i step = _mm256_set1_epi64x(8);
  __m256i here[2] = {_mm256_setr_epi64x(0, 1, 2, 3), _mm256_setr_epi64x(4, 5, 6, 7)};
  __m256i index[2] = {here[0], here[1]};
  __m256d farthest[2];
  for (int i = 0; i < n; i += 8) {
    for (int k = 0; k < 2; ++k) {
      const int at = i + 4 * k;
      __m256d along = _mm256_mul_pd(_mm256_loadu_pd(x + at), dx);
      along = _mm256_fmadd_pd(_mm256_loadu_pd(y + at), dy, along);
      along = _mm256_fmadd_pd(_mm256_loadu_pd(z + at), dz, along);
      if (i == 0) {
        farthest[k] = along;
      } else {
        const __m256d better = _mm256_cmp_pd(along, farthest[k], _CMP_GT_OQ);
        farthest[k] = _mm256_blendv_pd(farthest[k], along, better);
        index[k] = _mm256_blendv_epi8(index[k], here[k], _mm256_castpd_si256(better));
      }
      here[k] = _mm256_add_epi64(here[k], step);
    }
  }
  alignas(32) double value[8];
  alignas(32) long long place[8];
  for (int k = 0; k < 2; ++k) {
    _mm256_store_pd(value + 4 * k, farthest[k]);
    _mm256_store_si256(reinterpret_cast<__m256i*>(place + 4 * k), index[k]);
  }
  int best = 0;
  for (int lane = 1; lane < 8; ++lane) {
    if (value[lane] > value[best]) best = lane;
  }
  const int vertex = static_cast<int>(place[best]);
  return vertex < static_cast<int>(hull.vertices.size()) ? vertex : 0;
}

const bool kHasAvx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");

}  // namespace
#endif

int FarthestVertex(const ConvexHull& hull, const Eigen::Vector3d& direction) {
#if defined(__x86_64__)
  if (kHasAvx2) return FarthestVertexAvx2(hull, direction);
#endif
  return FarthestVertexPortable(hull, direction);
}

}  // namespace oca::geometry::internal
