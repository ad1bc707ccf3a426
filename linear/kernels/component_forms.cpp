#include "linear/kernels/forms.hpp"

#include <algorithm>
#include <utility>

#include "common/eigen_every.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/storage.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

constexpr PetscInt form_columns = 64;  // at a time: bounds the memory, enough for dgemm

/// Rows of this rank, and how many components a node has.
struct Rows {
  PetscInt first, n;
  PetscInt n_components;
  MPI_Comm comm;

  explicit Rows(Mat A) : first(0), n(0), n_components(1), comm(petsc::communicator(A))
  {
    petsc::check(MatGetOwnershipRange(A, &first, nullptr));
    petsc::check(MatGetLocalSize(A, &n, nullptr));
    petsc::check(MatGetBlockSize(A, &n_components));
  }
};

/// A table of yes and no that is the same on every rank after `unite`.
class Table {
 public:
  Table(PetscInt n_rows, PetscInt n_columns)
      : n_columns_(std::size_t(n_columns)), is_(std::size_t(n_rows) * n_columns_, 0)
  {}
  void add(PetscInt row, PetscInt column) { is_[place(row, column)] = 1; }
  bool operator()(PetscInt row, PetscInt column) const { return is_[place(row, column)] != 0; }
  void unite(MPI_Comm comm)
  {
    MPI_Allreduce(MPI_IN_PLACE, is_.data(), static_cast<int>(is_.size()), MPI_INT, MPI_MAX, comm);
  }

 private:
  std::size_t place(PetscInt row, PetscInt column) const
  {
    return std::size_t(row) * n_columns_ + std::size_t(column);
  }
  std::size_t n_columns_;
  std::vector<int> is_;
};

/// Which components a matrix couples.
Table couplings(const Rows& rows, Mat A)
{
  Table coupled(rows.n_components, rows.n_components);
  for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    if (value != 0.0) coupled.add(row % rows.n_components, column % rows.n_components);
  });
  coupled.unite(rows.comm);
  return coupled;
}

/// The rows of this rank in which some matrix has an entry, or in whose columns.
std::vector<PetscInt> used_rows(const Rows& rows, std::span<const SparseForm> forms)
{
  std::vector<char> is_used(static_cast<std::size_t>(rows.n), 0);
  std::vector<PetscInt> of_others;
  const auto use = [&](PetscInt row) {
    const PetscInt local = row - rows.first;
    if (local >= 0 && local < rows.n)
      is_used[std::size_t(local)] = 1;
    else if (of_others.empty() || of_others.back() != row)
      of_others.push_back(row);
  };
  for (const SparseForm& form : forms) {
    for_local_entries(form.A, [&](PetscInt row, PetscInt column, double value) {
      if (value == 0.0) return;
      use(row);
      use(column);
    });
  }
  std::ranges::sort(of_others);
  of_others.erase(std::unique(of_others.begin(), of_others.end()), of_others.end());
  for (const PetscInt row : gather_on_all(of_others, MPIU_INT, rows.comm))
    if (row >= rows.first && row < rows.first + rows.n) is_used[std::size_t(row - rows.first)] = 1;
  std::vector<PetscInt> used;
  for (PetscInt i = 0; i < rows.n; ++i)
    if (is_used[std::size_t(i)] != 0) used.push_back(i);
  return used;
}

/// Which columns of T are not zero in the used rows of each component.
Table columns_there(const Rows& rows, const std::vector<PetscInt>& used, const ColumnSource& T)
{
  std::vector<std::vector<PetscInt>> of_component(std::size_t(rows.n_components));
  for (const PetscInt i : used) of_component[std::size_t(i % rows.n_components)].push_back(i);
  Table is_there(rows.n_components, T.n_columns);
  std::vector<double> column(static_cast<std::size_t>(rows.n));
  for (PetscInt j = 0; j < T.n_columns; ++j) {
    T.write(j, column);
    for (PetscInt c = 0; c < rows.n_components; ++c) {
      if (std::ranges::any_of(of_component[std::size_t(c)],
                              [&](PetscInt i) { return column[std::size_t(i)] != 0.0; }))
        is_there.add(c, j);
    }
  }
  is_there.unite(rows.comm);
  return is_there;
}

