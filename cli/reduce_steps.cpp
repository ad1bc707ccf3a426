#include "cli/reduce_steps.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "cli/petsc_session.hpp"
#include "plate/rigid_motions.hpp"
#include "reduce/rigid_constraint_modes.hpp"

namespace chladni::cli {
namespace {

using Eigen::MatrixXd;

petsc::IndexSet own_masters(Mat K, const std::vector<PetscInt>& masters)
{
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  std::vector<PetscInt> own;
  std::ranges::copy_if(masters, std::back_inserter(own),
                       [&](PetscInt dof) { return dof >= first && dof < last; });
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(own.size()), own.data(),
                               PETSC_COPY_VALUES, set.put()));
  return set;
}

MatrixXd as_eigen(const reduce::SmallMatrix& A)
{
  return Eigen::Map<const MatrixXd>(A.values.data(), A.n_rows, A.n_cols);
}

/// For other programs: -cms_view_stiffness binary:K.petsc, -cms_view_mass, -cms_view_masters, and
/// what else PETSc's viewers know.
void view_from_options(const FeModel& fe, IS masters)
{
  petsc::check(MatViewFromOptions(fe.system.K, nullptr, "-cms_view_stiffness"));
  petsc::check(MatViewFromOptions(fe.system.M, nullptr, "-cms_view_mass"));
  petsc::check(ISViewFromOptions(masters, nullptr, "-cms_view_masters"));
}

/// Whether the rigid-body motions are those of the nodes, and no spring resists them.
bool geometry_tells_motions(const Scene& scene, const FeModel& fe)
{
  const bool is_free = std::ranges::all_of(
      scene.springs, [](const plate::Spring& spring) { return spring.to.has_value(); });
  return is_free && fe.system.dofs.combined_motions.empty();
}

}  // namespace

std::vector<int> coordinate_places(const std::vector<PetscInt>& masters, PetscInt n_modes)
{
  std::vector<PetscInt> ascending = masters;
  std::ranges::sort(ascending);
  std::vector<int> places;
  places.reserve(masters.size() + n_modes);
  for (const PetscInt dof : masters) {
    places.push_back(
        static_cast<int>(std::ranges::lower_bound(ascending, dof) - ascending.begin()));
  }
  for (PetscInt k = 0; k < n_modes; ++k) places.push_back(static_cast<int>(std::ssize(places)));
  return places;
}

mbs_export::ReducedSystem to_file_order(const Scene& scene, const FeModel& fe,
                                        const reduce::ReducedModel& model,
                                        const std::vector<int>& places)
{
  mbs_export::ReducedSystem reduced;
  reduced.title = scene.title;
  reduced.sets = fe.attachments.sets;
  for (std::size_t i = 0; i < fe.attachments.nodes.size(); ++i) {
    const int node = fe.attachments.nodes[i];
    const auto& x = fe.system.dofs.positions[node];
    reduced.attachment_nodes.push_back({.number = node_number(fe.mesh, fe.system.dofs, node),
                                        .position = {x[0], x[1], x[2]},
                                        .drilling_axis = fe.attachments.drilling_axes[i]});
  }
  reduced.masters = fe.attachments.masters;
  if (!fe.system.dofs.harmonic_rings.empty()) {
    const MatrixXd F = master_shapes(fe.attachments, fe.system.dofs);
    reduced.ring_motion = {.shapes = F,
                           .displacements = MatrixXd::Zero(F.rows(), std::ssize(places))};
    reduced.ring_motion->displacements.leftCols(F.cols()) = F;  // the rest follows with the basis
  }
  reduced.K = as_eigen(model.K)(places, places);
  reduced.M = as_eigen(model.M)(places, places);
  reduced.fixed_interface_frequencies =
      Eigen::Map<const Eigen::VectorXd>(model.omega.data(), std::ssize(model.omega));
  return reduced;
}

plate::Structure structure_of(const Scene& scene)
{
  return {.shells = scene.sections,
          .beams = scene.beams,
          .masses = scene.masses,
          .springs = scene.springs};
}

