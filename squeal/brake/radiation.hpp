#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"
#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// What the sound that each mode radiates does to it.
struct Radiation {
  std::vector<int> mode_numbers;  ///< [n] 1-based in the body
  Eigen::VectorXd omega;          ///< [n] of these modes, rad/s
  Eigen::VectorXd at;             ///< [n] at which the next two hold, rad/s
  Eigen::VectorXd damping;        ///< [n] c in q'' + c q' + omega^2 q = 0, 1/s
  Eigen::VectorXd added_mass;     ///< [n] of the air, relative to the modal mass 1
};

/// The disc with C increased by the damping of its modes.
/// @throws chladni::Error naming a mode of the disc that is missing or has another frequency: the
///         radiation belongs to another body.
Disc with_radiation(Disc disc, const Radiation& radiation);

/// `*.radiation.h5`: written to a temporary name, flushed and renamed.
void write_radiation(const std::filesystem::path& file, const Radiation& radiation,
                     const std::string& title, const mbs_export::Provenance& provenance);

/// @throws chladni::Error naming file and dataset for anything missing, of wrong size or not
///         finite.
Radiation read_radiation(const std::filesystem::path& file);
Radiation read_radiation(const files::Reader& file);

}  // namespace chladni::squeal
