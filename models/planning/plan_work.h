// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::planning {

/// The work of a plan, counted: the same on every machine.
struct PlanWork {
  long plans{0};
  long band{0};     ///< configurations at which a band was looked at, distances or rows
  long exact{0};    ///< others that were looked at by exact distances alone, for certificates
  long batches{0};  ///< of up to eight configurations at once, samples or pieces of a path

  long looks() const { return band + exact + batches; }
};

/// What work counts as, s: what it takes on one machine, whatever machine it is done on. The
/// defaults are those of one core of an AMD EPYC server in 2026, release build, lwr4 among 10 and
/// 20 bodies; `oca_bench --benchmark_filter=plan_cost` prints those of another.
struct PlanPrices {
  double plan{2e-5};
  double band{2.6e-6};
  double exact{7.5e-6};
  double batch{7e-6};

  double Of(const PlanWork& work) const {
    return plan * static_cast<double>(work.plans) + band * static_cast<double>(work.band) +
           exact * static_cast<double>(work.exact) + batch * static_cast<double>(work.batches);
  }
};

}  // namespace oca::planning