/// Components that the same matrices couple with the same others, and in which the same columns of
/// T are not zero.
struct Group {
  std::vector<PetscInt> components;
  std::vector<PetscInt> columns;  ///< of T
  std::vector<PetscInt> rows;     ///< used ones of this rank, counted from its first, ascending
  petsc::IndexSet set;            ///< these rows
  AlignedNumbers values;
  petsc::Matrix X;  ///< rows and columns of T; refers to `values`
};

std::vector<Group> groups_of(const Rows& rows, const std::vector<PetscInt>& used_here,
                             const std::vector<Table>& coupled, const ColumnSource& T)
{
  const Table is_there = columns_there(rows, used_here, T);
  const PetscInt n = rows.n_components;
  const auto uses = [&](PetscInt c) {
    std::vector<char> used;
    for (const Table& of_form : coupled) {
      char as_row = 0, as_column = 0;
      for (PetscInt other = 0; other < n; ++other) {
        if (of_form(c, other)) as_row = 1;
        if (of_form(other, c)) as_column = 1;
      }
      used.insert(used.end(), {as_row, as_column});
    }
    return used;
  };
  std::vector<Group> groups;
  for (PetscInt c = 0; c < n; ++c) {
    const std::vector<char> used = uses(c);
    if (std::ranges::none_of(used, [](char is) { return is != 0; })) continue;
    Group group{.components = {c}, .columns = {}, .rows = {}, .set = {}, .values = {}, .X = {}};
    for (PetscInt j = 0; j < T.n_columns; ++j)
      if (is_there(c, j)) group.columns.push_back(j);
    const auto alike = std::ranges::find_if(groups, [&](const Group& other) {
      return other.columns == group.columns && uses(other.components.front()) == used;
    });
    if (alike == groups.end())
      groups.push_back(std::move(group));
    else
      alike->components.push_back(c);
  }
  for (Group& group : groups) {
    std::vector<PetscInt> global;
    for (const PetscInt i : used_here)
      if (std::ranges::binary_search(group.components, i % n)) group.rows.push_back(i);
    for (const PetscInt i : group.rows) global.push_back(rows.first + i);
    petsc::check(ISCreateGeneral(rows.comm, static_cast<PetscInt>(global.size()), global.data(),
                                 PETSC_COPY_VALUES, group.set.put()));
  }
  return groups;
}

void copy_rows(const Rows& rows, const ColumnSource& T, std::vector<Group>& groups)
{
  for (Group& group : groups) {
    const auto n = static_cast<PetscInt>(group.rows.size());
    group.values = aligned_numbers(group.rows.size() * group.columns.size());
    petsc::check(MatCreateDense(rows.comm, n, PETSC_DECIDE, PETSC_DETERMINE,
                                static_cast<PetscInt>(group.columns.size()), group.values.get(),
                                group.X.put()));
  }
  std::vector<double> column(static_cast<std::size_t>(rows.n));
  for (PetscInt j = 0; j < T.n_columns; ++j) {
    T.write(j, column);
    for (Group& group : groups) {
      const auto place = std::ranges::lower_bound(group.columns, j);
      if (place == group.columns.end() || *place != j) continue;
      double* to =
          group.values.get() + std::size_t(place - group.columns.begin()) * group.rows.size();
      for (const PetscInt i : group.rows) *to++ = column[std::size_t(i)];
    }
  }
}

/// Rows of a block of a matrix on this rank that have entries.
std::vector<PetscInt> coupled_rows(Mat A_rc)
{
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(A_rc, &first, nullptr));
  std::vector<PetscInt> rows;
  for_local_entries(A_rc, [&](PetscInt row, PetscInt /*column*/, double value) {
    if (value != 0.0 && (rows.empty() || rows.back() != row - first)) rows.push_back(row - first);
  });
  return rows;
}

using Values = Eigen::Map<const MatrixXd>;

