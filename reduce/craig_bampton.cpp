#include "reduce/craig_bampton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/forms.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// sum_k M_kk Psi_kj^2 of some columns.
std::vector<double> terms_of_slaves(Mat Psi, Mat M_ss, const std::vector<double>& is_asked)
{
  const linear::LocalRows psi(Psi);
  const petsc::Vector diagonal = linear::diagonal(M_ss);
  const PetscScalar* m = nullptr;
  petsc::check(VecGetArrayRead(diagonal, &m));
  std::vector<double> terms(is_asked.size(), 0.0);
  for (PetscInt j = 0; j < psi.n_cols(); ++j) {
    if (is_asked[std::size_t(j)] == 0.0) continue;
    for (PetscInt k = 0; k < psi.n_rows(); ++k)
      terms[std::size_t(j)] += m[k] * psi(k, j) * psi(k, j);
  }
  petsc::check(VecRestoreArrayRead(diagonal, &m));
  MPI_Allreduce(MPI_IN_PLACE, terms.data(), int(terms.size()), MPI_DOUBLE, MPI_SUM,
                petsc::communicator(Psi));
  return terms;
}

/// Rows of masters without mass hold the round-off of their terms, which may be negative: they
/// become zero.
void clear_round_off(MatrixXd& M_G, const MatrixXd& M_mm, Mat Psi, const Blocks& M)
{
  constexpr double suspicious = 1e-10, round_off = 64.0 * std::numeric_limits<double>::epsilon();
  const double largest = M_G.rows() > 0 ? M_G.diagonal().maxCoeff() : 0.0;
  std::vector<double> is_asked;
  for (Eigen::Index i = 0; i < M_G.rows(); ++i) {
    const bool is_clear = M_G(i, i) > suspicious * M_mm(i, i) && M_G(i, i) > suspicious * largest;
    is_asked.push_back(is_clear ? 0.0 : 1.0);
  }
  linear::broadcast_numbers(is_asked, petsc::communicator(Psi));
  if (std::ranges::count(is_asked, 1.0) == 0) return;
  const std::vector<double> of_slaves = terms_of_slaves(Psi, M.ss, is_asked);
  for (Eigen::Index i = 0; i < M_G.rows(); ++i) {
    const double terms = M_mm(i, i) + of_slaves[std::size_t(i)];
    if (is_asked[std::size_t(i)] == 0.0 || std::abs(M_G(i, i)) > round_off * terms) continue;
    M_G.row(i).setZero();
    M_G.col(i).setZero();
  }
}

/// @param Psi_M_Psi  Psi^T M_ss Psi
MatrixXd guyan_mass(Mat Psi, const Blocks& M, const MatrixXd& Psi_M_Psi)
{
  const MatrixXd M_mm = linear::replicate(M.mm), Psi_M_sm = linear::inner_product_sparse(Psi, M.sm);
  MatrixXd M_G(M_mm.rows(), M_mm.cols());
  M_G.triangularView<Eigen::Upper>() =
      0.5 * (M_mm + M_mm.transpose()) + Psi_M_sm + Psi_M_sm.transpose() + Psi_M_Psi;
  M_G = MatrixXd(M_G.selfadjointView<Eigen::Upper>());
  clear_round_off(M_G, M_mm, Psi, M);
  return M_G;
}

}  // namespace

MatrixXd guyan_mass(Mat Psi, const Blocks& M)
{
  return guyan_mass(Psi, M,
                    linear::parted_form(std::array{Psi}, M.ss, linear::FormSymmetry::symmetric));
}

MatrixXd inertial_coupling(Mat Phi, Mat Psi, const Blocks& M)
{
  return linear::inner_product_sparse(Phi, M.sm) + linear::parted_form(Phi, M.ss, Psi);
}

ReducedModel join(const GuyanStiffness& K_G, const MatrixXd& M_G, const MatrixXd& P,
                  std::vector<double> omega)
{
  const Eigen::Index n_m = K_G.K.rows(), n_q = std::ssize(omega);
  MatrixXd K = MatrixXd::Zero(n_m + n_q, n_m + n_q), M = MatrixXd::Identity(n_m + n_q, n_m + n_q);
  K.topLeftCorner(n_m, n_m) = K_G.K;
  M.topLeftCorner(n_m, n_m) = M_G;
  M.bottomLeftCorner(n_q, n_m) = P.topRows(n_q);
  M.topRightCorner(n_m, n_q) = P.topRows(n_q).transpose();
  for (Eigen::Index k = 0; k < n_q; ++k) K(n_m + k, n_m + k) = omega[k] * omega[k];
  return {.K = std::move(K),
          .M = std::move(M),
          .n_masters = static_cast<PetscInt>(n_m),
          .omega = std::move(omega),
          .R = K_G.R};
}

