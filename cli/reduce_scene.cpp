#include "cli/reduce_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "cli/attachments.hpp"
#include "cli/broadcast_mesh.hpp"
#include "cli/mesh_scene.hpp"
#include "cli/petsc_session.hpp"
#include "cli/picture.hpp"
#include "cli/version.hpp"
#include "mesh/partition.hpp"
#include "plate/assemble.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::cli {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The master DOFs in the order of the scene, as global DOFs of K.
std::vector<PetscInt> master_dofs(const Attachments& attachments, const plate::DofMap& dofs)
{
  std::vector<PetscInt> masters;
  for (const int node : attachments.nodes) {
    for (int c = 0; c < 6; ++c) masters.push_back(6 * dofs.number[node] + c);
  }
  return masters;
}

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

/// For each coordinate of the file (masters in the scene's order, then modes) its place in the
/// reduced model, whose masters ascend by DOF.
std::vector<int> coordinate_places(const std::vector<PetscInt>& masters, PetscInt n_modes)
{
  std::vector<PetscInt> ascending = masters;
  std::ranges::sort(ascending);
  std::vector<int> places;
  for (const PetscInt dof : masters) {
    places.push_back(
        static_cast<int>(std::ranges::lower_bound(ascending, dof) - ascending.begin()));
  }
  for (PetscInt k = 0; k < n_modes; ++k) places.push_back(static_cast<int>(std::ssize(places)));
  return places;
}

MatrixXd as_eigen(const reduce::SmallMatrix& A)
{
  return Eigen::Map<const MatrixXd>(A.values.data(), A.n_rows, A.n_cols);
}

std::string library_versions()
{
  std::array<char, 256> petsc_version{};
  petsc::check(PetscGetVersion(petsc_version.data(), petsc_version.size()));
  return fmt::format("Chladni {}; {}; SLEPc {}.{}.{}; Gmsh via its C++ API", version,
                     petsc_version.data(), SLEPC_VERSION_MAJOR, SLEPC_VERSION_MINOR,
                     SLEPC_VERSION_SUBMINOR);
}

/// What the phases hand on.
struct FeModel {
  mesh::Mesh mesh;
  plate::System system;
  Attachments attachments;
};

FeModel assemble_scene(const Scene& scene, mesh::Mesh mesh)
{
  plate::DofMap dofs =
      plate::make_dof_map(mesh, scene.couplings, mesh::node_owners(mesh, n_ranks()), n_ranks());
  Attachments attachments = find_attachments(mesh, dofs, scene.interface_nodes);
  plate::System system = plate::assemble(mesh, scene.sections, std::move(dofs), PETSC_COMM_WORLD);
  return {
      .mesh = std::move(mesh), .system = std::move(system), .attachments = std::move(attachments)};
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
    reduced.attachment_nodes.push_back(
        {.number = node_number(fe.mesh, fe.system.dofs, node), .position = {x[0], x[1], x[2]}});
    for (int c = 0; c < 6; ++c) {
      reduced.masters.push_back({.node = static_cast<int>(i), .component = c});
    }
  }
  reduced.K = as_eigen(model.K)(places, places);
  reduced.M = as_eigen(model.M)(places, places);
  reduced.fixed_interface_frequencies =
      Eigen::Map<const Eigen::VectorXd>(model.omega.data(), std::ssize(model.omega));
  return reduced;
}

/// Ends a phase of the clock when it goes out of use, and reports the progress.
class Phases {
 public:
  explicit Phases(const ReduceProgress& progress) : progress_(progress) {}

  template <typename Work>
  auto run(const std::string& name, const Work& work)
  {
    if (progress_) progress_(name, 0.0);
    auto result = work();
    clock_.end_phase(name);
    if (progress_) progress_(name, 1.0);
    return result;
  }
  const std::vector<PhaseTime>& times() const { return clock_.phases(); }

 private:
  const ReduceProgress& progress_;
  PhaseClock clock_;
};

mesh::Mesh mesh_on_all_ranks(const Scene& scene)
{
  mesh::Mesh mesh;
  on_first_rank([&] { mesh = mesh_scene(scene); });
  return broadcast(mesh);
}

}  // namespace

ReduceSummary reduce_scene(const Scene& scene, const std::string& petsc_options,
                           const ReduceProgress& progress)
{
  Phases phases(progress);
  mesh::Mesh mesh = phases.run("mesh", [&] { return mesh_on_all_ranks(scene); });
  const FeModel fe = phases.run("assembly", [&] { return assemble_scene(scene, std::move(mesh)); });
  const std::vector<PetscInt> masters = master_dofs(fe.attachments, fe.system.dofs);
  const auto rows = phases.run("partition", [&] {
    return reduce::partition(fe.system.K, own_masters(fe.system.K, masters));
  });
  const reduce::Blocks K = reduce::split(fe.system.K, rows);
  const reduce::Blocks M = reduce::split(fe.system.M, rows);
  const auto K_ss = phases.run("factorization", [&] { return reduce::factorize(K.ss); });
  const PhaseTime factorization = phases.times().back();
  reduce::CraigBamptonBasis Q_CB{
      .Psi = phases.run("constraint modes", [&] { return reduce::constraint_modes(K_ss, K); }),
      .modes = std::nullopt};
  if (scene.reduce.method == reduce::Method::craig_bampton) {
    Q_CB.modes = phases.run("fixed-interface modes", [&] {
      return reduce::fixed_interface_modes(K_ss, M.ss, scene.reduce);
    });
  }
  const auto model = phases.run("projection", [&] { return reduce::project(Q_CB, K, M); });
  const std::vector<int> places = coordinate_places(masters, Q_CB.n_modes());
  mbs_export::ReducedSystem reduced = to_file_order(scene, fe, model, places);
  reduced.picture = phases.run("pictures", [&] {
    const RowsOf rows_of = [&](const std::vector<int>& dofs) -> MatrixXd {
      return as_eigen(reduce::basis_rows(Q_CB, rows, dofs))(Eigen::all, places);
    };
    return make_picture(picture_nodes(fe.mesh, scene.pictures), fe.system.dofs, rows_of);
  });
  reduced.provenance = {.scene = scene.text,
                        .mesh_checksum = mesh::checksum(fe.mesh),
                        .versions = library_versions(),
                        .options = petsc_options,
                        .ranks = n_ranks()};
  return {.reduced = std::move(reduced),
          .phases = phases.times(),
          .n_dofs = 6 * std::int64_t(fe.system.dofs.n_active()),
          .n_nodes = fe.mesh.n_nodes(),
          .n_masters = static_cast<int>(masters.size()),
          .n_modes = static_cast<int>(Q_CB.n_modes()),
          .factorization = factorization};
}

}  // namespace chladni::cli
