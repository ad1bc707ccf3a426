#include "reduce/plugin/free_masters.hpp"

#include <algorithm>

#include "mbs_export/dense_solvers.hpp"
#include "mbs_export/eigenmodes.hpp"

namespace chladni::reduce::plugin {

namespace {

using Eigen::Index, Eigen::MatrixXd;

MatrixXd as_eigen(const SmallMatrix& A)
{
  return Eigen::Map<const MatrixXd>(A.values.data(), A.n_rows, A.n_cols);
}

/// M_r-orthonormal motions that K_r does not resist.
MatrixXd zero_energy_motions(const ReducedModel& model, const MatrixXd& M)
{
  const MatrixXd R = as_eigen(model.R);
  const Index n_m = R.rows(), r = R.cols();
  if (r == 0) return MatrixXd(M.rows(), 0);
  const Eigen::LLT<MatrixXd> mass(MatrixXd(R.transpose() * M.topLeftCorner(n_m, n_m) * R));
  if (mass.info() != Eigen::Success) {
    throw Error("a motion has neither stiffness nor mass; the pencil (K, M) is singular");
  }
  MatrixXd Z = MatrixXd::Zero(M.rows(), r);
  Z.topRows(n_m) = mass.matrixL().solve(R.transpose()).transpose();
  return Z;
}

void refuse_indefinite_mass(const MatrixXd& M)
{
  constexpr double round_off = 1e-8;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> mass(M, Eigen::EigenvaluesOnly);
  const double share = mass.eigenvalues()[0] / mass.eigenvalues()[M.rows() - 1];
  if (mass.eigenvalues()[0] < -round_off * mass.eigenvalues()[M.rows() - 1]) {
    throw Error(
        fmt::format("M is indefinite: an eigenvalue of M_r is {:.1e} of its largest; M must be "
                    "positive semidefinite",
                    share));
  }
}

}  // namespace

SupportedModes FreeMasters::modes(const ReducedModel& model, const SpectrumRange& /*wanted*/) const
{
  const MatrixXd M = as_eigen(model.M);
  refuse_indefinite_mass(M);
  const MatrixXd R = zero_energy_motions(model, M);
  constexpr double three_digits = 1e-3;  // of a mass: the certificate tells of the others
  const mbs_export::Eigenmodes found =
      mbs_export::eigenmodes(as_eigen(model.K), M, R, three_digits);
  SupportedModes modes{.are_all = true,
                       .n_zero = static_cast<int>(R.cols()),
                       .n_free_zero = static_cast<int>(R.cols())};
  modes.pairs.lambda.assign(found.lambda.begin(), found.lambda.end());
  modes.pairs.X = SmallMatrix(model.K.n_rows, static_cast<PetscInt>(found.lambda.size()));
  std::ranges::copy(found.X.reshaped(), modes.pairs.X.values.begin());
  return modes;
}

double FreeMasters::zero_energy(const ReducedModel& model, const SupportedModes& modes) const
{
  const MatrixXd R = zero_energy_motions(model, as_eigen(model.M));
  if (R.cols() == 0 || modes.pairs.lambda.empty()) return 0.0;
  const MatrixXd energy = R.transpose() * as_eigen(model.K) * R;
  return energy.diagonal().cwiseAbs().maxCoeff() / modes.pairs.lambda.front();
}

}  // namespace chladni::reduce::plugin