/// X^T Y in the rows in which Y is not zero: a node that others follow may be the only one that has
/// two components coupled. The rows are copied a few at a time.
MatrixXd inner_in_rows(const Eigen::Ref<const MatrixXd>& X, const Values& Y,
                       const std::vector<PetscInt>& rows)
{
  constexpr std::size_t piece = 1024;  // these columns in a second-level cache
  if (10 * rows.size() > 9 * std::size_t(X.rows())) return inner_product(X, Y);
  MatrixXd sum = MatrixXd::Zero(X.cols(), Y.cols());
  for (std::size_t at = 0; at < rows.size(); at += piece) {
    const auto some = std::span(rows).subspan(at, std::min(piece, rows.size() - at));
    sum += inner_product(MatrixXd(X(some, every)), MatrixXd(Y(some, every)));
  }
  return sum;
}

/// X_r^T A_rc X_c of this rank's rows.
/// @param is_symmetric  A_rc and r = c: the upper triangle alone
MatrixXd block_form(const Group& r, Mat A, const Group& c, bool is_symmetric)
{
  const petsc::Matrix A_rc = own_submatrix(A, r.set, c.set);
  const SparseProduct product(A_rc);
  const Values X_r(r.values.get(), std::ssize(r.rows), std::ssize(r.columns));
  const std::vector<PetscInt> rows = coupled_rows(A_rc);
  const auto n = static_cast<PetscInt>(c.columns.size());
  MatrixXd form = MatrixXd::Zero(std::ssize(r.columns), n);
  for (PetscInt first = 0; first < n; first += form_columns) {
    const PetscInt last = std::min(first + form_columns, n);
    const petsc::Matrix Y = uninitialized_dense(A_rc, last - first);
    product.apply(ColumnRange(c.X, first, last), Y);
    const LocalRows y(Y);
    const Values A_X(y.values(), y.n_rows(), y.n_cols());
    const Eigen::Index n_left = is_symmetric ? last : X_r.cols();
    form.block(0, first, n_left, last - first) = inner_in_rows(X_r.leftCols(n_left), A_X, rows);
  }
  return form;
}

/// This rank's part of T^T A T; of a symmetric one with zeros in half of its places.
MatrixXd form_of(const SparseForm& form, const Table& coupled, const std::vector<Group>& groups,
                 PetscInt n_columns)
{
  const bool is_symmetric = form.symmetry == FormSymmetry::symmetric;
  MatrixXd F = MatrixXd::Zero(n_columns, n_columns);
  const auto are_coupled = [&](const Group& r, const Group& c) {
    return std::ranges::any_of(r.components, [&](PetscInt i) {
      return std::ranges::any_of(c.components, [&](PetscInt j) { return coupled(i, j); });
    });
  };
  for (std::size_t r = 0; r < groups.size(); ++r) {
    for (std::size_t c = is_symmetric ? r : 0; c < groups.size(); ++c) {
      if (!are_coupled(groups[r], groups[c])) continue;
      const MatrixXd block = block_form(groups[r], form.A, groups[c], is_symmetric && r == c);
      F(groups[r].columns, groups[c].columns) += block;
      if (is_symmetric && r != c) F(groups[c].columns, groups[r].columns) += block.transpose();
    }
  }
  return F;
}

}  // namespace

std::vector<MatrixXd> component_forms(const ColumnSource& T, std::span<const SparseForm> forms)
{
  const Rows rows(forms.front().A);
  std::vector<Table> coupled;
  for (const SparseForm& form : forms) coupled.push_back(couplings(rows, form.A));
  std::vector<Group> groups = groups_of(rows, used_rows(rows, forms), coupled, T);
  copy_rows(rows, T, groups);
  std::vector<MatrixXd> all;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    report_progress(double(k) / double(forms.size()));
    MatrixXd F = form_of(forms[k], coupled[k], groups, T.n_columns);
    sum_over_ranks(values_of(F), rows.comm);
    if (forms[k].symmetry == FormSymmetry::symmetric)
      F = MatrixXd(F.selfadjointView<Eigen::Upper>());
    all.push_back(std::move(F));
  }
  return all;
}

}  // namespace chladni::linear
