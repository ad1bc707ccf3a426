#include "reduce/residual_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "common/eigen_every.hpp"
#include "common/petsc.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

petsc::Matrix combination(Mat X, const MatrixXd& S)
{
  petsc::Matrix XS = linear::uninitialized_dense(X, S.cols());
  petsc::check(MatZeroEntries(XS));
  linear::add_product(1.0, X, S, XS);
  return XS;
}

MatrixXd symmetric(const MatrixXd& A)
{
  return 0.5 * (A + A.transpose());
}

/// A bordered by further rows and columns.
MatrixXd bordered(const MatrixXd& A, const MatrixXd& above, const MatrixXd& corner)
{
  const Index n = A.rows(), k = corner.rows();
  MatrixXd B(n + k, n + k);
  B.topLeftCorner(n, n) = A;
  B.topRightCorner(n, k) = above;
  B.bottomLeftCorner(k, n) = above.transpose();
  B.bottomRightCorner(k, k) = corner;
  return B;
}

VectorXd stiffness_of_modes(const ReducedModel& model)
{
  return model.K.diagonal().tail(std::ssize(model.omega));
}

/// The shapes less their share of the basis, made K-orthonormal.
/// @param lambda  K_qq
petsc::Matrix orthonormal_to_basis(Mat shapes, Mat Phi, const VectorXd& lambda, Mat K)
{
  constexpr double dependent = 1e-6;  // of their lengths: what a Gram matrix resolves
  petsc::Matrix Z;
  petsc::check(MatDuplicate(shapes, MAT_COPY_VALUES, Z.put()));
  const petsc::Matrix KZ = linear::sparse_product(K, Z);
  const MatrixXd share = lambda.cwiseInverse().asDiagonal() * linear::inner_product(Phi, KZ);
  const MatrixXd G = symmetric(linear::inner_product(Z, KZ));
  linear::add_product(-1.0, Phi, share, Z);
  const MatrixXd left = G - linear::product(share.transpose(), lambda.asDiagonal() * share);
  const std::vector<double> units(static_cast<std::size_t>(G.rows()), 1.0);
  const linear::Orthonormalisation o =
      linear::orthonormalisation(left, units, dependent, petsc::communicator(K));
  return combination(Z, o.to_Q);
}

std::vector<int> moving_masters(const GrowingBasis& basis)
{
  if (basis.moving) return *basis.moving;
  std::vector<int> all(std::size_t(basis.model.n_masters));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// The places of some numbers in a list that has them, both ascending.
std::vector<int> places(std::span<const int> numbers, const std::vector<int>& list)
{
  std::vector<int> at;
  for (const int number : numbers)
    at.push_back(static_cast<int>(std::ranges::lower_bound(list, number) - list.begin()));
  return at;
}

}  // namespace

ResidualForms::ResidualForms(const GrowingBasis& basis)
    : of_(basis), moving_(moving_masters(basis)), slaves_(basis.K_ss, basis.M, basis.Q_CB, moving_)
{
  if (!slaves_.are_all()) own_Phi_ = slaves_.rows_of(of_.Q_CB.modes->Phi);
  const MatrixXd H_mm = forms_of_masters();
  linear::InverseForm D = slaves_.inverse_form(linear::sparse_product(slaves_.M_ss(), Phi()));
  H_ = bordered(H_mm, with_masters(D.right()), symmetric(linear::inner_product(D.left, D.right())));
  left_D_ = std::move(D.left);
}

