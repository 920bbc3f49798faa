// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

/// Gives the answer of a search the digits that it lacks where a core is round: a normal that is
/// right to rounding, not to the square root of the proof.
///
/// Each of the nearest points lies between branches a_k - b_k of A - B: corners stay where they
/// are, points of round branches follow the normal n. Where w = sum mu_k w_k(n) = d n and all
/// n . w_k are equal, n is the normal. Newton's method solves that, with the branches of `points`
/// first and others as the support function names them.
///
/// `found` changes only if the support function proves the new normal no worse; true if it did.
/// source KKT conditions of max over |n| = 1 of n . w(n), w(n) the support point of A - B along -n
bool RefineContact(const CorePair& pair, std::span<const CorePair::Difference> points,
                   CoreDistance* found);

}  // namespace oca::geometry::internal
