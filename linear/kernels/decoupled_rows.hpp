#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Sets of rows between which neither of two symmetric matrices has an entry, such as bending and
/// in-plane motion of a flat plate. The largest comes first. Small sets, and sets that lie on a few
/// of the ranks, are merged with the rest, so that each set is worth being solved separately by all
/// ranks.
/// @param K, M  AIJ with equally distributed rows
/// @return global rows, on the rank that owns them, ascending; empty if all rows form one set
/// @note   Collective.
std::vector<petsc::IndexSet> decoupled_rows(Mat K, Mat M);

/// The same of some rows, as if the others were not there.
/// @param rows  on the rank that owns them
std::vector<petsc::IndexSet> decoupled_rows(Mat K, Mat M, IS rows);

}  // namespace chladni::linear
