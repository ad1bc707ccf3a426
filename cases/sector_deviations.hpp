#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cases/sector_model.hpp"
#include "cases/whole_body.hpp"
#include "mbs_export/inertia.hpp"
#include "mbs_export/reduced_system.hpp"
#include "plate/assembly/inertia_integrals.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The contribution of a deviation to the integrals over the mass, in the axes of its sector.
struct DeviatingMass {
  double mass;                          ///< kg
  Eigen::Vector3d first;                ///< kg m
  Eigen::Matrix3d second;               ///< kg m^2
  Eigen::MatrixXd displacement;         ///< [n_rows x 12] as plate::MassMoments
  std::array<cyclic::SparseRows, 6> S;  ///< [n_rows squared] as MassIntegrals::products; no zz
};

/// The contribution of the deviations of one sector to its matrices, in the axes of that sector.
struct DeviatingSector {
  int sector;
  cyclic::SparseRows K, M, C, H;  ///< [n_rows squared]
  std::optional<DeviatingMass> mass;
};

/// Deviations of a body of equal sectors: forms in the motions of some DOFs of single sectors,
/// which couple the harmonics.
struct SectorDeviations {
  std::vector<int> rows;  ///< DOFs of the sector with a deviation, ascending
  std::vector<DeviatingSector> sectors;
};

/// The deviations of a scene: the matrices of the sector with them minus those without.
/// @throws chladni::Error for a mass or spring on the axis or on a cut edge, naming it, and for
///         section forces of a section that deviates.
SectorDeviations sector_deviations(const scene::Scene& scene, const SectorModel& model);

/// Adds the deviations to the matrices and integrals of the perfect body and computes constraint
/// modes and fixed-interface modes anew in its basis. The error of a frequency is of second order
/// in the part of the deviating body's shapes outside this basis. The certificate, which is that of
/// the perfect body, is removed.
/// @param parts  with `deviating`, the motions of `rows`
/// @return T [n squared]: the coordinates of the perfect body are T times the new ones; empty
///         without a deviation
/// @throws chladni::Error when stiffness or mass is no longer positive.
Eigen::MatrixXd add_deviations(mbs_export::ReducedSystem& whole, const SectorDeviations& deviations,
                               const std::vector<HarmonicPart>& parts, int count);

}  // namespace chladni::cases
