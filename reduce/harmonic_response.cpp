#include "reduce/harmonic_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <cstdint>
#include <numbers>
#include <optional>

#include "common/all_ranks.hpp"
#include "common/checked_count.hpp"
#include "common/index_sets.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "reduce/indefinite_factor.hpp"

namespace chladni::reduce {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;
using Complex = std::complex<double>;

petsc::Matrix free_block(Mat A, const FreeDofs& free)
{
  petsc::Matrix block;
  petsc::check(MatCreateSubMatrix(A, free.indices, free.indices, MAT_INITIAL_MATRIX, block.put()));
  return block;
}

/// Entries wherever one of the matrices has some.
petsc::Matrix union_of(Mat K, Mat M, Mat C)
{
  petsc::Matrix all;
  petsc::check(MatDuplicate(K, MAT_COPY_VALUES, all.put()));
  petsc::check(MatAXPY(all, 1.0, M, DIFFERENT_NONZERO_PATTERN));
  if (C != nullptr) petsc::check(MatAXPY(all, 1.0, C, DIFFERENT_NONZERO_PATTERN));
  return all;
}

/// A with the entries of `pattern`, which has them all.
petsc::Matrix spread(Mat A, Mat pattern)
{
  petsc::Matrix wide;
  petsc::check(MatDuplicate(pattern, MAT_DO_NOT_COPY_VALUES, wide.put()));
  petsc::check(MatZeroEntries(wide));
  if (A != nullptr) petsc::check(MatAXPY(wide, 1.0, A, SUBSET_NONZERO_PATTERN));
  return wide;
}

/// @throws chladni::Error on all ranks when blocks on all entries are more than PETSc counts.
void check_counts(Mat pattern, PetscInt width)
{
  PetscInt n = 0;
  MatInfo of_rank{};
  petsc::check(MatGetSize(pattern, &n, nullptr));
  petsc::check(MatGetInfo(pattern, MAT_LOCAL, &of_rank));
  checked_count(std::int64_t{width} * n, "unknowns of a damped model", "use a coarser mesh");
  on_all_ranks(petsc::communicator(pattern), [&] {
    return checked_count(std::int64_t{width} * width * std::int64_t(of_rank.nz_used),
                         "entries of the dynamic stiffness on one rank", "use more ranks");
  });
}

/// An empty matrix with a block of `width` x `width` for each entry of `pattern`.
petsc::Matrix blocks_on(Mat pattern, PetscInt width)
{
  check_counts(pattern, width);
  PetscInt n = 0, first = 0, last = 0;
  petsc::check(MatGetLocalSize(pattern, &n, nullptr));
  petsc::check(MatGetOwnershipRange(pattern, &first, &last));
  std::vector<PetscInt> own, others;  // entries of each row, in columns of this rank and of others
  for (PetscInt row = first; row < last; ++row) {
    PetscInt n_own = 0, n_all = 0;
    const PetscInt* columns = nullptr;
    petsc::check(MatGetRow(pattern, row, &n_all, &columns, nullptr));
    for (PetscInt k = 0; k < n_all; ++k) n_own += columns[k] >= first && columns[k] < last;
    const PetscInt n_others = n_all - n_own;
    petsc::check(MatRestoreRow(pattern, row, &n_all, &columns, nullptr));
    own.insert(own.end(), width, width * n_own);
    others.insert(others.end(), width, width * n_others);
  }
  petsc::Matrix A;
  petsc::check(MatCreateAIJ(petsc::communicator(pattern), width * n, width * n, PETSC_DETERMINE,
                            PETSC_DETERMINE, 0, own.data(), 0, others.data(), A.put()));
  return A;
}

/// Where the free DOFs are among the rows of their block.
class FreeRows {
 public:
  FreeRows(const FreeDofs& free, Mat block)
  {
    petsc::check(MatGetOwnershipRange(block, &first_, nullptr));
    dofs_ = petsc::own_indices(free.indices);
  }

  /// Of a DOF that this rank owns and nothing holds.
  std::optional<PetscInt> local(PetscInt dof) const
  {
    const auto found = std::ranges::lower_bound(dofs_, dof);
    if (found == dofs_.end() || *found != dof) return std::nullopt;
    return static_cast<PetscInt>(found - dofs_.begin());
  }
  PetscInt first() const { return first_; }

