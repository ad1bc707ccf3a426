#include "reduce/tolerance_search.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/told_apart.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/progress.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

constexpr PetscInt n_at_first = 48;
constexpr double pair_gap = 1e-4;    // of frequencies: partners stay together
constexpr double same_value = 1e-8;  // of frequencies of converged modes

/// Whether `before` are the first values of `now`: a partner that a search finds late shifts them.
bool begins_with(const std::vector<double>& now, const std::vector<double>& before)
{
  for (std::size_t i = 0; i < before.size(); ++i)
    if (std::abs(now[i] - before[i]) > same_value * before[i]) return false;
  return true;
}

}  // namespace

ToleranceSearch::ToleranceSearch(const GrowingModel::System& system, const ToleranceGoal& goal,
                                 PairsOf pairs_in_range, MemoryCheck require_memory)
    : system_(system),
      goal_(goal),
      pairs_in_range_(std::move(pairs_in_range)),
      search_(system.K_ss, system.M.ss, std::move(require_memory)),
      n_asked_(n_at_first)
{}

/// Modes that are found together with all their partners.
PetscInt ToleranceSearch::n_complete() const
{
  const std::vector<double>& omega = search_.omega();
  const auto n_all = static_cast<PetscInt>(omega.size());
  if (search_.has_all()) return n_all;
  for (PetscInt n = n_all - 1; n > 0; --n)
    if (omega[n] - omega[n - 1] > pair_gap * omega[n]) return n;
  return n_all;
}

void ToleranceSearch::find_modes()
{
  search_.find(std::min(n_asked_, search_.n_slaves()));
  const std::vector<double>& omega = search_.omega();
  PetscInt n = n_complete();
  if (model_ && n <= model_->n_modes()) n = static_cast<PetscInt>(omega.size());  // no others
  if (model_ && n <= model_->n_modes() && error(n) <= goal_.tolerance) {
    throw Error(fmt::format(
        "with all {} fixed-interface modes that converge a frequency of the range may be "
        "missing: M is nearly singular, or masses differ too much; lower the range",
        n));
  }
  if (model_ && n <= model_->n_modes()) {
    const auto [reached, asked] = told_apart(error(n), goal_.tolerance);
    throw Error(
        fmt::format("with all {} fixed-interface modes that there are the estimated error is {}, "
                    "above the tolerance {}; raise the tolerance",
                    n, reached, asked));
  }
  if (model_ && !begins_with(omega, model_->omega())) model_.reset();
  if (!model_) model_.emplace(system_);
  const PetscInt n_before = model_->n_modes();
  model_->append(search_.shapes(n_before, n), {omega.begin() + n_before, omega.begin() + n});
}

double ToleranceSearch::error(PetscInt n) const
{
  const ReducedPairs pairs = pairs_in_range_(model_->model(n));
  std::vector<double> errors = model_->error_estimates(pairs, n);
  const double last = n > 0 ? model_->omega()[n - 1] : 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double of_frequency = frequency_error(errors[i], pairs.lambda[i], last * last);
    const double Hz = std::sqrt(pairs.lambda[i]) / (2.0 * std::numbers::pi);
    errors[i] = Hz * (1.0 - of_frequency) > goal_.up_to_Hz ? 0.0 : of_frequency;
  }
  const double largest = errors.empty() ? 0.0 : std::ranges::max(errors);
  return linear::value_of_first_rank(largest, petsc::communicator(system_.Psi));
}

/// Of the first mode beyond the first n, or less.
double ToleranceSearch::lambda_left_out(PetscInt n) const
{
  const std::vector<double>& omega = search_.omega();
  if (n < std::ssize(omega)) return omega[n] * omega[n];
  return search_.has_all() ? search_.unresolved_from() : omega.back() * omega.back();
}

/// Whether a frequency of the FE model in the range may have no counterpart in the reduced model
/// within the tolerance. Ritz value i has one if the FE model has no more than i eigenvalues below
/// the Ritz value less the tolerance; a Ritz value near to an eigenvalue of another number does
/// not. From the highest down to where none is missing at all.
bool ToleranceSearch::may_lack_a_frequency(PetscInt n) const
{
  const double sigma = std::pow(2.0 * std::numbers::pi * goal_.up_to_Hz, 2);
  const double tolerable = std::pow(1.0 + goal_.tolerance, 2);
  const double left_out = lambda_left_out(n);
  if (left_out <= sigma) return true;
  const std::vector<double> ritz = pairs_in_range_(model_->model(n)).lambda;
  const auto n_up_to = [](const std::vector<double>& lambda, double end) {
    return std::ranges::upper_bound(lambda, end) - lambda.begin();
  };
  const auto at_most = [&](double end) {
    return n_up_to(pairs_in_range_(model_->heavier_model(n, end, left_out)).lambda, end);
  };
  const auto lacks = [&] {
    std::ptrdiff_t i = n_up_to(ritz, sigma * tolerable);
    double end = sigma;
    for (std::ptrdiff_t most = at_most(end); most > n_up_to(ritz, end); most = at_most(end)) {
      if (most > i) return true;
      end = std::min(end, ritz[std::size_t(--i)] / tolerable);
    }
    return false;
  };
  return linear::value_of_first_rank(lacks() ? 1.0 : 0.0, petsc::communicator(system_.Psi)) != 0.0;
}

