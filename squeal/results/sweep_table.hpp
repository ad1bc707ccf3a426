#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "files/hdf5.hpp"

namespace chladni::squeal {

/// A number that each variant of a sweep yields.
struct SweepColumn {
  std::string name;  ///< with its unit, as in the summaries of one run: "critical_speed_rad_s"
  std::string unit;

  bool operator==(const SweepColumn&) const = default;
};

/// What has become of a variant.
enum class VariantState : std::int64_t {
  to_do = 0,
  done = 1,
  failed = 2  ///< an analysis gave no result; what came before it is there
};

/// Some numbers for each of many variants of a brake.
struct SweepTable {
  std::vector<std::string> keys;      ///< of the scene, those that vary
  files::RowMajorMatrix values;       ///< [n_variants x n_keys] in the unit of the scene
  std::vector<SweepColumn> columns;   ///< what is found of each variant
  files::RowMajorMatrix results;      ///< [n_variants x n_columns]; 0 where it is not known
  files::IntegerMatrix known;         ///< [n_variants x n_columns] 1 or 0: a brake may be stable
  std::vector<VariantState> states;   ///< [n_variants]
  std::vector<std::string> failures;  ///< [n_variants] why one failed; else empty
  std::string inputs;                 ///< RunOrigin::inputs

  std::size_t n_variants() const { return states.size(); }
  std::size_t count(VariantState state) const;
};

/// The variants of these values, all to do.
SweepTable empty_sweep(std::vector<std::string> keys, files::RowMajorMatrix values,
                       std::vector<SweepColumn> columns);

/// "squeal.friction = 0.4, squeal.pads[1].preload = 2000"
std::string name_of_variant(const SweepTable& sweep, std::size_t i);

}  // namespace chladni::squeal
