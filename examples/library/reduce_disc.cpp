// From a mesh to the body that `squeal` reads: mpirun -n 2 reduce_disc
#include <slepcsys.h>

#include <cstdio>
#include <numbers>
#include <vector>

#include "mbs_export/files/body_files.hpp"
#include "mbs_export/make_body.hpp"
#include "mesh/generators.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"
#include "reduce/reduced_system.hpp"
#include "reduce/reduction.hpp"
#include "reduce/support.hpp"

namespace {

using namespace chladni;

constexpr int n_components = 6;

/// The six DOFs of the hub.
std::vector<PetscInt> hub_dofs(const plate::DofMap& dofs)
{
  std::vector<PetscInt> hub;
  for (int c = 0; c < n_components; ++c)
    hub.push_back(dofs.dof(dofs.reference_node("hub").value(), c).value());
  return hub;
}

/// What the rows of the reduced system are: the components of one node.
mbs_export::ReducedSystem described(const plate::DofMap& dofs)
{
  mbs_export::ReducedSystem system;
  system.title = "Disc on its hub";
  system.attachment_nodes = {
      {.number = 1, .position = dofs.position(dofs.reference_node("hub").value())}};
  system.sets = {{.name = "hub", .nodes = {0}}};
  for (int c = 0; c < n_components; ++c) system.masters.push_back({.node = 0, .component = c});
  return system;
}

void reduce_disc()
{
  int n_ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &n_ranks);
  // 1. An annular disc, meshed with quadrilaterals of order 3; its inner edge follows one node.
  const mesh::Mesh mesh = mesh::annulus({.inner_radius = 0.025,
                                         .outer_radius = 0.162,
                                         .element_size = 0.03,
                                         .element_order = 3,
                                         .rings = {}});
  const std::vector<plate::Coupling> couplings{{.name = "hub", .group = "inner_edge"}};
  const std::vector<plate::ShellSection> sections{
      {.group = "disc",
       .material = {.young = 9.15915e10, .poisson = 0.3, .density = 6300.0},
       .thickness = 0.02}};
  // 2. Its matrices K and M.
  plate::DofMap map = plate::make_dof_map(mesh, {.couplings = couplings},
                                          mesh::node_owners(mesh, n_ranks), n_ranks);
  plate::System fe = plate::assemble(mesh, sections, std::move(map), PETSC_COMM_WORLD);
  // 3. The hub is kept, with ten modes of the disc held there. The frequencies of that support get
  //    bounds of their errors, since the eigenvalues of the mesh are counted.
  reduce::PhaseListener silent;
  const reduce::ReductionOptions options{.basis = {.modes = 10}, .count = true};
  const std::vector<PetscInt> hub = hub_dofs(fe.dofs);
  reduce::FactoredBody body = reduce::factored(
      {.K = std::move(fe.K), .M = std::move(fe.M), .masters = hub}, options, silent);
  const reduce::Reduction reduction =
      reduce::reduction(body, options, reduce::HeldMasters(hub, hub), silent);
  // 4. The system that is written, and from it, here or elsewhere, the body of the squeal solver.
  const mbs_export::ReducedSystem reduced =
      reduce::reduced_system(described(fe.dofs), body, reduction, {"hub"});
  if (petsc::rank(PETSC_COMM_WORLD) == 0) {
    mbs_export::write_reduced("disc.reduced.h5", reduced);
    mbs_export::write_body("disc.body.h5", mbs_export::make_body(reduced, {.fixed = {"hub"}}));
  }
  // 5. The first frequency.
  PetscPrintf(PETSC_COMM_WORLD,
              "%d DOFs -> %d masters and %zu modes, the first at %.2f Hz, at most %.1e off\n",
              fe.dofs.n_dofs(), static_cast<int>(hub.size()), reduction.model.omega.size(),
              reduction.model.omega.front() / (2.0 * std::numbers::pi),
              0.5 * reduction.certificate.bounds.front());
}

}  // namespace

int main(int argc, char** argv)
{
  SlepcInitialize(&argc, &argv, nullptr, nullptr);
  try {
    reduce_disc();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  return SlepcFinalize();
}
