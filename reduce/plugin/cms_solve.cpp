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
#include "reduce/tolerance_search.hpp"

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

/// The modes that get an error: up to the range of the tolerance, or else up to the last
/// fixed-interface mode, not too many.
ReducedPairs certified_pairs(const FreeModel& free, const Settings& settings,
                             const ReducedModel& model)
{
  std::size_t k = certified_of_guyan;
  if (settings.options.tolerance || !model.omega.empty()) {
    const double omega = settings.options.tolerance ? two_pi * settings.options.tolerance->up_to_Hz
                                                    : model.omega.back();
    k = std::ranges::upper_bound(free.lambda, omega * omega) - free.lambda.begin();
    k = std::clamp<std::size_t>(k, 1, settings.options.tolerance ? k + 1 : most_certified);
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

/// The modes that the user wants, with nothing for Guyan.
std::optional<FixedInterfaceModes> modes_as_told(CMS cms)
{
  const SetUp& set_up = *cms->inside->set_up;
  const ReduceOptions& wanted = cms->inside->settings.options;
  if (wanted.method == Method::guyan) return std::nullopt;
  Phase phase(cms, events.modes, "fixed-interface modes");
  FixedInterfaceModes modes = fixed_interface_modes(set_up.K_ss, set_up.M_blocks.ss, wanted);
  phase.done();
  return modes;
}

/// As few modes as keep the tolerance.
FixedInterfaceModes modes_to_tolerance(CMS cms, Mat Psi)
{
  const SetUp& set_up = *cms->inside->set_up;
  const Settings& settings = cms->inside->settings;
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(cms));
  // What the estimates from the small matrices and those from the full ones may differ by.
  constexpr double margin = 0.99;
  ToleranceSearch search(
      {.K_ss = set_up.K_ss, .Psi = Psi, .K = set_up.K_blocks, .M = set_up.M_blocks},
      margin * settings.options.tolerance->tolerance, [&](const ReducedModel& model) {
        return certified_pairs(free_model_everywhere(model, comm), settings, model);
      });
  for (bool enough = false; !enough;) {
    Phase finding(cms, events.modes, "fixed-interface modes");
    search.find_modes();
    finding.done();
    Phase choosing(cms, events.errors, "choice of modes");
    enough = search.is_enough();
    choosing.done();
  }
  return search.modes();
}

/// The projection on a basis, with errors of its free modes.
Result reduced(CMS cms, CraigBamptonBasis Q_CB)
{
  const SetUp& set_up = *cms->inside->set_up;
  Result result{.Q_CB = std::move(Q_CB),
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
  CraigBamptonBasis Q_CB{.Psi = {}, .modes = {}};
  if (settings.options.tolerance && settings.options.method == Method::craig_bampton) {
    Q_CB.Psi = timed_constraint_modes(cms);
    Q_CB.modes = modes_to_tolerance(cms, Q_CB.Psi);
  } else {
    // The modes first: the subspace of the eigen-solve is as large as the constraint modes.
    Q_CB.modes = modes_as_told(cms);
    Q_CB.Psi = timed_constraint_modes(cms);
  }
  Result result = reduced(cms, std::move(Q_CB));
  result.quality.condition = condition_estimate(cms->inside->set_up->K_ss);
  if (settings.sylvester) count(cms, result);
  return result;
}

}  // namespace chladni::reduce::plugin
