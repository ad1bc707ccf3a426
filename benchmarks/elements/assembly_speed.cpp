// What does the assembly of K and M cost, in time and memory, against one factorisation of the same
// matrix? Prints one JSON line; run it under mpirun for more ranks.
// usage: element_assembly_speed ORDER ELEMENT_SIZE_M

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <exception>

#include "common/petsc.hpp"
#include "linear/cholesky/factorization.hpp"
#include "mesh/generators.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"
#include "reduce/partition.hpp"

namespace chladni::benchmarks {
namespace {

/// CPU seconds of `work` on the slowest rank: other programs do not disturb them.
template <typename Work>
auto timed(double& seconds, const Work& work)
{
  MPI_Barrier(PETSC_COMM_WORLD);
  const std::clock_t start = std::clock();
  auto result = work();
  seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  MPI_Allreduce(MPI_IN_PLACE, &seconds, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return result;
}

/// Bytes that the program holds in memory on all ranks.
double resident_bytes()
{
  PetscLogDouble bytes = 0.0;
  petsc::check(PetscMemoryGetCurrentUsage(&bytes));
  double sum = bytes;
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sum;
}

/// The rigid hub held: its six DOFs are the masters.
petsc::IndexSet hub_dofs(const plate::System& system)
{
  const int first = 6 * system.dofs.number(*system.dofs.reference_node("hub"));
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(system.K, &begin, &end));
  petsc::IndexSet masters;
  petsc::check(ISCreateStride(PETSC_COMM_WORLD, first >= begin && first < end ? 6 : 0, first, 1,
                              masters.put()));
  return masters;
}

void run(int order, double element_size)
{
  const mesh::Mesh mesh = mesh::annulus({.inner_radius = 0.025,
                                         .outer_radius = 0.162,
                                         .element_size = element_size,
                                         .element_order = order,
                                         .rings = {}});
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  const std::vector<plate::Coupling> hub{{.name = "hub", .group = "inner_edge"}};
  const std::vector<plate::ShellSection> sections{
      {.group = "disc",
       .material = {.young = 9.15915e10, .poisson = 0.3, .density = 6300.0},
       .thickness = 0.02}};
  const double before = resident_bytes();
  double assembly_s = 0.0, mumps_s = 0.0, supernodal_s = 0.0;
  const plate::System system = timed(assembly_s, [&] {
    return plate::assemble(
        mesh, sections,
        plate::make_dof_map(mesh, {.couplings = hub}, mesh::node_owners(mesh, n_ranks), n_ranks),
        PETSC_COMM_WORLD);
  });
  const double bytes = resident_bytes() - before;
  const reduce::Blocks K = reduce::split(system.K, reduce::partition(system.K, hub_dofs(system)));
  const auto factorize = [&](double& seconds, const char* type) {
    petsc::check(PetscOptionsSetValue(nullptr, "-cms_pc_factor_mat_solver_type", type));
    timed(seconds, [&] { return linear::factorize(K.ss); });
  };
  factorize(mumps_s, "mumps-metis");
  factorize(supernodal_s, "supernodal");
  MatInfo info_K{}, info_M{};
  petsc::check(MatGetInfo(system.K, MAT_GLOBAL_SUM, &info_K));
  petsc::check(MatGetInfo(system.M, MAT_GLOBAL_SUM, &info_M));
  const int n_dofs = 6 * system.dofs.n_active();
  if (petsc::rank(PETSC_COMM_WORLD) != 0) return;
  fmt::print(
      "{{\"order\": {}, \"ranks\": {}, \"n_dofs\": {}, \"assembly_s\": {:.3f}, "
      "\"mumps_s\": {:.3f}, \"supernodal_s\": {:.3f}, \"dofs_per_s\": {:.0f}, \"nonzeros_K\": "
      "{:.0f}, \"nonzeros_M\": {:.0f}, \"bytes_per_nonzero\": {:.2f}}}\n",
      order, n_ranks, n_dofs, assembly_s, mumps_s, supernodal_s, n_dofs / assembly_s,
      info_K.nz_used, info_M.nz_used, bytes / (info_K.nz_used + info_M.nz_used));
}

}  // namespace
}  // namespace chladni::benchmarks

int main(int argc, char** argv)
{
  if (SlepcInitialize(&argc, &argv, nullptr, nullptr) != 0) return 1;
  int code = 0;
  try {
    if (argc < 3) throw chladni::Error("usage: element_assembly_speed ORDER ELEMENT_SIZE_M");
    chladni::benchmarks::run(std::atoi(argv[1]), std::atof(argv[2]));
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    code = 1;
  }
  SlepcFinalize();
  return code;
}
