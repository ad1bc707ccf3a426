#include "reduce/response_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "common/all_ranks.hpp"
#include "common/eigen_every.hpp"
#include "common/told_apart.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "reduce/residual_forms.hpp"
#include "reduce/support.hpp"
#include "reduce/unbalanced_forces.hpp"

namespace chladni::reduce {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// X = (K_r - Omega^2 M_r)^-1 F with some masters held, or still anyway.
MatrixXd reduced_responses(const ReducedModel& model, const MatrixXd& F, double Omega,
                           const std::vector<int>& held)
{
  MatrixXd X = MatrixXd::Zero(model.K.rows(), F.cols());
  const std::vector<int> free = all_but(held, model.K.rows());
  const MatrixXd A = model.K(free, free) - Omega * Omega * model.M(free, free);
  MatrixXd all = MatrixXd::Zero(model.K.rows(), F.cols());
  all.topRows(F.rows()) = F;
  const MatrixXd loads = all(free, every);
  MatrixXd of_free = MatrixXd::Zero(loads.rows(), loads.cols());
  for (const std::vector<Index>& set : linear::decoupled_coordinates(A, A)) {
    const MatrixXd of_set = loads(set, every);
    if (!of_set.isZero(0.0)) of_free(set, every) = linear::solution(A(set, set), of_set);
  }
  X(free, every) = of_free;
  return X;
}

/// A matrix of the first rank on all ranks.
void broadcast(MatrixXd& A, MPI_Comm comm)
{
  std::array<Index, 2> size{A.rows(), A.cols()};
  MPI_Bcast(size.data(), 2 * sizeof(Index), MPI_BYTE, 0, comm);
  A.conservativeResize(size[0], size[1]);
  linear::broadcast_numbers(linear::values_of(A), comm);
}

/// Without what couples masters and modes by round-off: modes of the whole body have a share of it
/// in all its parts.
MatrixXd coupling(const MatrixXd& A, Index n_masters)
{
  constexpr double weak = 1e-10;
  const VectorXd root = A.diagonal().cwiseAbs().cwiseSqrt();
  const MatrixXd least = weak * root * root.transpose();
  MatrixXd clear = (A.array().abs() > least.array()).select(A, 0.0);
  clear.topLeftCorner(n_masters, n_masters) = A.topLeftCorner(n_masters, n_masters);
  return clear;
}

/// The masters that no load moves, ascending: those that are held, and those that are not coupled
/// to a loaded one, as motion in the plane to bending.
std::vector<int> still_masters(const ReducedModel& model, const MatrixXd& F,
                               const std::vector<int>& held, MPI_Comm comm)
{
  std::vector<int> moves(std::size_t(model.n_masters), 0);
  for (const auto& set : linear::decoupled_coordinates(coupling(model.K, model.n_masters),
                                                       coupling(model.M, model.n_masters))) {
    const bool is_loaded = std::ranges::any_of(
        set, [&](Index i) { return i < F.rows() && (F.row(i).array() != 0.0).any(); });
    for (const Index i : set)
      if (is_loaded && i < model.n_masters) moves[std::size_t(i)] = 1;
  }
  for (const int i : held) moves[std::size_t(i)] = 0;
  MPI_Bcast(moves.data(), model.n_masters, MPI_INT, 0, comm);
  std::vector<int> still;
  for (int i = 0; i < model.n_masters; ++i)
    if (moves[std::size_t(i)] == 0) still.push_back(i);
  return still;
}

/// How many of the errors, ascending, are to go: those above three tenths of what is allowed, or of
/// the largest where all are allowed; the two of a pair of a round body, which differ by its mesh,
/// together.
Index n_to_remove(const VectorXd& errors)
{
  constexpr double share = 0.3, same = 0.95;
  const double limit = share * std::min(1.0, errors.maxCoeff());
  Index first = errors.size();
  while (first > 0 && errors[first - 1] > limit) --first;
  const bool divides_pair =
      first > 0 && first < errors.size() && errors[first - 1] > same * errors[first];
  return errors.size() - (divides_pair ? first - 1 : first);
}

/// The combinations of loads whose errors are to go, such that the shapes of their residuals are
/// K-orthonormal.
/// @param allowed  [l] errors
MatrixXd combinations_above(const MatrixXd& G, const VectorXd& allowed, double c)
{
  const VectorXd unit = allowed.cwiseSqrt().cwiseInverse();
  const MatrixXd relative = unit.asDiagonal() * G * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> errors(relative);
  const Index n = n_to_remove(c * errors.eigenvalues());
  const VectorXd lengths = errors.eigenvalues().tail(n).cwiseSqrt();
  return unit.asDiagonal() * errors.eigenvectors().rightCols(n) *
         lengths.cwiseInverse().asDiagonal();
}

/// 1 / (1 - Omega^2 / lambda): how much the dynamic stiffness of what is left out may be below the
/// static one.
double softening(double Omega, double lambda_left_out)
{
  return 1.0 / (1.0 - Omega * Omega / lambda_left_out);
}

void require_modes_of_range(double Omega, double lambda_left_out)
{
  if (Omega * Omega < lambda_left_out) return;
  constexpr double two_pi = 2.0 * std::numbers::pi;
  const auto [left_out_Hz, up_to_Hz] =
      told_apart(std::sqrt(lambda_left_out) / two_pi, Omega / two_pi, 6);
  throw Error(fmt::format(
      "responses up to {} Hz need the modes of that range, and the first one left out is at {} Hz; "
      "take more modes, or a tolerance with its range in [reduce]",
      up_to_Hz, left_out_Hz));
}

/// Where a model is furthest from the goal.
struct Worst {
  double error = -1.0;  ///< bound over size
  double Omega = 0.0;   ///< rad/s, in the middle of the band
  MatrixXd motions;     ///< whose residual forces make most of the error there
};

/// Of all bands.
Worst worst_of(const LoadedModel& of, const ResponseLoads& loads, double tolerance)
{
  const UnbalancedForces forces(of, loads.F);
  Worst worst;
  Index g_worst = 0;
  for (Index g = 0; g < loads.size.cols(); ++g) {
    const double error = forces
                             .error_bounds({.from = loads.Omega[g],
                                            .to = loads.Omega[g + 1],
                                            .loss_factor = loads.loss_factor})
                             .cwiseQuotient(loads.size.col(g))
                             .maxCoeff();
    if (error <= worst.error) continue;
    worst.error = error;
    g_worst = g;
  }
  if (worst.error <= tolerance) return worst;
  worst.Omega = 0.5 * (loads.Omega[g_worst] + loads.Omega[g_worst + 1]);
  const MatrixXd X = reduced_responses(of.model, loads.F, worst.Omega, of.still);
  worst.motions =
      linear::product(X, combinations_above(of.forms.energy(X, worst.Omega * worst.Omega),
                                            tolerance * loads.size.col(g_worst),
                                            softening(worst.Omega, of.lambda_left_out)));
  return worst;
}

/// Of the first rank on all ranks.
void broadcast(Worst& worst, MPI_Comm comm)
{
  std::array<double, 2> numbers{worst.error, worst.Omega};
  MPI_Bcast(numbers.data(), 2, MPI_DOUBLE, 0, comm);
  worst.error = numbers[0];
  worst.Omega = numbers[1];
  broadcast(worst.motions, comm);
}

}  // namespace

