// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace oca::robot {

/// The generalised inverse J# of Moore and Penrose, for any J:
///   J^T (J J^T)^-1                       if the rows are independent,
///   (J^T J)^-1 J^T                       if the columns are,
///   lim d->0 of J^T (J J^T + d I)^-1     otherwise.
/// Rows count as dependent when one lies within about 1e-6 rad of the span of the others. Takes
/// memory: for set-up and analysis; the tick's mapping is MapWrenches.
/// source report eq. (2.9), whose first row lacks the inverse
Eigen::MatrixXd PseudoInverse(const Eigen::Ref<const Eigen::MatrixXd>& J);

/// J^T (J J^T + damping^2 I)^-1 = (J^T J + damping^2 I)^-1 J^T for damping > 0, in whichever form
/// has the smaller matrix. source Nakamura and Hanafusa 1986; Wampler 1986
Eigen::MatrixXd DampedPseudoInverse(const Eigen::Ref<const Eigen::MatrixXd>& J, double damping);

}  // namespace oca::robot
