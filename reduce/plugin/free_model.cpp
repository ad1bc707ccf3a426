#include "reduce/plugin/free_model.hpp"

#include <algorithm>
#include <numbers>

#include "common/all_ranks.hpp"
#include "mbs_export/dense_solvers.hpp"
#include "mbs_export/eigenmodes.hpp"

namespace chladni::reduce::plugin {

namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr std::size_t most_certified = 100;  // bounds the block solve of the error estimates
constexpr std::size_t certified_of_guyan = 20;
constexpr double indefinite = 1e-8;

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
    throw Error("CMSSolve: a motion has neither stiffness nor mass; the pencil (K, M) is singular");
  }
  MatrixXd Z = MatrixXd::Zero(M.rows(), r);
  Z.topRows(n_m) = mass.matrixL().solve(R.transpose()).transpose();
  return Z;
}

FreeModel free_model(const ReducedModel& model)
{
  const MatrixXd K = as_eigen(model.K), M = as_eigen(model.M);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> mass(M, Eigen::EigenvaluesOnly);
  if (mass.eigenvalues()[0] < -indefinite * mass.eigenvalues()[M.rows() - 1]) {
    throw Error(
        fmt::format("CMSSolve: M is indefinite: an eigenvalue of M_r is {:.1e} of its "
                    "largest; M must be positive semidefinite",
                    mass.eigenvalues()[0] / mass.eigenvalues()[M.rows() - 1]));
  }
  const MatrixXd R = zero_energy_motions(model, M);
  constexpr double three_digits = 1e-3;  // of a mass: the certificate tells of the others
  const mbs_export::Eigenmodes modes = mbs_export::eigenmodes(K, M, R, three_digits);
  FreeModel free;
  free.lambda.assign(modes.lambda.begin(), modes.lambda.end());
  free.X = SmallMatrix(model.K.n_rows, static_cast<PetscInt>(free.lambda.size()));
  std::ranges::copy(modes.X.reshaped(), free.X.values.begin());
  free.n_zero = static_cast<PetscInt>(R.cols());
  if (R.cols() > 0 && !free.lambda.empty()) {
    const MatrixXd energy = R.transpose() * K * R;
    free.rigid_residual = energy.diagonal().cwiseAbs().maxCoeff() / free.lambda.front();
  }
  return free;
}

}  // namespace

FreeModel free_model_everywhere(const ReducedModel& model, MPI_Comm comm)
{
  FreeModel free;
  std::optional<std::string> complaint;
  if (petsc::rank(comm) == 0) {
    try {
      free = free_model(model);
    } catch (const Error& error) {
      complaint = error.what();
    }
  }
  agree_on(complaint, comm);
  auto k = static_cast<int>(free.lambda.size());
  MPI_Bcast(&k, 1, MPI_INT, 0, comm);
  MPI_Bcast(&free.n_zero, 1, MPIU_INT, 0, comm);
  MPI_Bcast(&free.rigid_residual, 1, MPI_DOUBLE, 0, comm);
  free.lambda.resize(k);
  if (petsc::rank(comm) != 0) free.X = SmallMatrix(model.K.n_rows, k);
  MPI_Bcast(free.lambda.data(), k, MPI_DOUBLE, 0, comm);
  broadcast_numbers(free.X.values, comm);
  return free;
}

ReducedPairs certified_pairs(const FreeModel& free, const Settings& settings,
                             const ReducedModel& model)
{
  std::size_t k = certified_of_guyan;
  if (settings.options.tolerance || !model.omega.empty()) {
    const double omega = settings.options.tolerance ? two_pi * settings.options.tolerance->up_to_Hz
                                                    : model.omega.back();
    // Copies of the last eigenvalue belong to the range whatever round-off makes of them.
    constexpr double same_value = 1e-9;
    k = std::ranges::upper_bound(free.lambda, omega * omega * (1.0 + same_value)) -
        free.lambda.begin();
    k = std::clamp<std::size_t>(k, 1, settings.options.tolerance ? k + 1 : most_certified);
  }
  k = std::min(k, free.lambda.size());
  ReducedPairs pairs{.X = {free.X.n_rows, static_cast<PetscInt>(k)},
                     .lambda = {free.lambda.begin(), free.lambda.begin() + k}};
  std::copy_n(free.X.values.begin(), pairs.X.values.size(), pairs.X.values.begin());
  return pairs;
}

}  // namespace chladni::reduce::plugin