/// Of the modes at hand, those of the range.
PetscInt ToleranceSearch::n_in_range() const
{
  const std::vector<double>& omega = model_->omega();
  const double last = 2.0 * std::numbers::pi * goal_.up_to_Hz;
  return static_cast<PetscInt>(std::ranges::upper_bound(omega, last) - omega.begin());
}

/// Whether a mode beyond the range is at hand, or all that there are.
bool ToleranceSearch::covers_range() const
{
  return n_in_range() < model_->n_modes() || search_.has_all();
}

/// How many modes the range has, if their number grows with the frequency as in a plate.
PetscInt ToleranceSearch::more_of_range() const
{
  const PetscInt n = model_->n_modes();
  const double predicted =
      1.1 * n * 2.0 * std::numbers::pi * goal_.up_to_Hz / model_->omega().back();
  return static_cast<PetscInt>(std::clamp(predicted, 1.15 * n, 3.0 * n)) + 1;
}

bool ToleranceSearch::is_enough()
{
  if (!covers_range()) {
    n_asked_ = more_of_range();
    return false;
  }
  search_.require_resolved(std::pow(2.0 * std::numbers::pi * goal_.up_to_Hz, 2));
  const double last_error = error(model_->n_modes());
  if (last_error > goal_.tolerance) {
    too_few_.push_back({.n = model_->n_modes(), .error = last_error});
    n_asked_ = prediction();
    return false;
  }
  if (may_lack_a_frequency(model_->n_modes())) {
    n_asked_ = model_->n_modes() + model_->n_modes() / 4 + 1;
    return false;
  }
  n_enough_ = search_.complete_cluster(least());
  return true;
}

/// By bisection to 1 % or one mode, not below the modes of the range.
PetscInt ToleranceSearch::least() const
{
  const PetscInt all = model_->n_modes();
  const PetscInt too_few = std::max(too_few_.empty() ? 0 : too_few_.back().n, n_in_range() - 1);
  const PetscInt n = std::max<PetscInt>(
      1, bisected(too_few, all, [&](PetscInt k) { return error(k) <= goal_.tolerance; }));
  if (!may_lack_a_frequency(n)) return n;
  return bisected(n, all, [&](PetscInt k) { return !may_lack_a_frequency(k); });
}

PetscInt ToleranceSearch::bisected(PetscInt too_few, PetscInt enough,
                                   const std::function<bool(PetscInt)>& is_enough) const
{
  while (enough - too_few > std::max<PetscInt>(1, enough / 100)) {
    const PetscInt n = (enough + too_few) / 2;
    (is_enough(n) ? enough : too_few) = n;
  }
  return enough;
}

/// A number of modes that keeps the tolerance if the error goes on to fall as a power of it, from
/// the errors with all modes and with half of them or less: over less the error falls in jumps.
/// Between 1.15 and 1.5 times as many for the same reason, or twice where that is far from enough.
PetscInt ToleranceSearch::prediction() const
{
  const Tried last = too_few_.back();
  const PetscInt n = last.n;
  const auto before = std::find_if(too_few_.rbegin(), too_few_.rend(),
                                   [&](const Tried& t) { return 2 * t.n <= n; });
  const Tried half = before != too_few_.rend() ? *before : Tried{.n = n / 2, .error = error(n / 2)};
  const double fallen = std::log(half.error / last.error) / std::log(double(n) / half.n);
  const double power = std::max(0.5, fallen);
  const double predicted = 1.1 * n * std::pow(last.error / goal_.tolerance, 1.0 / power);
  const double most = predicted > 3.0 * n ? 2.0 : 1.5;
  return static_cast<PetscInt>(std::clamp(predicted, 1.15 * n, most * n)) + 1;
}

namespace {

constexpr PetscInt solved_columns = 64;  // of the solves: bounds the memory

/// B_j = M_ss (Psi - Phi P)_j + M_sm,j of columns first .. last - 1.
petsc::Matrix deflated_inertia(const GrowingModel::System& system, Mat Phi, const MatrixXd& P,
                               PetscInt first)
{
  const PetscInt last = first + static_cast<PetscInt>(P.cols());
  petsc::Matrix shape, B = linear::uninitialized_dense(system.M.ss, P.cols());
  petsc::check(
      MatDuplicate(linear::ColumnRange(system.Psi, first, last), MAT_COPY_VALUES, shape.put()));
  linear::add_product(-1.0, Phi, P, shape);
  linear::SparseProduct(system.M.ss).apply(shape, B);
  PetscInt first_row = 0;
  PetscScalar* values = nullptr;
  petsc::check(MatGetOwnershipRange(B, &first_row, nullptr));
  petsc::check(MatDenseGetArray(B, &values));
  const PetscInt n_local = linear::LocalRows(shape).n_rows();
  linear::for_local_entries(system.M.sm, [&](PetscInt row, PetscInt column, double value) {
    if (column < first || column >= last) return;
    values[row - first_row + std::size_t(column - first) * n_local] += value;
  });
  petsc::check(MatDenseRestoreArray(B, &values));
  return B;
}

}  // namespace

