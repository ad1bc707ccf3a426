#include "linear/kernels/basis_forms.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>

#include "linear/kernels/aligned_numbers.hpp"
#include "linear/kernels/as_aij.hpp"
#include "linear/kernels/form_basis.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// A sparse matrix in the rows of this rank; ghosts come behind these.
class LocalForm {
 public:
  LocalForm(Mat A, FormSymmetry symmetry) : A_(as_aij(A)), symmetry_(symmetry)
  {
    petsc::check(MatGetLocalSize(A_, &n_rows_, nullptr));
    const OwnAndOther parts = own_and_other(A_);
    own_.emplace(parts.own);
    if (parts.other != nullptr) other_.emplace(parts.other);
    ghosts_ = {parts.ghosts, parts.ghosts + parts.n_ghosts};
  }

  bool is_symmetric() const { return symmetry_ == FormSymmetry::symmetric; }
  const std::vector<PetscInt>& ghosts() const { return ghosts_; }
  /// Replaces the global numbers of the ghosts by their rows behind those of this rank.
  void number_ghosts(const std::vector<PetscInt>& all)
  {
    for (PetscInt& ghost : ghosts_)
      ghost = n_rows_ + static_cast<PetscInt>(std::ranges::lower_bound(all, ghost) - all.begin());
  }
  /// visit(column, value) of the entries of a row.
  template <typename Visit>
  void for_entries(PetscInt row, const Visit& visit) const
  {
    const auto& [starts, columns, values] = own_->arrays();
    for (PetscInt k = starts[row]; k < starts[row + 1]; ++k) visit(columns[k], values[k]);
    if (!other_) return;
    const auto& [o_starts, o_columns, o_values] = other_->arrays();
    for (PetscInt k = o_starts[row]; k < o_starts[row + 1]; ++k)
      visit(ghosts_[std::size_t(o_columns[k])], o_values[k]);
  }

 private:
  petsc::Matrix A_;
  FormSymmetry symmetry_;
  PetscInt n_rows_ = 0;
  std::optional<BorrowedRows> own_, other_;
  std::vector<PetscInt> ghosts_;
};