/// B of moving masters first .. last - 1.
petsc::Matrix ResidualForms::inertia_of_masters(std::size_t first, std::size_t last) const
{
  constexpr PetscInt most = 64;  // columns that are copied at a time
  const std::vector<int> columns =
      places(std::span(moving_).subspan(first, last - first), slaves_.masters());
  const auto n = static_cast<PetscInt>(columns.size());
  const linear::SparseProduct M_ss(slaves_.M_ss());
  petsc::Matrix B = linear::uninitialized_dense(slaves_.M_ss(), n);
  if (n > 0 && columns.back() - columns.front() == n - 1) {
    M_ss.apply(linear::ColumnRange(slaves_.Psi(), columns.front(), columns.back() + 1), B);
  } else {
    for (PetscInt at = 0; at < n; at += most) {
      const PetscInt end = std::min(at + most, n);
      const auto some = std::span(columns).subspan(std::size_t(at), std::size_t(end - at));
      M_ss.apply(columns_of(slaves_.Psi(), some), linear::ColumnRange(B, at, end));
    }
  }
  MatrixXd unit = MatrixXd::Zero(of_.model.n_masters, n);
  for (PetscInt j = 0; j < n; ++j) unit(moving_[first + std::size_t(j)], j) = 1.0;
  linear::add_sparse_product(slaves_.M_sm(), unit, B);
  return B;
}

MatrixXd ResidualForms::forms_of_masters()
{
  MatrixXd of_all = MatrixXd::Zero(of_.model.n_masters, of_.model.n_masters);
  if (slaves_.halves()) {
    left_B_ = std::move(slaves_.inverse_form(inertia_of_masters(0, moving_.size())).left);
    of_all(moving_, moving_) = linear::gram(left_B_);
    return of_all;
  }
  constexpr PetscInt most = 64;  // columns of B at a time: they stay beside the solutions
  const auto n = static_cast<PetscInt>(moving_.size());
  left_B_ = linear::uninitialized_dense(slaves_.K_ss(), n);
  MatrixXd H = MatrixXd::Zero(n, n);
  for (PetscInt first = 0; first < n; first += most) {
    const PetscInt last = std::min(first + most, n);
    const linear::InverseForm form =
        slaves_.inverse_form(inertia_of_masters(std::size_t(first), std::size_t(last)));
    petsc::check(
        MatCopy(form.left, linear::ColumnRange(left_B_, first, last), SAME_NONZERO_PATTERN));
    H.block(0, first, last, last - first) =
        linear::inner_product(linear::ColumnRange(left_B_, 0, last), form.right());
  }
  of_all(moving_, moving_) = MatrixXd(H.selfadjointView<Eigen::Upper>());
  return of_all;
}

MatrixXd ResidualForms::with_masters(Mat right) const
{
  MatrixXd forms = MatrixXd::Zero(of_.model.n_masters, linear::LocalRows(right).n_cols());
  forms(moving_, every) = linear::inner_product(left_B_, right);
  return forms;
}

MatrixXd ResidualForms::energy(const MatrixXd& X, double s) const
{
  return energy({.elastic = X.bottomRows(std::ssize(of_.model.omega)), .inertia = s * X});
}

MatrixXd ResidualForms::energy(const ForcedMotions& motions) const
{
  const auto& [P, X] = motions;
  MatrixXd G = linear::product(X.transpose(), linear::product(H_, X));
  G += linear::product(P.transpose(), stiffness_of_modes(of_.model).asDiagonal() * P);
  const MatrixXd momentum = linear::product(of_.model.M.bottomRows(P.rows()), X);
  G -= 2.0 * linear::product(P.transpose(), momentum);
  return symmetric(G);
}

petsc::Matrix ResidualForms::shapes(const MatrixXd& X, double s) const
{
  const Index n_q = std::ssize(of_.model.omega);
  const MatrixXd X_m = X.topRows(X.rows() - n_q), X_q = X.bottomRows(n_q);
  petsc::Matrix z = combination(Phi(), X_q);
  petsc::Matrix u;
  petsc::check(MatDuplicate(z, MAT_COPY_VALUES, u.put()));
  linear::add_product(1.0, slaves_.Psi(), X_m(slaves_.masters(), every), u);
  const petsc::Matrix inertia = linear::sparse_product(slaves_.M_ss(), u);
  linear::add_sparse_product(slaves_.M_sm(), X_m, inertia);
  petsc::check(MatAXPY(z, -s, slaves_.solution(inertia), SAME_NONZERO_PATTERN));
  return z;
}

