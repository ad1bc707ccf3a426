#include "cli/reduce_scene.hpp"

#include <fmt/format.h>

#include <array>

#include "cli/mesh_scene.hpp"
#include "cli/petsc_session.hpp"
#include "cli/picture.hpp"
#include "cli/reduce_steps.hpp"
#include "cli/section_forces.hpp"
#include "cli/version.hpp"
#include "mesh/partition.hpp"

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
  Attachments attachments = find_attachments(mesh, dofs, scene.interface_nodes);
  plate::System system =
      plate::assemble(mesh, structure_of(scene), std::move(dofs), PETSC_COMM_WORLD);
  return {
      .mesh = std::move(mesh), .system = std::move(system), .attachments = std::move(attachments)};
}

Reduced reduce_as_told(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                       const reduce::Factorization& K_ss, Phases& phases)
{
  // The modes first: the subspace of the eigen-solver is as large as the constraint modes.
  std::optional<reduce::FixedInterfaceModes> modes;
  if (scene.reduce.method == reduce::Method::craig_bampton) {
    modes = fixed_interface_modes(blocks, K_ss, scene.reduce, phases);
  }
  reduce::CraigBamptonBasis Q_CB = constraint_basis(blocks, K_ss, phases);
  Q_CB.modes = std::move(modes);
  return project_blocks(scene, fe, blocks, std::move(Q_CB), phases);
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

}  // namespace

ReduceSummary reduce_scene(const Scene& scene, const std::string& petsc_options,
                           const ReduceProgress& progress)
{
  Phases phases(progress);
  mesh::Mesh mesh = phases.run("mesh", [&] { return mesh_on_all_ranks(scene); });
  FeModel fe = phases.run("assembly", [&] { return assemble_scene(scene, std::move(mesh)); });
  const Partitioned blocks = phases.run("partition", [&] { return partition_scene(fe); });
  fe.system.K = {};  // its blocks are enough
  fe.system.M = {};
  const auto K_ss = phases.run("factorization", [&] { return reduce::factorize(blocks.K.ss); });
  const PhaseTime factorization = phases.times().back();
  Reduced reduced = scene.reduce.tolerance ? reduce_to_tolerance(scene, fe, blocks, K_ss, phases)
                                           : reduce_as_told(scene, fe, blocks, K_ss, phases);
  mbs_export::ReducedSystem& system = reduced.system;
  const auto n_modes = static_cast<int>(system.fixed_interface_frequencies.size());
  system.certificate = phases.run(
      "error estimates", [&] { return certify_scene(scene, blocks, K_ss, reduced, n_modes); });
  const RowsOf rows = rows_of(blocks, reduced);
  system.picture = phases.run("pictures", [&] {
    return make_picture(picture_nodes(fe.mesh, scene.pictures), fe.system.dofs, rows);
  });
  if (!scene.resultants.empty()) {
    system.resultants = phases.run(
        "section forces", [&] { return section_forces(scene.resultants, scene.beams, fe, rows); });
  }
  system.provenance = {.scene = scene.text,
                       .mesh_checksum = mesh::checksum(fe.mesh),
                       .versions = library_versions(),
                       .options = petsc_options,
                       .ranks = n_ranks()};
  return {.reduced = std::move(system),
          .phases = phases.times(),
          .n_dofs = fe.system.dofs.n_dofs(),
          .n_nodes = fe.mesh.n_nodes(),
          .n_masters = static_cast<int>(blocks.masters.size()),
          .n_modes = n_modes,
          .factorization = factorization};
}

}  // namespace chladni::cli
