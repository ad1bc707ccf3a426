#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Sets of rows between which neither of two symmetric matrices has an entry: what happens in one
/// concerns no other, as bending and motion in the plane of a flat plate. The largest comes first.
/// What is small, or lies on a few of the ranks, is united with the rest, so that each set is worth
/// being solved for by itself, by all ranks.
/// @param K, M  AIJ with equally distributed rows
/// @return global rows, on the rank that owns them, ascending; empty where all belong together.
/// @note   Collective.
std::vector<petsc::IndexSet> decoupled_rows(Mat K, Mat M);

}  // namespace chladni::linear