void ResidualForms::append(Mat shapes)
{
  ReducedModel& model = of_.model;
  const petsc::Matrix Z =
      orthonormal_to_basis(shapes, Phi(), stiffness_of_modes(model), slaves_.K_ss());
  const PetscInt k = linear::LocalRows(Z).n_cols();
  petsc::Matrix D = linear::sparse_product(slaves_.M_ss(), Z);
  MatrixXd above(model.M.rows(), k), H_above(H_.rows(), k);
  above.topRows(model.n_masters) = linear::inner_product_sparse(Z, slaves_.M_sm()).transpose();
  above(slaves_.masters(), every) += linear::inner_product(slaves_.Psi(), D);
  above.bottomRows(std::ssize(model.omega)) = linear::inner_product(Phi(), D);
  model.M = bordered(model.M, above, symmetric(linear::inner_product(Z, D)));
  const linear::InverseForm form = slaves_.inverse_form(std::move(D));
  H_above.topRows(model.n_masters) = with_masters(form.right());
  H_above.bottomRows(std::ssize(model.omega)) = linear::inner_product(left_D_, form.right());
  H_ = bordered(H_, H_above, symmetric(linear::inner_product(form.left, form.right())));
  model.K = bordered(model.K, MatrixXd::Zero(model.K.rows(), k), MatrixXd::Identity(k, k));
  petsc::Matrix& own = slaves_.are_all() ? of_.Q_CB.modes->Phi : own_Phi_;
  own = beside(own, Z, k);
  left_D_ = beside(left_D_, form.left, k);
  model.omega.resize(model.omega.size() + std::size_t(k), 1.0);
}

/// Phi and the shapes that have been added, at all slaves.
petsc::Matrix ResidualForms::all_shapes()
{
  petsc::Matrix& Phi = of_.Q_CB.modes->Phi;
  if (slaves_.are_all()) return std::move(Phi);
  const PetscInt n_before = linear::LocalRows(Phi).n_cols(),
                 n_now = linear::LocalRows(own_Phi_).n_cols();
  return beside(Phi, slaves_.of_all(own_Phi_, n_before, n_now), n_now - n_before);
}

void ResidualForms::make_ritz()
{
  ReducedModel& model = of_.model;
  const PetscInt n_m = model.n_masters;
  const auto n_q = static_cast<PetscInt>(model.omega.size());
  const VectorXd unit = stiffness_of_modes(model).cwiseSqrt().cwiseInverse();
  const MatrixXd mass = unit.asDiagonal() * model.M.bottomRightCorner(n_q, n_q) * unit.asDiagonal();
  const linear::SymmetricEigen ritz =  // of M x = mu K x, which keeps the lowest accurate
      linear::symmetric_eigen(mass, petsc::communicator(of_.K.ss));
  std::vector<double> omega;
  MatrixXd V(n_q, n_q);
  for (PetscInt i = n_q - 1; i >= 0 && ritz.values[std::size_t(i)] > 0.0; --i) {
    const double root = std::sqrt(ritz.values[std::size_t(i)]);
    V.col(std::ssize(omega)) = unit.cwiseProduct(ritz.vectors.col(i)) / root;
    omega.push_back(1.0 / root);
  }
  V.conservativeResize(n_q, std::ssize(omega));
  const MatrixXd P = linear::product(V.transpose(), model.M.bottomLeftCorner(n_q, n_m));
  of_.Q_CB.modes = {.Phi = combination(all_shapes(), V), .omega = omega};
  model = join({.K = model.K.topLeftCorner(n_m, n_m), .R = model.R},
               model.M.topLeftCorner(n_m, n_m), P, std::move(omega));
}

