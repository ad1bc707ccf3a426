// CMSSolve: basis, projection, errors, count.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mbs_export/eigenmodes.hpp"
#include "reduce/completeness.hpp"
#include "reduce/plugin/check_operators.hpp"
#include "reduce/plugin/cms_impl.hpp"
#include "reduce/plugin/guard.hpp"
#include "reduce/sylvester.hpp"

namespace chladni::reduce::plugin {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr std::size_t most_certified = 100;  // bounds the block solve of the error estimates
constexpr std::size_t certified_of_guyan = 20;
constexpr double zero_energy = 1e-10;  // of the largest eigenvalue of K_r with unit diagonal
constexpr double indefinite = 1e-8;

MatrixXd as_eigen(const SmallMatrix& A)
{
  return Eigen::Map<const MatrixXd>(A.values.data(), A.n_rows, A.n_cols);
}

/// M_r-orthonormal motions that K_r does not resist, found with unit diagonal so that units do not
/// decide.
MatrixXd zero_energy_motions(const MatrixXd& K, const MatrixXd& M)
{
  const VectorXd scale =
      (K.diagonal().array() > 0.0).select(K.diagonal().array().rsqrt(), 1.0).matrix();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scale.asDiagonal() * K * scale.asDiagonal());
  const VectorXd& energy = solver.eigenvalues();
  const double largest = energy[energy.size() - 1];
  if (energy[0] < -indefinite * largest) {
    throw Error(
        fmt::format("CMSSolve: K is indefinite: an eigenvalue of K_r is {:.1e} of its "
                    "largest; K must be positive semidefinite",
                    energy[0] / largest));
  }
  const Index r = (energy.array() <= zero_energy * largest).count();
  if (r == 0) return MatrixXd(K.rows(), 0);
  const MatrixXd Z = scale.asDiagonal() * solver.eigenvectors().leftCols(r);
  const Eigen::LLT<MatrixXd> mass(Z.transpose() * M * Z);
  if (mass.info() != Eigen::Success) {
    throw Error("CMSSolve: a motion has neither stiffness nor mass; the pencil (K, M) is singular");
  }
  return mass.matrixL().solve(Z.transpose()).transpose();
}

/// All modes of the reduced model with free masters.
struct FreeModel {
  SmallMatrix X{0, 0};  ///< elastic modes
  std::vector<double> lambda;
  PetscInt n_zero = 0;
  double rigid_residual = 0.0;
};

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
  const MatrixXd R = zero_energy_motions(K, M);
  const mbs_export::Eigenmodes modes = mbs_export::eigenmodes(K, M, R);
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

/// Solved on the first rank, so that ranks cannot differ by round-off; the same everywhere.
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
  agree(comm, complaint);
  auto k = static_cast<int>(free.lambda.size());
  MPI_Bcast(&k, 1, MPI_INT, 0, comm);
  MPI_Bcast(&free.n_zero, 1, MPIU_INT, 0, comm);
  MPI_Bcast(&free.rigid_residual, 1, MPI_DOUBLE, 0, comm);
  free.lambda.resize(k);
  if (petsc::rank(comm) != 0) free.X = SmallMatrix(model.K.n_rows, k);
  MPI_Bcast(free.lambda.data(), k, MPI_DOUBLE, 0, comm);
  MPI_Bcast(free.X.values.data(), static_cast<int>(free.X.values.size()), MPI_DOUBLE, 0, comm);
  return free;
}

/// The modes up to lambda_max.
ReducedPairs certified_pairs(const FreeModel& free, const Settings& settings,
                             const ReducedModel& model)
{
  std::size_t k = certified_of_guyan;
  if (settings.options.tolerance || !model.omega.empty()) {
    const double omega = settings.options.tolerance ? two_pi * settings.options.tolerance->up_to_Hz
                                                    : model.omega.back();
    k = std::ranges::upper_bound(free.lambda, omega * omega) - free.lambda.begin();
    k = std::clamp<std::size_t>(k, 1, most_certified);
  }
  k = std::min(k, free.lambda.size());
  ReducedPairs pairs{.X = {free.X.n_rows, static_cast<PetscInt>(k)},
                     .lambda = {free.lambda.begin(), free.lambda.begin() + k}};
  std::copy_n(free.X.values.begin(), pairs.X.values.size(), pairs.X.values.begin());
  return pairs;
}

CMSCount as_count(const EigenvalueCount& count)
{
  return {.upto = std::sqrt(count.sigma) / two_pi,
          .expected = count.expected,
          .found = count.found,
          .missing = count.missing()};
}

