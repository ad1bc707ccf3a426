#include "reduce/basis_rows.hpp"

#include <algorithm>
#include <utility>

#include "common/index_sets.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

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

OwnBasisRows::Places::Places(IS set)
{
  const std::vector<PetscInt> dofs = petsc::own_indices(set);
  if (dofs.empty()) return;
  const auto [first, last] = std::ranges::minmax(dofs);
  first_ = first;
  place_.resize(std::size_t(last - first) + 1, none);
  for (std::size_t i = 0; i < dofs.size(); ++i)
    place_[std::size_t(dofs[i] - first)] = static_cast<PetscInt>(i);
}

std::optional<PetscInt> OwnBasisRows::Places::operator()(PetscInt dof) const
{
  if (dof < first_ || dof - first_ >= std::ssize(place_)) return std::nullopt;
  const PetscInt place = place_[std::size_t(dof - first_)];
  return place == none ? std::nullopt : std::optional(place);
}

OwnBasisRows::OwnBasisRows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of)
    : Psi_(Q_CB.Psi),
      first_master_(petsc::indices_before(rows_of.masters)),
      masters_(rows_of.masters),
      slaves_(rows_of.slaves)
{
  if (Q_CB.modes) Phi_.emplace(Q_CB.modes->Phi);
}

MatrixXd OwnBasisRows::rows(const std::vector<PetscInt>& dofs) const
{
  MatrixXd rows = MatrixXd::Zero(std::ssize(dofs), n_columns());
  std::vector<std::pair<PetscInt, PetscInt>> own;  // row here and row among this rank's slaves
  for (PetscInt i = 0; i < rows.rows(); ++i) {
    if (const auto m = master(dofs[i])) rows(i, first_master_ + *m) = 1.0;
    if (const auto s = slave(dofs[i])) own.emplace_back(i, *s);
  }
  const PetscInt n_m = Psi_.n_cols();
  for (PetscInt j = 0; j < n_m; ++j)
    for (const auto& [i, s] : own) rows(i, j) = Psi_(s, j);
  for (PetscInt j = n_m; j < n_columns(); ++j)
    for (const auto& [i, s] : own) rows(i, j) = (*Phi_)(s, j - n_m);
  return rows;
}

MatrixXd basis_rows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of,
                    const std::vector<PetscInt>& dofs)
{
  MatrixXd rows = OwnBasisRows(Q_CB, rows_of).rows(dofs);
  linear::sum_over_ranks(linear::values_of(rows), petsc::communicator(Q_CB.Psi));
  return rows;
}

}  // namespace chladni::reduce