namespace {

/// For each of some parts which columns are not zero in its rows, the same on every rank.
class Touched {
 public:
  Touched(std::size_t n_parts, PetscInt n_columns)
      : n_columns_(static_cast<std::size_t>(n_columns)), is_(n_parts * n_columns_, 0)
  {}
  void add(std::size_t part, PetscInt column) { is_[part * n_columns_ + std::size_t(column)] = 1; }
  void add(std::size_t part, const std::vector<PetscInt>& rows, const linear::LocalRows& X)
  {
    for (PetscInt j = 0; j < X.n_cols(); ++j)
      if (std::ranges::any_of(rows, [&](PetscInt i) { return X(i, j) != 0.0; })) add(part, j);
  }
  void of_all_ranks(MPI_Comm comm)
  {
    MPI_Allreduce(MPI_IN_PLACE, is_.data(), static_cast<int>(is_.size()), MPI_INT, MPI_MAX, comm);
  }
  bool operator()(std::size_t part, PetscInt column) const
  {
    return is_[part * n_columns_ + std::size_t(column)] != 0;
  }
  PetscInt n_columns() const { return static_cast<PetscInt>(n_columns_); }

 private:
  std::size_t n_columns_;
  std::vector<int> is_;
};

/// Parts of the slaves, and the masters and modes that move each.
struct Parts {
  std::vector<std::vector<PetscInt>> rows;  ///< of this rank, counted from its first
  Touched masters, modes;
};

Parts parts_of(const std::vector<petsc::IndexSet>& sets, const Blocks& M,
               const CraigBamptonBasis& Q_CB)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(M.ss, &first, &last));
  const linear::LocalRows Psi(Q_CB.Psi);
  Parts parts{.rows = {},
              .masters = Touched(sets.size(), Psi.n_cols()),
              .modes = Touched(sets.size(), Q_CB.n_modes())};
  std::vector<std::size_t> part_of(std::size_t(last - first));
  for (std::size_t p = 0; p < sets.size(); ++p) {
    parts.rows.push_back(petsc::own_rows(sets[p], M.ss));
    for (const PetscInt i : parts.rows.back()) part_of[std::size_t(i)] = p;
    parts.masters.add(p, parts.rows.back(), Psi);
    if (Q_CB.modes) parts.modes.add(p, parts.rows.back(), linear::LocalRows(Q_CB.modes->Phi));
  }
  linear::for_local_entries(M.sm, [&](PetscInt row, PetscInt column, double value) {
    if (value != 0.0) parts.masters.add(part_of[std::size_t(row - first)], column);
  });
  parts.masters.of_all_ranks(petsc::communicator(M.ss));
  parts.modes.of_all_ranks(petsc::communicator(M.ss));
  return parts;
}

/// Whether some masters move each part, at once or by modes that move several.
std::vector<char> moved(const Parts& parts, const std::vector<int>& moving)
{
  std::vector<char> is_moved(parts.rows.size(), 0);
  for (std::size_t p = 0; p < parts.rows.size(); ++p) {
    is_moved[p] =
        std::ranges::any_of(moving, [&](int master) { return parts.masters(p, master); }) ? 1 : 0;
  }
  for (std::size_t round = 1; round < parts.rows.size(); ++round)
    for (std::size_t p = 0; p < parts.rows.size(); ++p)
      for (std::size_t q = 0; q < parts.rows.size(); ++q)
        for (PetscInt k = 0; k < parts.modes.n_columns(); ++k)
          if (is_moved[p] != 0 && parts.modes(p, k) && parts.modes(q, k)) is_moved[q] = 1;
  return is_moved;
}

petsc::Matrix submatrix(Mat A, IS rows, IS columns)
{
  petsc::Matrix part;
  petsc::check(MatCreateSubMatrix(A, rows, columns, MAT_INITIAL_MATRIX, part.put()));
  return part;
}

std::vector<int> all(PetscInt n)
{
  std::vector<int> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

PetscInt first_row(Mat A)
{
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  return first;
}

}  // namespace

