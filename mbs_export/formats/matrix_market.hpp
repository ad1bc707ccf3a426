#pragma once

#include <string>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::formats {

/// Matrices as dense symmetric Matrix Market arrays, their lower triangles with 17 digits.
struct MatrixMarket {
  std::string K, M, C;  ///< C empty without dampers
  std::string H;        ///< structural damping, empty without loss factors
  /// CSV, a line for each row of the matrices: what coordinate it is, and where.
  std::string coordinates;
};

MatrixMarket matrix_market(const ReducedSystem& reduced);

}  // namespace chladni::mbs_export::formats
