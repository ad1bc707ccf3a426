#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::squeal {

/// A result of each variant of a sweep.
struct SweepColumn {
  std::string name;  ///< name with unit as in the summary of a run: "critical_speed_rad_s"
  std::string unit;

  bool operator==(const SweepColumn&) const = default;
};

/// State of a variant.
enum class VariantState : std::int64_t {
  to_do = 0,
  done = 1,
  failed = 2  ///< an analysis failed; results of earlier analyses are present
};

/// Parameter values and results of the variants of a brake.
struct SweepTable {
  std::vector<std::string> keys;     ///< varied keys of the scene
  files::RowMajorMatrix values;      ///< [n_variants x n_keys] in the units of the scene
  std::vector<SweepColumn> columns;  ///< the results of each variant
  files::RowMajorMatrix results;     ///< [n_variants x n_columns]; 0 when unknown
  /// [n_variants x n_columns] 1 or 0; a stable brake, for example, has no critical speed.
  files::IntegerMatrix known;
  std::vector<VariantState> states;   ///< [n_variants]
  std::vector<std::string> failures;  ///< [n_variants] reason of a failure, else empty
  std::string inputs;                 ///< RunOrigin::inputs

  std::size_t n_variants() const { return states.size(); }
  /// Number of variants in this state.
  std::size_t count(VariantState state) const;
};

/// The table of these variants, all to do.
SweepTable empty_sweep(std::vector<std::string> keys, files::RowMajorMatrix values,
                       std::vector<SweepColumn> columns);

/// The values of a variant as text: "squeal.friction = 0.4, squeal.pads[1].preload = 2000".
std::string name_of_variant(const SweepTable& sweep, std::size_t i);

/// Attribute `format` of a sweep file.
inline constexpr auto sweep_format = "chladni-squeal-sweep";

/// Writes a file `*.sweep.h5` as a whole or not at all. Some variants may still be to do.
/// @throws chladni::Error when the file cannot be written.
void write_sweep(const std::filesystem::path& file, const SweepTable& sweep,
                 const mbs_export::Provenance& provenance);

/// Reads a file of `write_sweep`.
/// @throws chladni::Error naming file and dataset, when something is missing, has a wrong size or
///         is not finite.
SweepTable read_sweep(const files::Reader& file);

/// The table as comma-separated values: number of the variant, keys, columns, `failure`. A cell is
/// empty when its value is unknown; numbers read back as the same double.
std::string csv_of(const SweepTable& sweep);

}  // namespace chladni::squeal