ResponseCertificate keep_responses(const WholeSystem& body, const RespondingModel& made,
                                   const std::vector<int>& held, double lambda_left_out,
                                   const ResponseGoal& goal)
{
  constexpr int most_rounds = 12;
  constexpr double falls = 0.9;  // in two rounds, or round-off has it
  require_modes_of_range(goal.Omega, lambda_left_out);
  const MPI_Comm comm = petsc::communicator(body.K_blocks.ss);
  ResponseLoads loads;
  on_first_rank(comm, [&] { loads = goal.loads(made.model); });
  MatrixXd F = loads.F;
  broadcast(F, comm);
  const std::vector<int> still = still_masters(made.model, F, held, comm);
  ResidualForms forms({.K_ss = body.K_ss,
                       .K = body.K_blocks,
                       .M = body.M_blocks,
                       .Q_CB = made.Q_CB,
                       .model = made.model,
                       .moving = all_but(still, made.model.n_masters)});
  const LoadedModel loaded{.forms = forms,
                           .model = made.model,
                           .still = still,
                           .lambda_left_out = lambda_left_out,
                           .lambda_of_range = goal.Omega * goal.Omega};
  std::array<double, 2> before{std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};
  for (int round = 0;; ++round) {
    Worst worst;
    on_first_rank(comm, [&] {
      if (round > 0) loads = goal.loads(made.model);  // sizes are those of the model as it is
      worst = worst_of(loaded, loads, goal.tolerance);
    });
    broadcast(worst, comm);
    const bool is_stuck = !(worst.error < falls * std::exchange(before[round % 2], worst.error));
    if (worst.error <= goal.tolerance || is_stuck || round == most_rounds) {
      if (round > 0) forms.make_ritz();
      return {.Omega = goal.Omega, .error = worst.error};
    }
    forms.append(forms.shapes(worst.motions, worst.Omega * worst.Omega));
  }
}

}  // namespace chladni::reduce