/// The basis with the modes that `wanted` says, projected, with errors of its free modes.
Result reduced(CMS cms, petsc::Matrix Psi, const ReduceOptions& wanted)
{
  const SetUp& set_up = *cms->inside->set_up;
  Result result{.Q_CB = {.Psi = std::move(Psi), .modes = {}},
                .model = {.K = {0, 0}, .M = {0, 0}, .n_masters = 0, .omega = {}},
                .lambda = {},
                .f_Hz = {},
                .eta2 = {},
                .bounds = {},
                .quality = {},
                .K_r = {},
                .M_r = {},
                .C_r = {},
                .T = {}};
  if (wanted.method == Method::craig_bampton) {
    Phase phase(cms, events.modes, "fixed-interface modes");
    result.Q_CB.modes = fixed_interface_modes(set_up.K_ss, set_up.M_blocks.ss, wanted);
    phase.done();
  }
  {
    Phase phase(cms, events.project, "projection");
    result.model = project(result.Q_CB, set_up.K_blocks, set_up.M_blocks);
    phase.done();
  }
  Phase phase(cms, events.errors, "error estimates");
  const FreeModel free =
      free_model_everywhere(result.model, PetscObjectComm(reinterpret_cast<PetscObject>(cms)));
  const ReducedPairs pairs = certified_pairs(free, cms->inside->settings, result.model);
  if (!pairs.lambda.empty()) {
    result.eta2 = error_estimates(set_up.K_ss, result.Q_CB, set_up.M_blocks, pairs);
  }
  for (const double lambda : pairs.lambda) result.f_Hz.push_back(std::sqrt(lambda) / two_pi);
  result.lambda = free.lambda;
  result.quality.n_zero = free.n_zero;
  result.quality.rigid_residual = free.rigid_residual;
  phase.done();
  return result;
}

/// Half as many modes more until the errors keep the tolerance.
Result reduced_to_tolerance(CMS cms, petsc::Matrix Psi)
{
  const ModesByTolerance goal = *cms->inside->settings.options.tolerance;
  PetscInt n_s = 0;
  petsc::check(MatGetSize(Psi, &n_s, nullptr));
  for (int n_modes = std::min<int>(32, n_s);; n_modes = std::min<int>(n_modes + n_modes / 2, n_s)) {
    Result result = reduced(cms, std::move(Psi), {.modes = n_modes});
    const double error = result.eta2.empty() ? 0.0 : std::ranges::max(result.eta2);
    if (error <= goal.tolerance) return result;
    if (n_modes >= n_s) {
      throw Error(
          fmt::format("CMSSolve: with all {} modes eta^2 is {:.1e}, above -cms_tol {:.1e}; "
                      "raise the tolerance",
                      n_modes, error, goal.tolerance));
    }
    Psi = std::move(result.Q_CB.Psi);
  }
}

petsc::Matrix timed_constraint_modes(CMS cms)
{
  Phase phase(cms, events.constraint, "constraint modes");
  petsc::Matrix Psi = constraint_modes(cms->inside->set_up->K_ss, cms->inside->set_up->K_blocks);
  phase.done();
  return Psi;
}

/// Counts the fixed-interface modes up to the last one, and the free model in the certified range;
/// a complete count makes the error bounds rigorous.
void count(CMS cms, Result& result)
{
  Phase phase(cms, events.count, "count of eigenvalues");
  const SetUp& set_up = *cms->inside->set_up;
  if (!result.model.omega.empty()) {
    constexpr double half_a_pair_gap = 1e-4;  // of lambda: modes that close are never cut apart
    const double sigma = std::pow(result.model.omega.back(), 2) * (1.0 + half_a_pair_gap);
    const PetscInt n = eigenvalues_below(set_up.K_blocks.ss, set_up.M_blocks.ss, sigma);
    result.quality.modes = as_count(
        {.sigma = sigma, .expected = n, .found = static_cast<int>(result.model.omega.size())});
  }
  Completeness certified =
      count_modes({.lambda = result.lambda, .eta2 = result.eta2, .n_zero = result.quality.n_zero},
                  [&](double sigma) { return eigenvalues_below(set_up.K, set_up.M, sigma); });
  result.quality.model = as_count(certified.range);
  result.quality.complete = as_count(certified.complete);
  result.bounds = std::move(certified.bounds);
  phase.done();
}

}  // namespace

Result make_result(CMS cms)
{
  const Settings& settings = cms->inside->settings;
  petsc::Matrix Psi = timed_constraint_modes(cms);
  const bool by_tolerance =
      settings.options.tolerance && settings.options.method == Method::craig_bampton;
  Result result = by_tolerance ? reduced_to_tolerance(cms, std::move(Psi))
                               : reduced(cms, std::move(Psi), settings.options);
  result.quality.condition = condition_estimate(cms->inside->set_up->K_ss);
  if (settings.sylvester) count(cms, result);
  return result;
}

}  // namespace chladni::reduce::plugin
