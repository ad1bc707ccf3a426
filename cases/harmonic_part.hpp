#pragma once

#include <vector>

#include "cases/picture.hpp"
#include "cases/sector_mass.hpp"
#include "cases/sector_model.hpp"

namespace chladni::cases {

/// The contribution of one harmonic to the whole body, as plain numbers that ranks can send.
struct HarmonicPart {
  int order = 0;
  std::int64_t n_coordinates = 0;
  std::vector<int> masters;    ///< `master_index` of each
  Eigen::MatrixXd K, M, C, H;  ///< masters, then modes
  Eigen::VectorXd omega;       ///< rad/s, of the modes
  reduce::Certificate certificate;
  cyclic::SectorMotion interface;  ///< rows: six components of each interface node of the sector
  cyclic::SectorMotion picture;    ///< rows: x, y, z of each node of the sector's picture
  cyclic::SectorMotion sector;     ///< rows: all DOFs of the sector; only for section forces
  cyclic::SectorMotion deviating = {};  ///< rows: SectorDeviations::rows
  /// empty if the scene wants no integrals over the mass
  HarmonicMass mass = {};
  double factor_entries = 0.0;
  double factor_s = 0.0;
  double modes_residual = 0.0;
};

/// The parts of all ranks in the order of the harmonics, on the first rank; none on the others.
/// @note   Collective on all ranks.
std::vector<HarmonicPart> gathered(std::vector<HarmonicPart> own);

/// The place in the whole of each row of each part: first its masters, then its modes among all
/// modes by frequency.
std::vector<std::vector<Eigen::Index>> places_of(const std::vector<HarmonicPart>& parts,
                                                 Eigen::Index n_masters);

/// The reduced system of the whole body from all harmonics.
/// @param whole       `described_whole`
/// @param fixed       the support of the certificates
/// @param lambda_max  up to which each harmonic is certified, rad^2/s^2
mbs_export::ReducedSystem unfolded(mbs_export::ReducedSystem whole, const SectorModel& model,
                                   const std::vector<HarmonicPart>& parts,
                                   const std::vector<std::string>& fixed, double lambda_max);

/// Adds the surface of all sectors. Its motion is stored for one sector only and is moved out of
/// the parts.
/// @param whole   `unfolded`
/// @param chosen  nodes and cells of the sector, as in the pictures of the parts
void add_picture(mbs_export::ReducedSystem& whole, const PictureNodes& chosen,
                 const SectorModel& model, std::vector<HarmonicPart>& parts);

}  // namespace chladni::cases
