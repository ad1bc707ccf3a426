#pragma once

#include <array>
#include <map>
#include <vector>

#include "cases/sector_model.hpp"
#include "mbs_export/inertia.hpp"
#include "plate/assembly/inertia_integrals.hpp"

namespace chladni::cases {

/// Motions of harmonics that may be coupled, by their order.
using MotionsOfHarmonics = std::map<int, cyclic::SectorMotion>;

/// The blocks of MassIntegrals::products between two harmonics of the whole body; S_zz is empty.
struct MassCoupling {
  int other;  ///< its order, at most that of the harmonic
  std::array<Eigen::MatrixXd, 6> of_other, of_other_transposed;  ///< [n_other x n], [n x n_other]
};

/// The contribution of one harmonic to the integrals over the mass of the whole body.
struct HarmonicMass {
  Eigen::MatrixXd displacement, position_displacement;  ///< [3 x n], [9 x n]; see MassIntegrals
  /// with itself and with lower harmonics
  std::vector<MassCoupling> couplings;
};

/// One of the two motions x and y of a harmonic.
struct HarmonicPhase {
  int order;
  bool of_y;
};

/// Integrals over the mass of a body of equal sectors from those of its sector. A turn by one
/// sector takes x to R x, so each integral is a sum over the sectors of products with R and the
/// phases. Harmonics are coupled only if their orders differ by at most `reach`.
class SectorMass {
 public:
  static constexpr int reach = 2;

  /// Refers to the model, which must outlive this object.
  SectorMass(const scene::Scene& scene, const SectorModel& model);
  SectorMass(const SectorMass&) = delete;
  SectorMass& operator=(const SectorMass&) = delete;

  /// The contribution of a harmonic.
  /// @param motions  of all DOFs of the sector, for this harmonic and the `reach` lower ones
  HarmonicMass of_harmonic(int order, const MotionsOfHarmonics& motions) const;

  /// The part that does not depend on motions: mass, first and second moments of the whole body.
  mbs_export::MassIntegrals of_rigid_body() const;

 private:
  /// The coupling of motions in the direction p with all others.
  struct MovingRows {
    std::vector<Eigen::Index> rows;       ///< those of DOFs that move in this direction
    std::array<cyclic::SparseRows, 3> S;  ///< S_px, S_py, S_pz; these rows alone
  };

  /// The form S_pq of the sector between the motions of two phases.
  struct PhasedProduct {
    HarmonicPhase a, b;
    int p, q;
    Eigen::MatrixXd G;
  };

  MovingRows moving_rows(int p) const;
  /// Adds the contribution of the product to S_kl and, transposed as S_qp, to S_kl of the whole
  /// body.
  void add_product(MassCoupling& coupling, const PhasedProduct& product) const;
  /// The couplings of harmonic n with itself and with lower ones.
  std::vector<MassCoupling> couplings(int n, const MotionsOfHarmonics& motions) const;

  int count_;
  plate::Structure structure_;
  plate::MassModel mass_;
  plate::MassMoments moments_;
  std::array<MovingRows, 3> moving_;
};

}  // namespace chladni::cases