std::vector<PetscInt> ghosts_of_all(const std::vector<std::unique_ptr<LocalForm>>& forms)
{
  std::vector<PetscInt> all;
  for (const auto& form : forms)
    all.insert(all.end(), form->ghosts().begin(), form->ghosts().end());
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Some rows of a form: those of one part with entries in columns of another. The columns are
/// numbers of rows of a panel.
struct FormRows {
  std::vector<PetscInt> rows, starts, columns;
  std::vector<double> values;

  void add(PetscInt row, PetscInt column, double value)
  {
    if (rows.empty() || rows.back() != row) {
      rows.push_back(row);
      starts.push_back(static_cast<PetscInt>(columns.size()));
    }
    columns.push_back(column);
    values.push_back(value);
  }
  void clear()
  {
    rows.clear();
    starts.clear();
    columns.clear();
    values.clear();
  }
};

/// The rows of X that the products of a few rows need, each part's in panels of sixteen columns.
class PackedRows {
 public:
  PackedRows(const FormBasis& X, PetscInt n_ghosts)
      : X_(X), rows_(std::size_t(X.n_parts())), panels_(rows_.size()), capacity_(rows_.size(), 0)
  {
    place_.assign(std::size_t(X.n_rows() + n_ghosts), -1);
  }

  /// The place of a row among those of its part.
  PetscInt place(PetscInt row)
  {
    PetscInt& place = place_[std::size_t(row)];
    if (place != -1) return place;
    std::vector<PetscInt>& rows = rows_[std::size_t(X_.part(row))];
    place = static_cast<PetscInt>(rows.size());
    rows.push_back(row);
    return place;
  }

  void pack()
  {
    for (std::size_t t = 0; t < rows_.size(); ++t) {
      const std::span columns(X_.columns(static_cast<int>(t)));
      const std::size_t needed = rows_[t].size() * (columns.size() + wide_panel);
      if (capacity_[t] < needed) panels_[t] = aligned_numbers(capacity_[t] = needed);
      for (std::size_t c = 0; c < columns.size(); c += wide_panel) {
        const std::size_t n = std::min<std::size_t>(wide_panel, columns.size() - c);
        X_.pack(columns.subspan(c, n), rows_[t], panels_[t].get() + c * rows_[t].size());
      }
    }
  }
  /// From column c on, which is a multiple of sixteen.
  const double* panel(int t, std::size_t c) const
  {
    return panels_[std::size_t(t)].get() + c * rows_[std::size_t(t)].size();
  }

  void clear()
  {
    for (std::vector<PetscInt>& rows : rows_) {
      for (const PetscInt row : rows) place_[std::size_t(row)] = -1;
      rows.clear();
    }
  }

 private:
  const FormBasis& X_;
  std::vector<PetscInt> place_;              ///< [rows and ghosts] -1: not needed
  std::vector<std::vector<PetscInt>> rows_;  ///< [parts]
  std::vector<AlignedNumbers> panels_;
  std::vector<std::size_t> capacity_;
};

/// A X of some rows of a form, for all columns of part t.
MatrixXd product_of(const FormRows& A, const PackedRows& X, int t, Index n_columns)
{
  const auto n = static_cast<PetscInt>(A.rows.size());
  std::vector<PetscInt> numbers(A.rows.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  const AlignedNumbers panel = aligned_numbers(std::size_t(n) * wide_panel);
  MatrixXd Y(n, n_columns);
  for (Index c = 0; c < n_columns; c += wide_panel) {
    std::fill_n(panel.get(), std::size_t(n) * wide_panel, 0.0);
    add_wide_product({A.starts.data(), A.columns.data(), A.values.data()}, numbers,
                     X.panel(t, std::size_t(c)), panel.get());
    const Index width = std::min<Index>(wide_panel, n_columns - c);
    for (Index k = 0; k < width; ++k)
      for (Index i = 0; i < n; ++i) Y(i, c + k) = panel.get()[i * wide_panel + k];
  }
  return Y;
}

/// F <- F + the first n columns of X transposed times columns of Y from `first` on.
void add_inner_product(const MatrixXd& X, const MatrixXd& Y, Index first, Index n_right, Index n,
                       MatrixXd& F)
{
  const auto m = static_cast<PetscBLASInt>(n), k = static_cast<PetscBLASInt>(X.rows()),
             r = static_cast<PetscBLASInt>(n_right), ldf = static_cast<PetscBLASInt>(F.rows());
  const PetscScalar one = 1.0;
  if (m == 0 || k == 0 || r == 0) return;
  BLASgemm_("T", "N", &m, &r, &k, &one, X.data(), &k, Y.data() + first * k, &k, &one,
            F.data() + first * ldf, &ldf);
}

/// Adds what some rows of a form give: of a symmetric form with the same columns on both sides the
/// upper triangle.
void add_rows_of_form(const MatrixXd& left, const MatrixXd& Y, bool is_triangle, MatrixXd& F)
{
  constexpr Index block = 64;
  if (!is_triangle) return add_inner_product(left, Y, 0, Y.cols(), left.cols(), F);
  for (Index first = 0; first < Y.cols(); first += block) {
    const Index last = std::min(first + block, Y.cols());
    add_inner_product(left, Y, first, last - first, last, F);
  }
}

/// The forms of all parts of X with each other, summed over rows.
class FormSums {
 public:
  FormSums(const FormBasis& X, const std::vector<std::unique_ptr<LocalForm>>& forms,
           PetscInt n_ghosts)
      : X_(X), forms_(forms), packed_(X, n_ghosts), rows_(forms.size() * n_pairs())
  {
    for (std::size_t f = 0; f < forms.size(); ++f) {
      for_parts([&](int s, int t) {
        sums_.push_back(MatrixXd::Zero(std::ssize(X.columns(s)), std::ssize(X.columns(t))));
      });
    }
  }

  void add_rows(PetscInt first, PetscInt last)
  {
    for (std::size_t f = 0; f < forms_.size(); ++f)
      for (PetscInt row = first; row < last; ++row) take(f, row);
    packed_.pack();
    for (std::size_t f = 0; f < forms_.size(); ++f)
      for_parts([&](int s, int t) { multiply(f, s, t); });
    packed_.clear();
  }

  /// The form of this rank's rows.
  MatrixXd form(std::size_t f)
  {
    MatrixXd F = MatrixXd::Zero(X_.n_columns(), X_.n_columns());
    const bool is_symmetric = forms_[f]->is_symmetric();
    for_parts([&](int s, int t) {
      MatrixXd& sum = sums_[at(f, s, t)];
      if (is_symmetric && s == t) sum = MatrixXd(sum.selfadjointView<Eigen::Upper>());
      for (Index j = 0; j < sum.cols(); ++j) {
        for (Index i = 0; i < sum.rows(); ++i) {
          const PetscInt a = X_.columns(s)[std::size_t(i)].number,
                         b = X_.columns(t)[std::size_t(j)].number;
          F(a, b) += sum(i, j);
          if (is_symmetric && s != t) F(b, a) += sum(i, j);
        }
      }
    });
    if (is_symmetric) F = MatrixXd(F.selfadjointView<Eigen::Upper>());
    return F;
  }

 private:
  std::size_t n_pairs() const { return std::size_t(X_.n_parts()) * std::size_t(X_.n_parts()); }
  std::size_t at(std::size_t f, int s, int t) const
  {
    return f * n_pairs() + std::size_t(s) * std::size_t(X_.n_parts()) + std::size_t(t);
  }
  template <typename Visit>
  void for_parts(const Visit& visit) const
  {
    for (int s = 0; s < X_.n_parts(); ++s)
      for (int t = 0; t < X_.n_parts(); ++t) visit(s, t);
  }

  void take(std::size_t f, PetscInt row)
  {
    const int s = X_.part(row);
    forms_[f]->for_entries(row, [&](PetscInt column, double value) {
      const int t = X_.part(column);
      if (value == 0.0 || (forms_[f]->is_symmetric() && t < s)) return;
      rows_[at(f, s, t)].add(row, packed_.place(column), value);
    });
  }

  void multiply(std::size_t f, int s, int t)
  {
    FormRows& A = rows_[at(f, s, t)];
    if (A.rows.empty()) return;
    A.starts.push_back(static_cast<PetscInt>(A.columns.size()));
    const MatrixXd Y = product_of(A, packed_, t, std::ssize(X_.columns(t)));
    add_rows_of_form(X_.values(s, A.rows), Y, forms_[f]->is_symmetric() && s == t,
                     sums_[at(f, s, t)]);
    A.clear();
  }

  const FormBasis& X_;
  const std::vector<std::unique_ptr<LocalForm>>& forms_;
  PackedRows packed_;
  std::vector<FormRows> rows_;  ///< of the rows at hand, by `at`
  std::vector<MatrixXd> sums_;  ///< by `at`
};

}  // namespace

std::vector<MatrixXd> basis_forms(std::span<const Mat> X, Mat coupled,
                                  std::span<const SparseForm> wanted)
{
  constexpr PetscInt rows_at_once = 3072;
  std::vector<std::unique_ptr<LocalForm>> forms;
  for (const SparseForm& form : wanted)
    forms.push_back(std::make_unique<LocalForm>(form.A, form.symmetry));
  const std::vector<PetscInt> ghosts = ghosts_of_all(forms);
  for (const auto& form : forms) form->number_ghosts(ghosts);
  const FormBasis basis(X, coupled, ghosts);
  FormSums sums(basis, forms, static_cast<PetscInt>(ghosts.size()));
  for (PetscInt first = 0; first < basis.n_rows(); first += rows_at_once) {
    report_progress(double(first) / basis.n_rows());
    sums.add_rows(first, std::min(first + rows_at_once, basis.n_rows()));
  }
  std::vector<MatrixXd> results;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    results.push_back(sums.form(f));
    sum_over_ranks(values_of(results.back()), petsc::communicator(coupled));
  }
  return results;
}

}  // namespace chladni::linear