ReducedModel project(const CraigBamptonBasis& Q_CB, const Blocks& K, const Blocks& M)
{
  const GuyanStiffness K_G = guyan_stiffness(Q_CB.Psi, K, M);
  if (!Q_CB.modes) {
    const MatrixXd M_G = guyan_mass(Q_CB.Psi, M);
    return join(K_G, M_G, MatrixXd(0, M_G.cols()), {});
  }
  const Mat Psi = Q_CB.Psi, Phi = Q_CB.modes->Phi;
  const MatrixXd with_Psi = linear::leading_columns_of_form(std::array{Psi, Phi}, M.ss);
  const Eigen::Index n_m = with_Psi.cols(), n_q = with_Psi.rows() - n_m;
  const MatrixXd P = linear::inner_product_sparse(Phi, M.sm) + with_Psi.bottomRows(n_q);
  return join(K_G, guyan_mass(Psi, M, with_Psi.topRows(n_m)), P, Q_CB.modes->omega);
}

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

namespace {

void add_block(MatrixXd& A, Eigen::Index first_row, Eigen::Index first_column,
               const MatrixXd& block)
{
  A.block(first_row, first_column, block.rows(), block.cols()) += block;
}

/// A dense basis of the slaves and its first coordinate.
struct Columns {
  Mat X;
  PetscInt first;
};

}  // namespace

/// With Q_CB = [I 0; X], X = [Psi Phi]: A_r = A_mm + A_ms X + X^T A_sm + X^T A_ss X.
MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A, linear::FormSymmetry symmetry)
{
  const MatrixXd A_mm = linear::replicate(A.mm);
  const auto n_m = static_cast<PetscInt>(A_mm.rows());
  std::vector<Columns> X{{Q_CB.Psi, 0}};
  if (Q_CB.modes) X.push_back({Q_CB.modes->Phi, n_m});
  MatrixXd A_r = MatrixXd::Zero(n_m + Q_CB.n_modes(), n_m + Q_CB.n_modes());
  add_block(A_r, 0, 0, A_mm);
  petsc::Matrix A_ms_T;  // that its product with X is one with sparse columns
  petsc::check(MatTranspose(A.ms, MAT_INITIAL_MATRIX, A_ms_T.put()));
  for (const Columns& part : X) {
    add_block(A_r, part.first, 0, linear::inner_product_sparse(part.X, A.sm));
    add_block(A_r, 0, part.first, linear::inner_product_sparse(part.X, A_ms_T).transpose());
  }
  std::vector<Mat> columns;
  for (const Columns& part : X) columns.push_back(part.X);
  return A_r + linear::parted_form(columns, A.ss, symmetry);
}

std::vector<MatrixXd> project_forms(const CraigBamptonBasis& Q_CB, const DofPartition& dofs,
                                    std::span<const linear::SparseForm> forms)
{
  const BasisColumns columns(Q_CB, dofs);
  const auto write = [&](PetscInt j, std::span<double> rows) { columns.write(j, rows); };
  return linear::component_forms({.n_columns = columns.size(), .write = write}, forms);
}

MatrixXd project_vectors(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, Mat V)
{
  petsc::Matrix V_m, V_s;
  petsc::check(MatCreateSubMatrix(V, dofs.masters, nullptr, MAT_INITIAL_MATRIX, V_m.put()));
  petsc::check(MatCreateSubMatrix(V, dofs.slaves, nullptr, MAT_INITIAL_MATRIX, V_s.put()));
  const MatrixXd V_mm = linear::replicate(V_m);
  const MatrixXd Psi_V = linear::inner_product(Q_CB.Psi, V_s);
  if (!Q_CB.modes) return V_mm + Psi_V;
  return linear::stacked(V_mm + Psi_V, linear::inner_product(Q_CB.modes->Phi, V_s));
}

}  // namespace chladni::reduce