Partitioned partition_scene(const Scene& scene, const FeModel& fe)
{
  std::vector<PetscInt> masters(fe.attachments.master_dofs.begin(),
                                fe.attachments.master_dofs.end());
  const petsc::IndexSet own = own_masters(fe.system.K, masters);
  view_from_options(fe, own);
  reduce::DofPartition rows = reduce::partition(fe.system.K, own);
  reduce::Blocks K = reduce::split(fe.system.K, rows);
  reduce::Blocks M = reduce::split(fe.system.M, rows);
  std::optional<reduce::Blocks> C;
  if (fe.system.C != nullptr) C = reduce::split(fe.system.C, rows);
  return {
      .rows = std::move(rows),
      .K = std::move(K),
      .M = std::move(M),
      .C = std::move(C),
      .masters = std::move(masters),
      .R = geometry_tells_motions(scene, fe) ? plate::rigid_motions(fe.system) : petsc::Matrix()};
}

reduce::CraigBamptonBasis constraint_basis(const Partitioned& blocks,
                                           const reduce::Factorization& K_ss, Phases& phases)
{
  return {.Psi = phases.run("constraint modes",
                            [&] {
                              petsc::Matrix Psi = reduce::constraint_modes(K_ss, blocks.K);
                              if (blocks.R == nullptr) return Psi;
                              return reduce::with_rigid_motions(
                                  std::move(Psi),
                                  {.R = blocks.R, .dofs = blocks.rows, .K = blocks.K});
                            }),
          .modes = std::nullopt};
}

reduce::FixedInterfaceModes fixed_interface_modes(const Partitioned& blocks,
                                                  const reduce::Factorization& K_ss,
                                                  const reduce::ReduceOptions& wanted,
                                                  Phases& phases)
{
  return phases.run("fixed-interface modes",
                    [&] { return reduce::fixed_interface_modes(K_ss, blocks.M.ss, wanted); });
}

Reduced project_blocks(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                       reduce::CraigBamptonBasis Q_CB, Phases& phases)
{
  reduce::ReducedModel model =
      phases.run("projection", [&] { return reduce::project(Q_CB, blocks.K, blocks.M); });
  std::vector<int> places = coordinate_places(blocks.masters, Q_CB.n_modes());
  mbs_export::ReducedSystem system = to_file_order(scene, fe, model, places);
  if (blocks.C) system.C = as_eigen(reduce::project_form(Q_CB, *blocks.C))(places, places);
  return {.Q_CB = std::move(Q_CB),
          .model = std::move(model),
          .places = std::move(places),
          .system = std::move(system)};
}

ModeRange certified_range(const Scene& scene, double omega_last)
{
  if (scene.reduce.tolerance) {  // which holds for all of them
    return {.omega_max = 2.0 * std::numbers::pi * scene.reduce.tolerance->up_to_Hz,
            .most = std::numeric_limits<int>::max()};
  }
  return {.omega_max = omega_last, .most = 100};  // bounds the block solve
}

std::vector<std::string> certified_support(const Scene& scene, const FeModel& fe)
{
  std::vector<std::string> support;
  for (const std::string& fixed : scene.body.fixed) {
    const bool is_master = std::ranges::none_of(fe.attachments.sets, [&](const auto& set) {
      const bool is_meant = fixed == set.name || fixed.substr(0, fixed.rfind('.')) == set.name;
      return is_meant && has_ring_nodes(fe.attachments, fe.system.dofs, set);
    });
    if (is_master) support.push_back(fixed);
  }
  return support;
}

Certified certify_scene(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                        const reduce::Factorization& K_ss, const Reduced& reduced,
                        reduce::Purpose purpose)
{
  if (scene.reduce.method == reduce::Method::macneal) {  // no projection: residuals mean nothing
    Certified none;
    none.certificate.fixed = certified_support(scene, fe);
    return none;
  }
  const auto& frequencies = reduced.system.fixed_interface_frequencies;
  const Eigen::Index n = frequencies.size();
  const double omega_last = n > 0 ? frequencies[n - 1] : 0.0;
  const bool are_fixed_interface = scene.reduce.method == reduce::Method::craig_bampton;
  return certify(reduced.system,
                 {.K_ss = K_ss,
                  .Q_CB = reduced.Q_CB,
                  .K = blocks.K,
                  .M = blocks.M,
                  .places = reduced.places,
                  .lambda_left_out = are_fixed_interface ? omega_last * omega_last
                                                         : std::numeric_limits<double>::infinity()},
                 certified_support(scene, fe), certified_range(scene, omega_last), purpose);
}

}  // namespace chladni::cli
