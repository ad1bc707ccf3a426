#include "linear/kernels/form_basis.hpp"

#include <algorithm>

#include "linear/kernels/form_parts.hpp"

namespace chladni::linear {

using Eigen::Index, Eigen::MatrixXd;

FormBasis::FormBasis(std::span<const Mat> X, Mat coupled, const std::vector<PetscInt>& ghosts)
{
  std::vector<Column> all;
  for (const Mat some : X) {
    locals_.push_back(std::make_unique<LocalRows>(some));
    const LocalRows& rows = *locals_.back();
    for (PetscInt j = 0; j < rows.n_cols(); ++j)
      all.push_back({rows.values() + std::size_t(j) * rows.leading_dimension(), n_columns_++});
  }
  petsc::check(MatGetLocalSize(coupled, &n_rows_, nullptr));
  part_of_row_.assign(std::size_t(n_rows_) + ghosts.size(), 0);
  const std::vector<FormPart> parts = form_parts(coupled, X);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const PetscInt row : parts[k].rows) part_of_row_[std::size_t(row)] = static_cast<int>(k);
    std::vector<Column>& columns = columns_.emplace_back();
    PetscInt before = 0;
    for (std::size_t i = 0; i < X.size(); ++i) {
      for (const PetscInt j : parts[k].columns[i]) columns.push_back(all[std::size_t(before + j)]);
      before += locals_[i]->n_cols();
    }
  }
  if (parts.empty()) columns_.push_back(std::move(all));
  if (petsc::size(petsc::communicator(coupled)) == 1) return;
  const PetscInt* first_rows = nullptr;
  petsc::check(MatGetOwnershipRanges(coupled, &first_rows));
  take_ghosts(GhostRows(ghosts, first_rows, petsc::communicator(coupled)));
}

/// The values and the parts of ghosts.
void FormBasis::take_ghosts(const GhostRows& exchange)
{
  const std::vector<double> own(part_of_row_.begin(), part_of_row_.begin() + n_rows_);
  std::vector<double> ghosts(std::size_t(exchange.size()));
  exchange.take(own.data(), 1, ghosts.data());
  for (PetscInt g = 0; g < exchange.size(); ++g)
    part_of_row_[std::size_t(n_rows_ + g)] = static_cast<int>(ghosts[std::size_t(g)]);
  ghosts_ = MatrixXd(exchange.size(), n_columns_);
  PetscInt first = 0;
  for (const auto& rows : locals_) {
    for (PetscInt j = 0; j < rows->n_cols(); ++j, ++first) {
      exchange.take(rows->values() + std::size_t(j) * rows->leading_dimension(), 1,
                    ghosts_.data() + Index(first) * exchange.size());
    }
  }
}

void FormBasis::pack(std::span<const Column> columns, std::span<const PetscInt> rows,
                     double* panel) const
{
  for (const PetscInt row : rows) {
    if (row < n_rows_)
      for (std::size_t k = 0; k < columns.size(); ++k) panel[k] = columns[k].values[row];
    else
      for (std::size_t k = 0; k < columns.size(); ++k)
        panel[k] = ghosts_(row - n_rows_, columns[k].number);
    std::fill(panel + columns.size(), panel + wide_panel, 0.0);
    panel += wide_panel;
  }
}

MatrixXd FormBasis::values(int part, std::span<const PetscInt> rows) const
{
  const std::vector<Column>& some = columns(part);
  MatrixXd values(std::ssize(rows), std::ssize(some));
  for (std::size_t j = 0; j < some.size(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      values(Index(i), Index(j)) = some[j].values[rows[i]];
  return values;
}

}  // namespace chladni::linear