GrowingModel::GrowingModel(const System& system)
    : system_(system),
      K_G_(guyan_stiffness(system.Psi, system.K, system.M)),
      M_G_(guyan_mass(system.Psi, system.M)),
      P_(0, M_G_.rows())
{}

/// G = (Psi - Phi P)^T M_ss Z + M_ms Z with Z = K_ss^-1 (M_ss (Psi - Phi P) + M_sm): symmetric, its
/// upper triangle is computed.
void GrowingModel::start_errors(Mat Phi)
{
  const auto n_m = static_cast<PetscInt>(M_G_.rows());
  n_first_ = static_cast<PetscInt>(P_.rows());
  G_ = MatrixXd::Zero(n_m, n_m);
  for (PetscInt first = 0; first < n_m; first += solved_columns) {
    linear::report_progress(double(first) / n_m);
    const PetscInt last = std::min(first + solved_columns, n_m);
    const MatrixXd P = P_.middleCols(first, last - first);
    const petsc::Matrix B = deflated_inertia(system_, Phi, P, first);
    const petsc::Matrix Z = linear::uninitialized_dense(system_.M.ss, last - first);
    petsc::check(MatMatSolve(system_.K_ss.factor(), B, Z));
    const petsc::Matrix MZ = linear::uninitialized_dense(system_.M.ss, last - first);
    linear::SparseProduct(system_.M.ss).apply(Z, MZ);
    const MatrixXd Psi_MZ = linear::inner_product(linear::ColumnRange(system_.Psi, 0, last), MZ);
    const MatrixXd Phi_MZ = linear::inner_product(Phi, MZ);
    const MatrixXd Z_M_sm = linear::inner_product_sparse(Z, system_.M.sm);
    for (PetscInt j = first; j < last; ++j) {
      for (PetscInt i = 0; i <= j; ++i) {
        double deflation = 0.0;
        for (PetscInt k = 0; k < n_first_; ++k) deflation += P_(k, i) * Phi_MZ(k, j - first);
        G_(i, j) = G_(j, i) = Psi_MZ(i, j - first) - deflation + Z_M_sm(j - first, i);
      }
    }
  }
}

void GrowingModel::append(Mat Phi, const std::vector<double>& omega)
{
  const bool is_first = omega_.empty();
  P_ = linear::stacked(P_, inertial_coupling(Phi, system_.Psi, system_.M));
  omega_.insert(omega_.end(), omega.begin(), omega.end());
  if (is_first) start_errors(Phi);
}

ReducedModel GrowingModel::model(PetscInt n) const
{
  return join(K_G_, M_G_, P_, {omega_.begin(), omega_.begin() + n});
}

/// G_n
MatrixXd GrowingModel::G(PetscInt n) const
{
  MatrixXd G_n = G_;
  const double sign = n > n_first_ ? -1.0 : 1.0;
  for (PetscInt k = std::min(n, n_first_); k < std::max(n, n_first_); ++k) {
    const double factor = sign / (omega_[k] * omega_[k]);
    for (PetscInt j = 0; j < G_n.cols(); ++j)
      for (PetscInt i = 0; i < G_n.rows(); ++i) G_n(i, j) += factor * P_(k, i) * P_(k, j);
  }
  return G_n;
}

ReducedModel GrowingModel::heavier_model(PetscInt n, double sigma, double lambda_left_out) const
{
  ReducedModel heavier = model(n);
  const MatrixXd G_n = G(n);
  const double factor = sigma / (1.0 - sigma / lambda_left_out);
  heavier.M.topLeftCorner(G_n.rows(), G_n.cols()) += factor * G_n;
  return heavier;
}

std::vector<double> GrowingModel::error_estimates(const ReducedPairs& pairs, PetscInt n) const
{
  const Eigen::Index n_m = M_G_.rows();
  std::vector<double> eta2;
  for (PetscInt j = 0; j < pairs.X.cols(); ++j) {
    double sum = 0.0;
    for (PetscInt c = 0; c < n_m; ++c)
      for (PetscInt r = 0; r < n_m; ++r) sum += pairs.X(r, j) * G_(r, c) * pairs.X(c, j);
    for (PetscInt k = std::min(n, n_first_); k < std::max(n, n_first_); ++k) {
      double P_x = 0.0;
      for (PetscInt i = 0; i < n_m; ++i) P_x += P_(k, i) * pairs.X(i, j);
      sum += (n > n_first_ ? -1.0 : 1.0) * P_x * P_x / (omega_[k] * omega_[k]);
    }
    eta2.push_back(std::max(0.0, pairs.lambda[j] * sum));
  }
  return eta2;
}

}  // namespace chladni::reduce
