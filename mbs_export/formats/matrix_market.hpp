#pragma once

#include <string>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::formats {

/// The matrices of a reduced system as dense symmetric Matrix Market arrays: lower triangles with
/// 17 digits.
struct MatrixMarket {
  std::string K, M, C;  ///< C is empty without dampers
  std::string H;        ///< structural damping, empty without loss factors
  /// CSV with a line for each row of the matrices: its coordinate and place.
  std::string coordinates;
};

MatrixMarket matrix_market(const ReducedSystem& reduced);

}  // namespace chladni::mbs_export::formats
