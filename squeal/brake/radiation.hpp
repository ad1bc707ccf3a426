#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "common/files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"
#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// Radiation damping and added mass of modes by the air.
struct Radiation {
  std::vector<int> mode_numbers;  ///< [n] 1-based numbers of the body's modes
  Eigen::VectorXd omega;          ///< [n] frequencies of these modes, rad/s
  Eigen::VectorXd at;  ///< [n] frequencies at which damping and added mass were computed, rad/s
  Eigen::VectorXd damping;     ///< [n] c in q'' + c q' + omega^2 q = 0, 1/s
  Eigen::VectorXd added_mass;  ///< [n] added mass relative to the modal mass 1
};

/// The disc with the radiation damping added to C.
/// @throws chladni::Error naming a mode of the disc that is missing or has another frequency,
///         because the radiation belongs to another body.
Disc with_radiation(Disc disc, const Radiation& radiation);

/// Writes a file `*.radiation.h5`, under a temporary name that is flushed and then renamed.
void write_radiation(const std::filesystem::path& file, const Radiation& radiation,
                     const std::string& title, const mbs_export::Provenance& provenance);

/// Reads a file `*.radiation.h5`.
/// @throws chladni::Error naming file and dataset, when something is missing, has a wrong size or
///         is not finite.
Radiation read_radiation(const std::filesystem::path& file);
Radiation read_radiation(const files::Reader& file);

}  // namespace chladni::squeal
