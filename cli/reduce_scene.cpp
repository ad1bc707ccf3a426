#include "cli/reduce_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cli/enrich_scene.hpp"
#include "cli/mass_integrals.hpp"
#include "cli/mesh_scene.hpp"
#include "cli/petsc_session.hpp"
#include "cli/picture.hpp"
#include "cli/reduce_steps.hpp"
#include "cli/section_forces.hpp"
#include "cli/version.hpp"
#include "mesh/partition.hpp"
#include "plate/ring_harmonics.hpp"
#include "reduce/condition_estimate.hpp"
#include "reduce/machine_memory.hpp"

namespace chladni::cli {
namespace {

using Eigen::MatrixXd;

std::string library_versions()
{
  std::array<char, 256> petsc_version{};
  petsc::check(PetscGetVersion(petsc_version.data(), petsc_version.size()));
  return fmt::format("Chladni {}; {}; SLEPc {}.{}.{}; Gmsh via its C++ API", version,
                     petsc_version.data(), SLEPC_VERSION_MAJOR, SLEPC_VERSION_MINOR,
                     SLEPC_VERSION_SUBMINOR);
}

FeModel assemble_scene(const Scene& scene, mesh::Mesh mesh)
{
  plate::DofMap dofs =
      plate::make_dof_map(mesh, scene.couplings, mesh::node_owners(mesh, n_ranks()), n_ranks());
  dofs.components = scene.components;
  dofs = plate::with_ring_harmonics(mesh, std::move(dofs), scene.ring_harmonics);
  Attachments attachments = find_attachments(mesh, dofs, scene.interface_nodes);
  plate::System system =
      plate::assemble(mesh, structure_of(scene), std::move(dofs), PETSC_COMM_WORLD);
  return {
      .mesh = std::move(mesh), .system = std::move(system), .attachments = std::move(attachments)};
}

Reduced reduce_as_told(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                       const reduce::Factorization& K_ss, Phases& phases)
{
  if (is_free_interface(scene.reduce.method)) {
    return reduce_by_free_modes(scene, fe, blocks, K_ss, phases);
  }
  // The modes first: the subspace of the eigen-solver is as large as the constraint modes.
  std::optional<reduce::FixedInterfaceModes> modes;
  if (scene.reduce.method == reduce::Method::craig_bampton) {
    modes = fixed_interface_modes(blocks, K_ss, scene.reduce, phases);
  }
  reduce::CraigBamptonBasis Q_CB = constraint_basis(blocks, K_ss, phases);
  Q_CB.modes = std::move(modes);
  return project_blocks(scene, fe, blocks, std::move(Q_CB), phases);
}

/// Fixed-interface modes to begin with: a cut-off and a tolerance find out how many they need, and
/// look at the memory again when their basis grows.
double modes_at_first(const reduce::ReduceOptions& wanted)
{
  if (wanted.method == reduce::Method::guyan) return 0.0;
  constexpr double unknown = 40.0;
  return wanted.modes ? *wanted.modes : unknown;
}

/// The matrices of the whole model are let go where nothing after the factor needs them.
bool needs_whole_matrices(const Scene& scene, bool counts)
{
  return counts || wants_full_responses(scene) || is_free_interface(scene.reduce.method);
}

double own_MiB(Mat A)
{
  MatInfo info{};
  petsc::check(MatGetInfo(A, MAT_LOCAL, &info));
  constexpr double for_each_entry = sizeof(PetscScalar) + sizeof(PetscInt);
  return for_each_entry * info.nz_used / reduce::bytes_in_MiB;
}

/// What this rank takes beside the factor of K_ss, at the phase that takes most: in columns of its
/// slaves the basis of block Lanczos with the modes that come out of it, or Psi and Phi with what
/// error estimates or mass integrals work in; or all of these with the factor that counts
/// eigenvalues where the scene wants it. The numbers are measured.
reduce::FactorOptions with_what_comes_beside(reduce::FactorOptions factor, const Scene& scene,
                                             const FeModel& fe, const Partitioned& blocks)
{
  PetscInt n_local = 0, n_s = 0;
  petsc::check(MatGetLocalSize(blocks.K.ss, &n_local, nullptr));
  petsc::check(MatGetSize(blocks.K.ss, &n_s, nullptr));
  constexpr double basis_for_each_mode = 2.1, least_basis = 40.0, blocks_of_lanczos = 56.0;
  constexpr double estimates = 230.0, integrals = 350.0, integrals_for_each_mode = 0.6;
  const double n_modes = std::min<double>(modes_at_first(scene.reduce), n_s);
  const double basis = std::min<double>(basis_for_each_mode * n_modes + least_basis, n_s);
  const double in_search = n_modes > 0.0 ? basis + n_modes + blocks_of_lanczos : 0.0;
  const double kept = static_cast<double>(blocks.masters.size()) + n_modes;
  const bool counts = scene.sylvester.value_or(false);
  const double bounds = counts ? std::min(n_modes, 100.0) : 0.0;  // residuals
  const double in_integrals =
      scene.mass_integrals ? integrals + integrals_for_each_mode * n_modes : 0.0;
  const double in_MiB = sizeof(double) * double(n_local) / reduce::bytes_in_MiB;
  const double let_go =
      needs_whole_matrices(scene, counts) ? 0.0 : own_MiB(fe.system.K) + own_MiB(fe.system.M);
  factor.beside_MiB =
      in_MiB * std::max(in_search, kept + std::max(estimates + bounds, in_integrals)) - let_go;
  if (counts)
    factor.second = {.entries = CountOfEigenvalues::entries_of_mumps, .beside_MiB = in_MiB * kept};
  return factor;
}

/// Of the transformation, with the columns in the order of the file.
RowsOf rows_of(const Partitioned& blocks, const Reduced& reduced)
{
  return [&](const std::vector<int>& dofs) -> MatrixXd {
    const reduce::SmallMatrix rows = reduce::basis_rows(reduced.Q_CB, blocks.rows, dofs);
    return Eigen::Map<const MatrixXd>(rows.values.data(), rows.n_rows, rows.n_cols)(Eigen::all,
                                                                                    reduced.places);
  };
}

/// Room for interface modes of the whole model, mass integrals, pictures and section forces.
Reduced with_what_bodies_need(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                              Reduced reduced, Phases& phases)
{
  if (wants_full_responses(scene)) {
    reduced = with_full_responses(scene, fe, blocks, std::move(reduced), phases);
  }
  if (scene.mass_integrals) {
    reduced.system.mass_integrals = phases.run(
        "mass integrals", [&] { return mass_integrals(structure_of(scene), fe, blocks, reduced); });
  }
  const RowsOf rows = rows_of(blocks, reduced);
  if (reduced.system.ring_motion) {
    reduced.system.ring_motion->displacements =
        node_rows(fe.attachments.nodes, fe.system.dofs, rows);
  }
  reduced.system.picture = phases.run("pictures", [&] {
    return make_picture(picture_nodes(fe.mesh, scene.pictures), fe.system.dofs, rows);
  });
  if (!scene.resultants.groups.empty()) {
    reduced.system.resultants = phases.run("section forces", [&] {
      return section_forces(scene.resultants, structure_of(scene), fe, rows);
    });
  }
  return reduced;
}

}  // namespace

ReduceSummary reduce_scene(const Scene& scene, const SaidOfSolvers& solvers,
                           const ReduceProgress& progress)
{
  Phases phases(progress);
  mesh::Mesh mesh = phases.run("mesh", [&] { return mesh_on_all_ranks(scene); });
  FeModel fe = phases.run("assembly", [&] { return assemble_scene(scene, std::move(mesh)); });
  const Partitioned blocks = phases.run("partition", [&] { return partition_scene(scene, fe); });
  reduce::SolverOptions options = solvers.options;
  options.factor = with_what_comes_beside(options.factor, scene, fe, blocks);
  const auto K_ss =
      phases.run("factorization", [&] { return factorize_slaves(fe, blocks, options); });
  const PhaseTime factorization = phases.times().back();
  const CountOfEigenvalues count(scene, blocks, K_ss);
  if (!needs_whole_matrices(scene, count.is_possible())) {  // the blocks are enough
    fe.system.K = {};
    fe.system.M = {};
  }
  Reduced reduced = scene.reduce.tolerance ? reduce_to_tolerance(scene, fe, blocks, K_ss, phases)
                                           : reduce_as_told(scene, fe, blocks, K_ss, phases);
  mbs_export::ReducedSystem& system = reduced.system;
  const auto n_modes = static_cast<int>(system.fixed_interface_frequencies.size());
  const bool counts = count.is_possible() && count.is_due(n_modes) && count.fits();
  const Certified certified = phases.run("error estimates", [&] {
    return certify_scene(scene, fe, blocks, K_ss, reduced,
                         counts ? reduce::Purpose::bounds : reduce::Purpose::estimates);
  });
  system.certificate = certified.certificate;
  const double modes_residual = phases.run("residuals", [&] {
    return reduced.Q_CB.modes && !is_free_interface(scene.reduce.method)
               ? reduce::largest_residual(*reduced.Q_CB.modes, blocks.K.ss, blocks.M.ss)
               : 0.0;
  });
  system.certificate.condition =
      phases.run("condition", [&] { return reduce::condition_estimate(K_ss); });
  system.certificate.count_share = count.share(n_modes);
  if (counts) {
    system.certificate = phases.run("count of eigenvalues", [&] {
      return count_scene(fe, blocks, system, certified.residuals);
    });
  }
  reduced = with_what_bodies_need(scene, fe, blocks, std::move(reduced), phases);
  system.provenance = {.scene = scene.text,
                       .mesh_checksum = mesh::checksum(fe.mesh),
                       .versions = library_versions(),
                       .options = solvers.text,
                       .ranks = n_ranks()};
  return {.reduced = std::move(system),
          .phases = phases.times(),
          .n_dofs = fe.system.dofs.n_dofs(),
          .n_nodes = fe.mesh.n_nodes(),
          .n_masters = static_cast<int>(blocks.masters.size()),
          .n_modes = n_modes,
          .n_modes_asked = scene.reduce.method == reduce::Method::craig_bampton
                               ? static_cast<int>(scene.reduce.modes.value_or(0))
                               : 0,
          .factorization = factorization,
          .factor = reduce::factor_size(K_ss.factor()),
          .modes_residual = modes_residual};
}

}  // namespace chladni::cli
