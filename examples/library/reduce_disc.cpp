// From a mesh to a reduced model with PETSc matrices: mpirun -n 2 reduce_disc
#include <slepcsys.h>

#include <cstdio>
#include <numbers>
#include <vector>

#include "mesh/generate.hpp"
#include "mesh/partition.hpp"
#include "plate/assemble.hpp"
#include "reduce/craig_bampton.hpp"

namespace {

using namespace chladni;

/// The six DOFs of the hub that this rank owns.
petsc::IndexSet hub_dofs(const plate::System& fe)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(fe.K, &first, &last));
  std::vector<PetscInt> own;
  const int hub = fe.dofs.reference_node("hub").value();
  for (int component = 0; component < 6; ++component) {
    const PetscInt dof = fe.dofs.dof(hub, component).value();
    if (first <= dof && dof < last) own.push_back(dof);
  }
  petsc::IndexSet masters;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(own.size()), own.data(),
                               PETSC_COPY_VALUES, masters.put()));
  return masters;
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
  const plate::System fe = plate::assemble(mesh, sections, std::move(map), PETSC_COMM_WORLD);
  // 3. The hub is the master; ten modes of the disc with the hub held.
  const reduce::DofPartition dofs = reduce::partition(fe.K, hub_dofs(fe));
  const reduce::Blocks K = reduce::split(fe.K, dofs), M = reduce::split(fe.M, dofs);
  const reduce::Factorization K_ss = reduce::factorize(K.ss);
  const reduce::CraigBamptonBasis Q_CB{reduce::constraint_modes(K_ss, K),
                                       reduce::fixed_interface_modes(K_ss, M.ss, {.modes = 10})};
  const reduce::ReducedModel reduced = reduce::project(Q_CB, K, M);
  // 4. The first of them.
  PetscPrintf(PETSC_COMM_WORLD, "%d DOFs -> %d masters and %zu modes, the first at %.2f Hz\n",
              fe.dofs.n_dofs(), static_cast<int>(reduced.n_masters), reduced.omega.size(),
              reduced.omega.front() / (2.0 * std::numbers::pi));
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
