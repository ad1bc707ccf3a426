#pragma once

#include <vector>

#include "cases/picture.hpp"
#include "cases/sector_mass.hpp"
#include "cases/sector_model.hpp"
#include "mbs_export/inertia.hpp"

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

/// The certificate of all harmonics together. If no harmonic misses a mode, the eigenvalue at each
/// place in the order is at least the one at this place among the lower limits lambda / (1 + bound)
/// of all harmonics.
/// @param fixed       the support of the certificates
/// @param lambda_max  up to which each harmonic is certified, rad^2/s^2
mbs_export::Certificate whole_certificate(const std::vector<HarmonicPart>& parts,
                                          const std::vector<std::string>& fixed, double lambda_max);

/// Adds the accuracy of the responses: that of the worst loaded harmonic.
void add_responses(mbs_export::Certificate& whole, const std::vector<HarmonicPart>& parts,
                   const std::vector<std::string>& loads);

/// The integrals over the mass of the whole body, from the contributions of the harmonics.
/// @param M  of the whole body, [n x n]
mbs_export::MassIntegrals sector_integrals(const SectorMass& mass,
                                           const std::vector<HarmonicPart>& parts,
                                           const Eigen::MatrixXd& M, Eigen::Index n_masters);

/// The section forces of all sectors from those of the first: `section_forces` in axes that turn
/// with the sector. Element numbers of later sectors continue after the largest of the first.
/// @param parts      with the motion of all DOFs of the sector
/// @param n          number of coordinates of the whole body
/// @param n_masters  number of masters among them
/// @throws chladni::Error as `section_forces`.
std::vector<mbs_export::ResultantModes> sector_forces(const scene::Scene& scene,
                                                      const SectorModel& model,
                                                      const std::vector<HarmonicPart>& parts,
                                                      Eigen::Index n, Eigen::Index n_masters);

}  // namespace chladni::cases
