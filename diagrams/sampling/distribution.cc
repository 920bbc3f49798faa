// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sampling/distribution.h"

#include <fmt/format.h>

#include <cmath>

namespace oca::sampling {
namespace {

// How many grid points an interval has; a step that meets the end but for rounding meets it.
std::uint64_t GridPoints(const Interval& interval, double step) {
  return static_cast<std::uint64_t>((interval.upper - interval.lower) / step + 1e-9) + 1;
}

}  // namespace

Interval ReadInterval(const Eigen::VectorXd& pair, double least, const Value& value,
                      const std::string& where, Problems& problems) {
  if (pair.size() == 2 && pair[0] <= pair[1] && pair[0] >= least) return {pair[0], pair[1]};
  const std::string bound = std::isfinite(least) ? fmt::format(" >= {}", least) : "";
  problems.Add(value.location(),
               fmt::format("{}: got {}; expected two numbers{}, the lower one first", where,
                           pair.size() == 2 ? fmt::format("[{}, {}]", pair[0], pair[1])
                                            : fmt::format("{} numbers", pair.size()),
                           bound));
  return {};
}

void DistributionParams::Describe(Fields<DistributionParams>& fields) {
  using P = DistributionParams;
  fields.Add("uniform", &P::uniform, "", "anywhere between two numbers");
  fields.Add("step", &P::step, "", "of the grid that uniform numbers lie on; from the lower end")
      .Above(0.0);
  fields.Add("integers", &P::integers, "", "whole numbers from the first to the second");
  fields.Add("choose", &P::choose, "", "one of these numbers");
}

Distribution::Distribution(const Value& value, const std::string& where, Problems& problems) {
  Problems own;
  ReadFields(value, FieldsOf<DistributionParams>(), where, &params_, own);
  problems.Add(own);
  if (!own.empty()) return;
  const DistributionParams& p = params_;
  const int kinds = (p.uniform ? 1 : 0) + (p.integers ? 1 : 0) + (p.choose ? 1 : 0);
  if (kinds != 1) {
    problems.Add(value.location(),
                 fmt::format("{}: got {} of uniform, integers and choose; expected one", where,
                             kinds == 0 ? "none" : std::to_string(kinds)));
    return;
  }
  if (p.step && !p.uniform) {
    problems.Add(value.location(),
                 fmt::format("{}.step: got one; expected none without uniform", where));
  }
  constexpr double kAny = -std::numeric_limits<double>::infinity();
  if (p.uniform) {
    interval_ =
        ReadInterval(*p.uniform, kAny, *value.Find("uniform"), where + ".uniform", problems);
  }
  if (p.uniform && p.step && !((interval_.upper - interval_.lower) / *p.step < 1e9)) {
    problems.Add(value.location(),
                 fmt::format("{}.step: got {}; expected at most 1e9 steps", where, *p.step));
  }
  if (p.integers) {
    interval_ =
        ReadInterval(*p.integers, kAny, *value.Find("integers"), where + ".integers", problems);
    const auto whole = [](double x) { return x == std::floor(x) && std::abs(x) < 1e9; };
    if (!whole(interval_.lower) || !whole(interval_.upper)) {
      problems.Add(value.location(),
                   fmt::format("{}.integers: got [{}, {}]; expected whole numbers below 1e9", where,
                               interval_.lower, interval_.upper));
    }
  }
  if (p.choose && p.choose->size() == 0) {
    problems.Add(value.location(), fmt::format("{}.choose: got none; expected numbers", where));
  }
}

Value Distribution::Draw(models::Random& random, const Location& location) const {
  if (params_.choose) {
    const auto count = static_cast<std::uint64_t>(params_.choose->size());
    return Value((*params_.choose)[static_cast<Eigen::Index>(random.Below(count))], location);
  }
  if (params_.integers) {
    const auto lower = static_cast<std::int64_t>(interval_.lower);
    const auto count = static_cast<std::uint64_t>(interval_.upper - interval_.lower) + 1;
    return Value(lower + static_cast<std::int64_t>(random.Below(count)), location);
  }
  if (!params_.step) return Value(interval_.Draw(random), location);
  const auto place = static_cast<double>(random.Below(GridPoints(interval_, *params_.step)));
  return Value(std::round((interval_.lower + place * *params_.step) * 1e12) / 1e12, location);
}

}  // namespace oca::sampling
