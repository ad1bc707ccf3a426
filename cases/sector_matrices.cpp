#include "cases/sector_matrices.hpp"

#include "cyclic/mirror.hpp"
#include "cyclic/sparse_rows.hpp"

namespace chladni::cases {

cyclic::SectorMatrices matrices_of(const SectorModel& model, MPI_Comm comm)
{
  const auto rows = [](Mat A) {
    return A != nullptr ? cyclic::sparse_rows(A) : cyclic::SparseRows();
  };
  return {.K = rows(model.system.K),
          .M = rows(model.system.M),
          .C = rows(model.system.C),
          .H = rows(model.system.H),
          .comm = comm};
}

std::optional<cyclic::Mirror> mirror_of(const SectorModel& model,
                                        const cyclic::SectorMatrices& matrices)
{
  const plate::DofMap& dofs = model.system.dofs;
  Eigen::MatrixX3d positions(model.dofs.n_blocks, 3);
  // A mean has no block of its own: its DOFs stand in those of its group.
  for (int node = 0; node < dofs.n_nodes(); ++node)
    if (!dofs.is_dependent(node) && dofs.number(node) >= 0)
      positions.row(dofs.number(node)) = dofs.position(node);
  return cyclic::find_mirror(model.dofs, positions,
                             {&matrices.K, &matrices.M, &matrices.C, &matrices.H});
}

}  // namespace chladni::cases