 private:
  PetscInt first_ = 0;
  std::vector<PetscInt> dofs_;
};

/// One load in each column; its imaginary part is zero.
petsc::Matrix load_columns(Mat A, PetscInt width, const FreeRows& rows,
                           const std::vector<DofForm>& loads)
{
  petsc::Matrix E = linear::uninitialized_dense(A, std::ssize(loads));
  petsc::check(MatZeroEntries(E));
  for (std::size_t j = 0; j < loads.size(); ++j) {
    for (std::size_t k = 0; k < loads[j].dofs.size(); ++k) {
      const auto row = rows.local(loads[j].dofs[k]);
      if (!row) continue;
      petsc::check(MatSetValue(E, width * (rows.first() + *row), static_cast<PetscInt>(j),
                               loads[j].weights[k], ADD_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(E, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(E, MAT_FINAL_ASSEMBLY));
  return E;
}

/// The stored values of a row, to be given back at once: they are copied.
std::vector<double> row_values(Mat A, PetscInt row, std::vector<PetscInt>& columns)
{
  PetscInt n = 0;
  const PetscInt* at = nullptr;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetRow(A, row, &n, &at, &values));
  columns.assign(at, at + n);
  std::vector<double> copy(values, values + n);
  petsc::check(MatRestoreRow(A, row, &n, &at, &values));
  return copy;
}

/// [Re a, -Im a; -Im a, -Re a] of the entries of a row, or Re a of a model without damping.
void insert_row(Mat A, PetscInt width, PetscInt row, const std::vector<PetscInt>& columns,
                const std::vector<Complex>& a)
{
  const auto n = static_cast<PetscInt>(a.size());
  std::vector<PetscInt> at;
  std::vector<double> upper, lower;
  for (PetscInt k = 0; k < n; ++k) {
    const Complex value = a[static_cast<std::size_t>(k)];
    for (PetscInt part = 0; part < width; ++part) {
      at.push_back(width * columns[static_cast<std::size_t>(k)] + part);
      upper.push_back(part == 0 ? value.real() : -value.imag());
      lower.push_back(part == 0 ? -value.imag() : -value.real());
    }
  }
  for (PetscInt part = 0; part < width; ++part) {
    const PetscInt global = width * row + part;
    petsc::check(MatSetValues(A, 1, &global, static_cast<PetscInt>(at.size()), at.data(),
                              (part == 0 ? upper : lower).data(), INSERT_VALUES));
  }
}

}  // namespace

HarmonicResponse::HarmonicResponse(const HarmonicModel& model, const FreeDofs& free,
                                   const std::vector<DofForm>& loads,
                                   const std::vector<DofForm>& outputs, linear::OptionSource source)
    : width_(model.is_damped() ? 2 : 1),
      factors_(model),
      source_(std::move(source)),
      n_outputs_(std::ssize(outputs))
{
  const petsc::Matrix K = free_block(model.K, free), M = free_block(model.M, free);
  const petsc::Matrix C = model.C == nullptr ? petsc::Matrix() : free_block(model.C, free);
  const petsc::Matrix H = model.H == nullptr ? petsc::Matrix() : free_block(model.H, free);
  const petsc::Matrix undamped = union_of(K, M, C);
  const petsc::Matrix pattern = union_of(undamped, undamped, H);
  K_ = spread(K, pattern);
  M_ = spread(M, pattern);
  if (model.C != nullptr) C_ = spread(C, pattern);
  if (model.H != nullptr) H_ = spread(H, pattern);
  A_ = blocks_on(pattern, width_);
  const FreeRows rows(free, K_);
  E_ = load_columns(A_, width_, rows, loads);
  for (Index i = 0; i < n_outputs_; ++i) {
    const DofForm& form = outputs[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < form.dofs.size(); ++k)
      if (const auto row = rows.local(form.dofs[k]))
        shares_.push_back({i, width_ * *row, form.weights[k]});
  }
}

void HarmonicResponse::set_values(double Omega)
{
  const Complex of_K(1.0, factors_.loss_factor + Omega * factors_.beta);
  const Complex of_M(-Omega * Omega, Omega * factors_.alpha), of_C(0.0, Omega);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K_, &first, &last));
  std::vector<PetscInt> columns;
  for (PetscInt row = first; row < last; ++row) {
    const std::vector<double> K = row_values(K_, row, columns), M = row_values(M_, row, columns);
    std::vector<Complex> a(K.size());
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = of_K * K[k] + of_M * M[k];
    const auto add = [&](Mat A, Complex factor) {
      if (A == nullptr) return;
      const std::vector<double> values = row_values(A, row, columns);
      for (std::size_t k = 0; k < a.size(); ++k) a[k] += factor * values[k];
    };
    add(C_, of_C);
    add(H_, Complex(0.0, 1.0));
    insert_row(A_, width_, row, columns, a);
  }
  petsc::check(MatAssemblyBegin(A_, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(A_, MAT_FINAL_ASSEMBLY));
}

void HarmonicResponse::check_resonance(double Omega, Mat V) const
{
  if (width_ == 2) return;
  const petsc::Matrix K_V = linear::uninitialized_dense(V, linear::LocalRows(V).n_cols());
  linear::SparseProduct(K_).apply(V, K_V);
  const std::vector<double> elastic = linear::column_products(K_V, K_V),
                            loads = linear::column_products(E_, E_);
  constexpr double resonant = 1e8;
  for (std::size_t j = 0; j < loads.size(); ++j) {
    if (elastic[j] < resonant * resonant * loads[j]) continue;
    throw Resonance(fmt::format("{:.9g} Hz is an undamped natural frequency of the model",
                                Omega / (2.0 * std::numbers::pi)));
  }
}

MatrixXcd HarmonicResponse::outputs_of(Mat V) const
{
  const linear::LocalRows v(V);
  MatrixXd re = MatrixXd::Zero(n_outputs_, v.n_cols()), im = re;
  for (const Share& share : shares_) {
    for (PetscInt j = 0; j < v.n_cols(); ++j) {
      re(share.output, j) += share.weight * v(share.row, j);
      if (width_ == 2) im(share.output, j) += share.weight * v(share.row + 1, j);
    }
  }
  linear::sum_over_ranks(linear::values_of(re), petsc::communicator(V));
  linear::sum_over_ranks(linear::values_of(im), petsc::communicator(V));
  return re + Complex(0.0, 1.0) * im;
}

MatrixXcd HarmonicResponse::at(double Omega)
{
  set_values(Omega);
  if (solver_) {
    petsc::check(KSPSetOperators(solver_, A_, A_));
    petsc::check(KSPSetUp(solver_));
  } else {
    solver_ = indefinite_factor(A_, source_.part("response_"));
  }
  const petsc::Matrix V = linear::uninitialized_dense(A_, linear::LocalRows(E_).n_cols());
  if (!solve_to_round_off(solver_, E_, V)) {
    throw Error(
        fmt::format("harmonic_response: the dynamic stiffness has no usable factor at {:.9g} Hz; "
                    "it is an undamped natural frequency, or the memory does not suffice",
                    Omega / (2.0 * std::numbers::pi)));
  }
  check_resonance(Omega, V);
  return outputs_of(V);
}

}  // namespace chladni::reduce