MovingSlaves::MovingSlaves(const linear::Factorization& K_ss, const Blocks& M,
                           const CraigBamptonBasis& Q_CB, const std::vector<int>& moving)
    : factor_(K_ss), M_(M), Q_CB_(Q_CB), masters_(all(linear::LocalRows(Q_CB.Psi).n_cols()))
{
  if (moving.empty() || !linear::solves_for_parts(K_ss.factor())) return;
  const std::vector<petsc::IndexSet> sets = linear::decoupled_rows(K_ss.matrix(), M.ss);
  if (sets.empty()) return;
  const Parts parts = parts_of(sets, M, Q_CB);
  const std::vector<char> is_moved = moved(parts, moving);
  if (std::ranges::all_of(is_moved, [](char is) { return is != 0; })) return;

  std::vector<PetscInt> own, global;
  for (std::size_t p = 0; p < parts.rows.size(); ++p)
    if (is_moved[p] != 0) own.insert(own.end(), parts.rows[p].begin(), parts.rows[p].end());
  std::ranges::sort(own);
  for (const PetscInt i : own) global.push_back(i + first_row(M.ss));
  petsc::check(ISCreateGeneral(petsc::communicator(M.ss), static_cast<PetscInt>(global.size()),
                               global.data(), PETSC_COPY_VALUES, rows_.put()));
  std::erase_if(masters_, [&](int master) {
    if (std::ranges::binary_search(moving, master)) return false;
    for (std::size_t p = 0; p < parts.rows.size(); ++p)
      if (is_moved[p] != 0 && parts.masters(p, master)) return false;
    return true;
  });
  K_ss_ = submatrix(K_ss.matrix(), rows_, rows_);
  M_ss_ = submatrix(M.ss, rows_, rows_);
  M_sm_ = submatrix(M.sm, rows_, nullptr);
  Psi_ = block_of(linear::LocalRows(Q_CB.Psi), own, masters_, K_ss_);
  solve_ = linear::part_solver(K_ss.factor(), rows_);
  form_ = linear::part_form(K_ss.factor(), rows_);
}

petsc::Matrix MovingSlaves::rows_of(Mat X) const
{
  const linear::LocalRows x(X);
  return block_of(x, petsc::own_rows(rows_, X), all(x.n_cols()), K_ss_);
}

petsc::Matrix MovingSlaves::of_all(Mat X, PetscInt first, PetscInt last) const
{
  const std::vector<PetscInt> own = petsc::own_rows(rows_, factor_.matrix());
  const linear::LocalRows x(X);
  petsc::Matrix every = linear::uninitialized_dense(factor_.matrix(), last - first);
  petsc::check(MatZeroEntries(every));
  const std::size_t n_local = linear::LocalRows(every).n_rows();
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(every, &values));
  for (PetscInt j = first; j < last; ++j)
    for (std::size_t i = 0; i < own.size(); ++i) {
      values[std::size_t(own[i]) + std::size_t(j - first) * n_local] =
          x(static_cast<PetscInt>(i), j);
    }
  petsc::check(MatDenseRestoreArray(every, &values));
  return every;
}

petsc::Matrix MovingSlaves::solution(Mat F) const
{
  petsc::Matrix z = linear::uninitialized_dense(F, linear::LocalRows(F).n_cols());
  if (are_all())
    petsc::check(MatMatSolve(factor_.factor(), F, z));
  else
    solve_(F, z);
  return z;
}

linear::InverseForm MovingSlaves::inverse_form(petsc::Matrix B) const
{
  return are_all() ? linear::inverse_form(factor_.factor(), std::move(B)) : form_(std::move(B));
}

petsc::Matrix columns_of(Mat X, std::span<const int> numbers)
{
  const linear::LocalRows x(X);
  petsc::Matrix some = linear::uninitialized_dense(X, std::ssize(numbers));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(some, &values));
  for (std::size_t j = 0; j < numbers.size(); ++j) {
    std::copy_n(x.values() + std::size_t(numbers[j]) * std::size_t(x.leading_dimension()),
                x.n_rows(), values + j * std::size_t(x.n_rows()));
  }
  petsc::check(MatDenseRestoreArrayWrite(some, &values));
  return some;
}

}  // namespace chladni::reduce
