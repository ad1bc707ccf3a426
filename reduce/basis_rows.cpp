#include "reduce/basis_rows.hpp"

#include <algorithm>
#include <utility>

#include "common/index_sets.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// The places of some DOFs among those of a set on this rank, in any order.
class Places {
 public:
  explicit Places(IS set)
  {
    const std::vector<PetscInt> dofs = petsc::own_indices(set);
    if (dofs.empty()) return;
    const auto [first, last] = std::ranges::minmax(dofs);
    first_ = first;
    place_.resize(std::size_t(last - first) + 1, none);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      place_[std::size_t(dofs[i] - first)] = static_cast<PetscInt>(i);
  }
  std::optional<PetscInt> operator()(PetscInt dof) const
  {
    if (dof < first_ || dof - first_ >= std::ssize(place_)) return std::nullopt;
    const PetscInt place = place_[std::size_t(dof - first_)];
    return place == none ? std::nullopt : std::optional(place);
  }

 private:
  static constexpr PetscInt none = -1;
  PetscInt first_ = 0;
  std::vector<PetscInt> place_;
};

}  // namespace

BasisColumns::BasisColumns(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of)
    : Psi_(Q_CB.Psi),
      n_m_(Psi_.n_cols()),
      first_master_(petsc::indices_before(rows_of.masters)),
      masters_(petsc::own_indices(rows_of.masters)),
      slaves_(petsc::own_indices(rows_of.slaves))
{
  if (Q_CB.modes) Phi_.emplace(Q_CB.modes->Phi);
  const PetscInt first = first_master_ + petsc::indices_before(rows_of.slaves);
  for (std::vector<PetscInt>* dofs : {&masters_, &slaves_})
    for (PetscInt& dof : *dofs) dof -= first;
}

void BasisColumns::write(PetscInt column, std::span<double> rows) const
{
  const bool is_master = column < n_m_;
  const PetscInt master = column - first_master_;
  for (const PetscInt row : masters_) rows[std::size_t(row)] = 0.0;
  if (is_master && master >= 0 && master < std::ssize(masters_))
    rows[std::size_t(masters_[std::size_t(master)])] = 1.0;
  const linear::LocalRows& X = is_master ? Psi_ : *Phi_;
  const double* values =
      X.values() + std::size_t(is_master ? column : column - n_m_) * X.leading_dimension();
  for (std::size_t i = 0; i < slaves_.size(); ++i) rows[std::size_t(slaves_[i])] = values[i];
}

MatrixXd basis_rows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of,
                    const std::vector<PetscInt>& dofs)
{
  const linear::LocalRows Psi(Q_CB.Psi);
  const std::optional<linear::LocalRows> Phi =
      Q_CB.modes ? std::optional<linear::LocalRows>(std::in_place, Q_CB.modes->Phi) : std::nullopt;
  const Places masters(rows_of.masters), slaves(rows_of.slaves);
  const PetscInt first_master = petsc::indices_before(rows_of.masters);
  const PetscInt n_m = Psi.n_cols();
  MatrixXd rows = MatrixXd::Zero(std::ssize(dofs), n_m + Q_CB.n_modes());
  std::vector<std::pair<PetscInt, PetscInt>> own;  // row here and row among this rank's slaves
  for (PetscInt i = 0; i < rows.rows(); ++i) {
    if (const auto m = masters(dofs[i])) rows(i, first_master + *m) = 1.0;
    if (const auto s = slaves(dofs[i])) own.emplace_back(i, *s);
  }
  for (PetscInt j = 0; j < n_m; ++j)
    for (const auto& [i, s] : own) rows(i, j) = Psi(s, j);
  for (PetscInt j = 0; j < Q_CB.n_modes(); ++j)
    for (const auto& [i, s] : own) rows(i, n_m + j) = (*Phi)(s, j);
  linear::sum_over_ranks(linear::values_of(rows), petsc::communicator(Q_CB.Psi));
  return rows;
}

}  // namespace chladni::reduce
