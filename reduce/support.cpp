#include "reduce/support.hpp"

#include <algorithm>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"

namespace chladni::reduce {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// M_r-orthonormal motions that K_r does not resist.
MatrixXd zero_energy_motions(const ReducedModel& model)
{
  const MatrixXd &R = model.R, &M = model.M;
  const Index n_m = R.rows(), r = R.cols();
  if (r == 0) return MatrixXd(M.rows(), 0);
  const MatrixXd G = R.transpose() * M.topLeftCorner(n_m, n_m) * R;
  const Eigen::LLT<MatrixXd> mass(G);
  if (mass.info() != Eigen::Success) {
    throw Error(
        "the motions without stiffness have a mass matrix that is singular to round-off; give each "
        "part of the body stiffness or mass");
  }
  MatrixXd Z = MatrixXd::Zero(M.rows(), r);
  Z.topRows(n_m) = mass.matrixL().solve(R.transpose()).transpose();
  return Z;
}

void refuse_indefinite_mass(const MatrixXd& M)
{
  if (M.rows() == 0) return;  // a harmonic that no master moves in, reduced by Guyan
  constexpr double round_off = 1e-8;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> mass(M, Eigen::EigenvaluesOnly);
  const double least = mass.eigenvalues()[0], largest = mass.eigenvalues()[M.rows() - 1];
  if (least >= -round_off * largest) return;
  throw Error(
      fmt::format("M is indefinite: an eigenvalue of M_r is {:.1e} of its largest; M must be "
                  "positive semidefinite",
                  least / largest));
}

}  // namespace

MatrixXd at_rest(const MatrixXd& R, const std::vector<int>& rows)
{
  if (rows.empty() || R.cols() == 0) return R;
  constexpr double round_off = 1e-10;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(MatrixXd(R(rows, every).transpose()));
  // Of all of R: rows that no motion moves hold round-off, which would be their largest pivot.
  qr.setThreshold(round_off * std::max(1.0, R.cwiseAbs().maxCoeff() / qr.maxPivot()));
  const MatrixXd Q = linear::columns_of_Q(qr, R.cols());
  return R * Q.rightCols(R.cols() - qr.rank());
}

std::vector<int> all_but(const std::vector<int>& rows, Index n)
{
  std::vector<int> others;
  for (int i = 0; i < n; ++i)
    if (!std::ranges::binary_search(rows, i)) others.push_back(i);
  return others;
}

std::vector<int> rows_of_masters(std::vector<PetscInt> masters, const std::vector<PetscInt>& held)
{
  std::ranges::sort(masters);
  std::vector<int> rows;
  for (const PetscInt dof : held) {
    const auto found = std::ranges::lower_bound(masters, dof);
    if (found == masters.end() || *found != dof) {
      throw Error(
          fmt::format("row {} cannot be held: it is no master; add it to the masters", dof));
    }
    rows.push_back(static_cast<int>(found - masters.begin()));
  }
  std::ranges::sort(rows);
  if (const auto twice = std::ranges::adjacent_find(rows); twice != rows.end())
    throw Error(fmt::format("row {} is held twice; name it once", masters[std::size_t(*twice)]));
  return rows;
}

HeldMasters::HeldMasters(const std::vector<PetscInt>& masters, std::vector<PetscInt> held)
    : held_(std::move(held)), rows_(rows_of_masters(masters, held_))
{}

SupportedModes HeldMasters::modes(const ReducedModel& model, const SpectrumRange& /*wanted*/) const
{
  refuse_indefinite_mass(model.M);
  const MatrixXd R = zero_energy_motions(model), R_free = at_rest(R, rows_);
  const std::vector<int> free = all_but(rows_, model.M.rows());
  constexpr double three_digits = 1e-3;  // of a mass: the certificate tells of the others
  const linear::Eigenmodes found = linear::eigenmodes(model.K(free, free), model.M(free, free),
                                                      R_free(free, every), three_digits);
  SupportedModes modes{.are_all = true,
                       .n_zero = static_cast<int>(R_free.cols()),
                       .n_free_zero = static_cast<int>(R.cols())};
  modes.pairs.lambda.assign(found.lambda.begin(), found.lambda.end());
  modes.pairs.X = MatrixXd::Zero(model.K.rows(), found.X.cols());
  modes.pairs.X(free, every) = found.X;
  return modes;
}

double HeldMasters::zero_energy(const ReducedModel& model, const SupportedModes& modes) const
{
  const MatrixXd R = zero_energy_motions(model);
  if (R.cols() == 0 || modes.pairs.lambda.empty()) return 0.0;
  const MatrixXd energy = R.transpose() * model.K * R;
  return energy.diagonal().cwiseAbs().maxCoeff() / modes.pairs.lambda.front();
}

}  // namespace chladni::reduce
