#pragma once

#include <malloc.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/attachments.hpp"
#include "cli/certify.hpp"
#include "cli/reduce_scene.hpp"
#include "cli/scene/scene.hpp"
#include "cli/timing.hpp"
#include "mesh/mesh.hpp"
#include "plate/assemble.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/progress.hpp"

/// The steps of reduce_scene and what they hand on.
namespace chladni::cli {

struct FeModel {
  mesh::Mesh mesh;
  plate::System system;
  Attachments attachments;
};

/// The small systems and what they were made with.
struct Reduced {
  reduce::CraigBamptonBasis Q_CB;
  reduce::ReducedModel model;
  std::vector<int> places;
  mbs_export::ReducedSystem system;  ///< in the order of the file
};

/// The matrices that all steps share.
struct Partitioned {
  reduce::DofPartition rows;
  reduce::Blocks K, M;
  std::optional<reduce::Blocks> C;  ///< where there are dampers
  std::vector<PetscInt> masters;
  petsc::Matrix R;  ///< [n x 6] rigid-body motions; none where springs hold the body, or couplings
                    ///< have DOFs that are no displacements of nodes
};

/// Ends a phase of the clock when it goes out of use, and reports the progress.
class Phases {
 public:
  explicit Phases(const ReduceProgress& progress) : progress_(progress) {}

  template <typename Work>
  auto run(const std::string& name, const Work& work)
  {
    if (progress_) progress_(name, 0.0);
    const reduce::ListenToProgress listener([&](double fraction) {
      if (progress_) progress_(name, fraction);
    });
    auto result = work();
    malloc_trim(0);  // what a phase has let go is there for the next one, in pieces of any size
    clock_.end_phase(name);
    if (progress_) progress_(name, 1.0);
    return result;
  }
  const std::vector<PhaseTime>& times() const { return clock_.phases(); }

 private:
  const ReduceProgress& progress_;
  PhaseClock clock_;
};

/// What the body of the scene is made of; refers to the scene.
plate::Structure structure_of(const Scene& scene);

Partitioned partition_scene(const Scene& scene, const FeModel& fe);

/// The factor of K_ss.
/// @throws chladni::Error that names the node that moves most where a part of the body is free.
reduce::Factorization factorize_slaves(const FeModel& fe, const Partitioned& blocks,
                                       const reduce::SolverOptions& options);

/// Psi alone.
reduce::CraigBamptonBasis constraint_basis(const Partitioned& blocks,
                                           const reduce::Factorization& K_ss, Phases& phases);

reduce::FixedInterfaceModes fixed_interface_modes(const Partitioned& blocks,
                                                  const reduce::Factorization& K_ss,
                                                  const reduce::ReduceOptions& wanted,
                                                  Phases& phases);

Reduced project_blocks(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                       reduce::CraigBamptonBasis Q_CB, Phases& phases);

/// The modes whose errors the scene wants to know: up to the frequency that it promises, otherwise
/// up to the last fixed-interface mode.
/// @param omega_last  of that one, rad/s; 0 without any
ModeRange certified_range(const Scene& scene, double omega_last);

/// The supports of the scene's body that hold masters: those that hold nodes of a ring of harmonics
/// leave a residual that the certificate does not know.
std::vector<std::string> certified_support(const Scene& scene, const FeModel& fe);

/// Estimates up to the frequency that the scene promises.
Certified certify_scene(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                        const reduce::Factorization& K_ss, const Reduced& reduced,
                        reduce::Purpose purpose);

/// In the order of the file, without picture and certificate.
mbs_export::ReducedSystem to_file_order(const Scene& scene, const FeModel& fe,
                                        const reduce::ReducedModel& model,
                                        const std::vector<int>& places);

/// For each coordinate of the file (masters in the scene's order, then modes) its place in the
/// reduced model, whose masters ascend by DOF.
std::vector<int> coordinate_places(const std::vector<PetscInt>& masters, PetscInt n_modes);

/// Whether the eigenvalues of the FE model are counted: as the scene says, or else where that takes
/// less than a tenth of the reduction, by the operations of both.
class CountOfEigenvalues {
 public:
  CountOfEigenvalues(const Scene& scene, const Partitioned& blocks,
                     const reduce::Factorization& K_ss);

  /// The count as a share of the reduction with a number of fixed-interface modes.
  double share(int n_modes) const;
  bool is_due(int n_modes) const;
  /// False where it is known before the reduction that nothing will be counted.
  bool is_possible() const;
  /// Whether there is memory for it; true where the scene wants it, and the factor was refused
  /// else.
  /// @note   Collective.
  bool fits() const;

  /// What MUMPS takes for a factor with pivoting and its copies of the matrix, in multiples of the
  /// entries of ours.
  static constexpr double entries_of_mumps = 4.4;

 private:
  const Scene& scene_;
  reduce::FactorSize factor_;
  double n_slaves_, n_masters_;
};

/// Counts the eigenvalues of the FE model and bounds the errors, for the certificate of `system`.
/// @param system     [first rank]
/// @param residuals  of `Certified`
mbs_export::Certificate count_scene(const FeModel& fe, const Partitioned& blocks,
                                    const mbs_export::ReducedSystem& system,
                                    const reduce::SmallMatrix& residuals);

/// Rubin's and MacNeal's methods.
bool is_free_interface(reduce::Method method);
Reduced reduce_by_free_modes(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                             const reduce::Factorization& K_ss, Phases& phases);

/// As few modes as keep the tolerance of the scene.
Reduced reduce_to_tolerance(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                            const reduce::Factorization& K_ss, Phases& phases);

}  // namespace chladni::cli
