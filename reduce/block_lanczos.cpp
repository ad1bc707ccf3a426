#include "reduce/block_lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "reduce/block_basis.hpp"

namespace chladni::reduce {

namespace {

/// Deterministic numbers in (-1, 1) from the global row and the column (splitmix64).
double start_value(std::uint64_t row, std::uint64_t column)
{
  std::uint64_t z = row * 0x9E3779B97F4A7C15ULL + column * 0xD1B54A32D192ED03ULL + 1;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return 2.0 * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53) - 1.0;
}

/// The state of the iteration: K^-1 M V = V T + Q R E_last^T with V^T M V = I.
class BlockLanczos {
 public:
  BlockLanczos(Mat factor, Mat M, const BlockLanczosOptions& options)
      : factor_(factor), M_(M), options_(options), basis_(M, capacity(M, options))
  {}

  EigenPairs run();

 private:
  static PetscInt capacity(Mat M, const BlockLanczosOptions& options);
  void start();
  void step();
  void restart();
  bool converged();
  double residual(PetscInt i) const;
  EigenPairs extract();
  /// Appends the block to the basis after reorthogonalisation; R of the factorisation block = Q R.
  SmallMatrix append(petsc::Matrix block, SmallMatrix* coefficients);

  Mat factor_;
  Mat M_;
  BlockLanczosOptions options_;
  BlockBasis basis_;     ///< V and, behind it, the newest block Q
  PetscInt n_old_ = 0;   ///< columns of V
  SmallMatrix T_{0, 0};  ///< [n_old x n_old]
  SmallMatrix R_{0, 0};  ///< [columns of Q x columns of the last block of V]
  SymmetricEigen ritz_{{}, {0, 0}};
  PetscInt n_solves_ = 0;
};

PetscInt BlockLanczos::capacity(Mat M, const BlockLanczosOptions& options)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(M, &n, nullptr));
  const PetscInt b = options.block_size;
  const PetscInt wanted = options.max_subspace > 0
                              ? std::max(options.max_subspace, options.n_pairs + 4 * b)
                              : 2 * options.n_pairs + 16 * b;
  return std::min(wanted, n) + b;
}

void BlockLanczos::start()
{
  petsc::Matrix random = basis_.new_block(std::min(options_.block_size, basis_.n_rows()));
  PetscScalar* values = nullptr;
  PetscInt first = 0, n_local = 0, n_columns = 0;
  petsc::check(MatGetOwnershipRange(random, &first, nullptr));
  petsc::check(MatGetLocalSize(random, &n_local, nullptr));
  petsc::check(MatGetSize(random, nullptr, &n_columns));
  petsc::check(MatDenseGetArrayWrite(random, &values));
  for (PetscInt j = 0; j < n_columns; ++j) {
    for (PetscInt i = 0; i < n_local; ++i) {
      values[i + std::size_t(j) * n_local] = start_value(first + i, j);
    }
  }
  petsc::check(MatDenseRestoreArrayWrite(random, &values));
  // One application puts the start into the range of K^-1 M.
  petsc::Matrix block = basis_.new_block(n_columns);
  petsc::check(MatMatSolve(factor_, basis_.times_mass(random), block));
  n_solves_ += n_columns;
  basis_.append(block);
}

void BlockLanczos::step()
{
  const PetscInt first = n_old_;
  const PetscInt n_columns = basis_.n_columns() - n_old_;
  petsc::Matrix block = basis_.new_block(n_columns);
  petsc::check(MatMatSolve(factor_, basis_.newest_times_mass(), block));
  n_solves_ += n_columns;
  n_old_ = basis_.n_columns();
  const BlockBasis::Appended appended = basis_.append(block);
  SmallMatrix T(n_old_, n_old_);
  for (PetscInt j = 0; j < first; ++j) {
    for (PetscInt i = 0; i < first; ++i) T(i, j) = T_(i, j);
  }
  for (PetscInt j = 0; j < n_columns; ++j) {
    for (PetscInt i = 0; i < n_old_; ++i) {
      const bool both_new = i >= first;
      const double mirrored = both_new ? appended.coefficients(first + j, i - first) : 0.0;
      const double value =
          both_new ? 0.5 * (appended.coefficients(i, j) + mirrored) : appended.coefficients(i, j);
      T(i, first + j) = T(first + j, i) = value;
    }
  }
  T_ = std::move(T);
  R_ = appended.R;
}

