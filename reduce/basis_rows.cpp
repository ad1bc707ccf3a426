#include "reduce/basis_rows.hpp"

#include <algorithm>
#include <optional>

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// Places of global DOFs among the masters or slaves of this rank.
class LocalPlaces {
 public:
  explicit LocalPlaces(IS set) : set_(set)
  {
    petsc::check(ISGetLocalSize(set_, &n_));
    petsc::check(ISGetIndices(set_, &indices_));
  }
  ~LocalPlaces() { ISRestoreIndices(set_, &indices_); }
  LocalPlaces(const LocalPlaces&) = delete;
  LocalPlaces& operator=(const LocalPlaces&) = delete;

  std::optional<PetscInt> find(PetscInt dof) const
  {
    const PetscInt* end = indices_ + n_;
    const PetscInt* it = std::lower_bound(indices_, end, dof);
    if (it == end || *it != dof) return std::nullopt;
    return static_cast<PetscInt>(it - indices_);
  }

 private:
  IS set_;
  PetscInt n_ = 0;
  const PetscInt* indices_ = nullptr;
};

PetscInt masters_before(IS masters)
{
  PetscInt n = 0;
  PetscInt before = 0;
  petsc::check(ISGetLocalSize(masters, &n));
  MPI_Exscan(&n, &before, 1, MPIU_INT, MPI_SUM, petsc::communicator(masters));
  return petsc::rank(petsc::communicator(masters)) == 0 ? 0 : before;
}

}  // namespace

MatrixXd basis_rows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of,
                    const std::vector<PetscInt>& dofs)
{
  const linear::LocalRows Psi(Q_CB.Psi);
  const std::optional<linear::LocalRows> Phi =
      Q_CB.modes ? std::optional<linear::LocalRows>(std::in_place, Q_CB.modes->Phi) : std::nullopt;
  const LocalPlaces masters(rows_of.masters);
  const LocalPlaces slaves(rows_of.slaves);
  const PetscInt first_master = masters_before(rows_of.masters);
  const PetscInt n_m = Psi.n_cols();
  MatrixXd rows = MatrixXd::Zero(std::ssize(dofs), n_m + Q_CB.n_modes());
  std::vector<std::pair<PetscInt, PetscInt>> own;  // row here and row among this rank's slaves
  for (PetscInt i = 0; i < rows.rows(); ++i) {
    if (const auto m = masters.find(dofs[i])) rows(i, first_master + *m) = 1.0;
    if (const auto s = slaves.find(dofs[i])) own.emplace_back(i, *s);
  }
  for (PetscInt j = 0; j < n_m; ++j)
    for (const auto& [i, s] : own) rows(i, j) = Psi(s, j);
  for (PetscInt j = 0; j < Q_CB.n_modes(); ++j)
    for (const auto& [i, s] : own) rows(i, n_m + j) = (*Phi)(s, j);
  linear::sum_over_ranks(linear::values_of(rows), petsc::communicator(Q_CB.Psi));
  return rows;
}

}  // namespace chladni::reduce