/// || R s_last || of Ritz pair i (theta descending), relative to theta.
double BlockLanczos::residual(PetscInt i) const
{
  const PetscInt column = n_old_ - 1 - i;
  double sum = 0.0;
  for (PetscInt a = 0; a < R_.n_rows; ++a) {
    double component = 0.0;
    for (PetscInt c = 0; c < R_.n_cols; ++c) {
      component += R_(a, c) * ritz_.vectors(n_old_ - R_.n_cols + c, column);
    }
    sum += component * component;
  }
  return std::sqrt(sum) / std::abs(ritz_.values[column]);
}

bool BlockLanczos::converged()
{
  const bool exhausted = R_.n_rows == 0;  // the subspace is invariant: all of it is exact
  if (n_old_ < options_.n_pairs && !exhausted) return false;
  ritz_ = symmetric_eigen(T_);
  const PetscInt n = std::min(options_.n_pairs, n_old_);
  for (PetscInt i = n - 1; i >= 0; --i) {  // the highest converge last
    if (residual(i) > options_.tolerance) return false;
  }
  return true;
}

/// Keeps the leading Ritz vectors and the newest block.
void BlockLanczos::restart()
{
  ritz_ = symmetric_eigen(T_);
  const PetscInt n_kept = std::min(n_old_ - 1, options_.n_pairs + (n_old_ - options_.n_pairs) / 2);
  SmallMatrix S(n_old_, n_kept);
  SmallMatrix T(n_kept, n_kept);
  for (PetscInt k = 0; k < n_kept; ++k) {
    const PetscInt column = n_old_ - 1 - k;
    T(k, k) = ritz_.values[column];
    for (PetscInt i = 0; i < n_old_; ++i) S(i, k) = ritz_.vectors(i, column);
  }
  basis_.compress(S, n_old_);
  T_ = std::move(T);
  n_old_ = n_kept;
}

/// Purified Ritz vectors x = (V s theta + Q R s_last) / theta, normalised in M.
EigenPairs BlockLanczos::extract()
{
  const PetscInt n = std::min(options_.n_pairs, n_old_);
  const PetscInt n_new = basis_.n_columns() - n_old_;
  SmallMatrix S(basis_.n_columns(), n);
  EigenPairs pairs{.lambda = {}, .residual = {}, .X = {}, .n_solves = n_solves_};
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt column = n_old_ - 1 - k;
    const double theta = ritz_.values[column];
    pairs.lambda.push_back(1.0 / theta);
    pairs.residual.push_back(residual(k));
    for (PetscInt i = 0; i < n_old_; ++i) S(i, k) = ritz_.vectors(i, column);
    for (PetscInt a = 0; a < n_new; ++a) {
      for (PetscInt c = 0; c < R_.n_cols; ++c) {
        S(n_old_ + a, k) += R_(a, c) * ritz_.vectors(n_old_ - R_.n_cols + c, column) / theta;
      }
    }
    double norm = 0.0;  // in the M-orthonormal basis
    for (PetscInt i = 0; i < S.n_rows; ++i) norm += S(i, k) * S(i, k);
    for (PetscInt i = 0; i < S.n_rows; ++i) S(i, k) /= std::sqrt(norm);
  }
  pairs.X = basis_.combine(S);
  return pairs;
}

EigenPairs BlockLanczos::run()
{
  start();
  for (PetscInt i = 0; i < options_.max_steps; ++i) {
    step();
    if (converged()) return extract();
    if (basis_.n_columns() + options_.block_size > basis_.capacity()) restart();
  }
  throw Error(
      fmt::format("block_lanczos: {} pairs did not converge to {:.1e} in {} block solves; "
                  "ask for fewer or raise the tolerance",
                  options_.n_pairs, options_.tolerance, options_.max_steps));
}

}  // namespace

EigenPairs block_lanczos(Mat factor, Mat M, const BlockLanczosOptions& options)
{
  return BlockLanczos(factor, M, options).run();
}

}  // namespace chladni::reduce
