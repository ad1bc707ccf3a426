// Spectrum slicing: all eigenvalues of an interval.
// 1. Cuts just outside the ends, between eigenvalues: factors of A - sigma B, whose negative pivots
//    count the eigenvalues below sigma (Sylvester).
// 2. A slice is an interval between cuts. A cut inside it halves it where it holds too many, and
//    comes closer to them where they are all on one side.
// 3. Block Lanczos with the factor of that cut finds as many pairs as were counted in the slice.
// Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228.
#include "plugin/eps_slices.hpp"

#include <petsc/private/matimpl.h>
#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "linear/cholesky/factorization.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/lanczos/block_iteration.hpp"
#include "plugin/eps_block_lanczos.hpp"
#include "plugin/eps_operator.hpp"

namespace chladni::plugin {

namespace {

/// A and B with the factor of A - sigma B, for one sigma after the other.
class ShiftedPencil {
 public:
  explicit ShiftedPencil(EPS eps) : A_(stiffness_of(eps)), B_(mass_of(eps))
  {
    linear::register_cholesky_types();
    KSP ksp = nullptr;
    const char* prefix = nullptr;
    petsc::check(STGetKSP(eps->st, &ksp));
    petsc::check(KSPGetOptionsPrefix(ksp, &prefix));
    petsc::check(KSPGetPC(ksp, &chosen_));
    source_ = {.database = ((PetscObject)eps)->options, .prefix = prefix ? prefix : ""};
  }

  Mat B() const { return B_; }
  PetscInt n_factors() const { return n_factors_; }

  /// @return whether there is a factor
  bool factorize(double sigma)
  {
    constexpr PetscInt most_room = 1000;
    if (sigma == 0.0) sigma = std::numeric_limits<double>::min();  // with the entries of B too
    set_matrix(linear::shifted(A_, B_, sigma));
    for (;; room_ *= 4) {
      if (solver_ == nullptr) make_solver();
      petsc::check(KSPSetOperators(solver_, S_, S_));
      petsc::check(KSPSetUp(solver_));
      ++n_factors_;
      MatFactorError error = MAT_FACTOR_NOERROR;
      petsc::check(MatFactorGetError(factor_, &error));
      if (error == MAT_FACTOR_NOERROR) return true;
      solver_ = {};  // what comes next begins anew
      factor_ = nullptr;
      if (error != MAT_FACTOR_OUTMEMORY) return false;
      if (room_ > most_room) break;  // MUMPS does not foresee the pivots that are put off
    }
    throw Error("blocklanczos: the factor of A - sigma B does not fit into the memory");
  }

  PetscInt n_below() const
  {
    PetscInt n = 0;
    if (factor_->ops->getinertia == nullptr) {
      MatSolverType package = nullptr;
      petsc::check(MatFactorGetSolverType(factor_, &package));
      throw Error(
          fmt::format("blocklanczos: -{}pc_factor_mat_solver_type {}: an interval needs a package "
                      "that counts negative pivots: supernodal, mumps-metis or mumps",
                      source_.prefix, package));
    }
    petsc::check(MatGetInertia(factor_, &n, nullptr, nullptr));
    return n;
  }

  linear::BlockOperator inverse() const
  {
    return [F = factor_](Mat, Mat BQ, Mat Y) { petsc::check(MatMatSolve(F, BQ, Y)); };
  }

  /// The largest A_ii / B_ii: round-off moves eigenvalues by eps times it.
  double stiffest() const
  {
    petsc::Vector a = linear::diagonal(A_);
    const petsc::Vector b = linear::diagonal(B_);
    PetscReal largest = 0.0;
    petsc::check(VecAbs(a));
    petsc::check(VecPointwiseDivide(a, a, b));  // 0 where B_ii is
    petsc::check(VecMax(a, nullptr, &largest));
    return largest;
  }

 private:
  void make_solver()
  {
    PC pc = nullptr;
    MatSolverType package = nullptr;
    solver_ = linear::new_solver(petsc::communicator(A_), source_);
    petsc::check(KSPSetType(solver_, KSPPREONLY));
    petsc::check(KSPGetPC(solver_, &pc));
    petsc::check(PCSetType(pc, PCCHOLESKY));
    petsc::check(PCFactorGetMatSolverType(chosen_, &package));
    petsc::check(PCFactorSetMatSolverType(pc, package ? package : linear::mumps_metis));
    petsc::check(KSPSetOperators(solver_, S_, S_));
    factor_ = linear::set_up_factor(pc, source_);
    petsc::check(MatFactorGetSolverType(factor_, &package));
    if (std::string_view(package) != MATSOLVERMUMPS) return;
    petsc::check(MatMumpsSetIcntl(factor_, 13, 1));  // else pivots of its last front do not count
    if (room_ > usual_room) petsc::check(MatMumpsSetIcntl(factor_, 14, room_));
  }

  void set_matrix(Mat shifted)
  {
    if (S_ == nullptr)
      petsc::check(MatDuplicate(shifted, MAT_COPY_VALUES, S_.put()));
    else
      petsc::check(MatCopy(shifted, S_, SAME_NONZERO_PATTERN));
    petsc::check(MatSetOption(S_, MAT_SYMMETRIC, PETSC_TRUE));
  }

  static constexpr PetscInt usual_room = 20;  // percent beyond MUMPS' forecast

  petsc::Matrix A_, B_, S_;
  PC chosen_ = nullptr;
  linear::OptionSource source_;
  petsc::LinearSolver solver_;
  Mat factor_ = nullptr;  ///< of the solver
  PetscInt room_ = usual_room;
  PetscInt n_factors_ = 0;
};

/// A place between eigenvalues, and the number of those below it.
struct Cut {
  double place;
  PetscInt n_below;
};

/// The interval between two cuts.
struct Slice {
  Cut low, high;
  /// The next cut is at this share of it, from the end towards which its eigenvalues are.
  double share = 0.5;
  bool is_from_high = false;

  double width() const { return high.place - low.place; }
  PetscInt size() const { return high.n_below - low.n_below; }
  double next_place() const
  {
    return is_from_high ? high.place - share * width() : low.place + share * width();
  }
};

/// A slice seen from a shift inside it.
struct Window {
  double sigma, low, high;

  bool has(double theta) const
  {
    const double lambda = sigma + 1.0 / theta;
    return lambda >= low && lambda <= high;
  }
  /// What is inside comes first, nearest to the shift.
  bool comes_before(double theta_a, double theta_b) const
  {
    if (has(theta_a) != has(theta_b)) return has(theta_a);
    return std::abs(theta_a) > std::abs(theta_b);
  }
  /// Whether the first Ritz pair behind n others is outside and shows its place: the sequence shows
  /// no more than these n.
  bool has_only(PetscInt n, const linear::BlockIteration& iteration) const
  {
    return n < iteration.n_vectors() && !has(iteration.theta(n)) &&
           iteration.residual(n) <= linear::resolved * std::abs(iteration.theta(n));
  }
};

class Slicing {
 public:
  Slicing(EPS eps, PetscInt block_size) : eps_(eps), block_size_(block_size), pencil_(eps)
  {
    constexpr double round_off = std::numeric_limits<double>::epsilon();
    const double width = eps->intb - eps->inta;
    const double largest = std::max(std::abs(eps->inta), std::abs(eps->intb));
    if (!(width > 1e-9 * largest)) {
      throw Error(
          fmt::format("blocklanczos: the interval {:.12g} .. {:.12g} is as narrow as the "
                      "round-off of its ends; give a wider one",
                      eps->inta, eps->intb));
    }
    blur_ = std::max(1e-12 * largest, 100.0 * round_off * pencil_.stiffest());
    margin_ = std::clamp(10.0 * blur_, 1e-6 * width, 1e-3 * width);
    blur_ = std::min(blur_, 0.1 * margin_);
  }

  IntervalPairs all();

 private:
  Cut cut(double place, double step, double clearance);
  Cut inner_cut(const Slice& slice);
  double distance_to_nearest();
  std::vector<Slice> halves(const Slice& slice, const Cut& middle) const;
  std::optional<Slice> closer(const Slice& slice, const Cut& middle) const;
  void treat(const Slice& slice);
  bool collect(const Slice& slice, double sigma);
  void keep(const Slice& slice, double sigma, const linear::BlockIteration& iteration,
            const linear::BlockOperator& op);
  PetscInt n_converged(const Window& window, PetscInt n, const linear::BlockIteration& iteration);
  [[noreturn]] static void refuse_count(const Slice& slice, PetscInt n_found);
  void monitor(PetscInt n_converged);

  EPS eps_;
  PetscInt block_size_;
  ShiftedPencil pencil_;
  double blur_;    ///< by which round-off moves eigenvalues, at most
  double margin_;  ///< distance of cuts from eigenvalues, at least
  std::vector<Slice> open_;
  IntervalPairs found_{};
};

/// An upper bound of the distance of the last shift to the nearest eigenvalue, which is close where
/// the distance is small: a few block steps show 1 / distance.
double Slicing::distance_to_nearest()
{
  constexpr PetscInt width = 2, n_steps = 3;
  const linear::BlockOperator op = pencil_.inverse();
  linear::BlockIteration probe(pencil_.B(), width, (n_steps + 1) * width);
  probe.start(op);
  for (PetscInt i = 0; i < n_steps && !probe.is_exhausted() && !probe.is_full(); ++i)
    probe.step(op);
  probe.order_ritz_values([](double a, double b) { return std::abs(a) > std::abs(b); });
  return 1.0 / std::abs(probe.theta(0));
}

/// At the place, or some steps further, where no eigenvalue is within the clearance. What is asked
/// of it becomes less with each step.
Cut Slicing::cut(double place, double step, double clearance)
{
  constexpr int most = 24;
  for (int i = 0; i < most; ++i) {
    if (pencil_.factorize(place) && distance_to_nearest() > clearance) {
      const Cut cut{.place = place, .n_below = pencil_.n_below()};
      petsc::check(
          PetscInfo(eps_, "%" PetscInt_FMT " eigenvalues below %.12g\n", cut.n_below, place));
      return cut;
    }
    petsc::check(PetscInfo(eps_, "an eigenvalue is too close to %.12g: the cut moves\n", place));
    place += step;
    step *= 1.3;
    clearance = std::max(margin_, 0.6 * clearance);
  }
  throw Error(
      fmt::format("blocklanczos: A - sigma B is singular, or nearly so, at every sigma tried "
                  "up to {:.12g}; choose an end of the interval far from eigenvalues",
                  place));
}

/// Inside a slice; its factor stays. Eigenvectors on both sides of it come from different factors
/// and are the less orthogonal the closer their eigenvalues are.
Cut Slicing::inner_cut(const Slice& slice)
{
  const double clearance = std::max(margin_, 0.02 * slice.width() / (slice.size() + 1));
  const double step = (slice.is_from_high ? -2.5 : 2.5) * clearance;
  const Cut middle = cut(slice.next_place(), step, clearance);
  if (middle.place <= slice.low.place || middle.place >= slice.high.place) {
    throw Error(
        fmt::format("blocklanczos: eigenvalues between {:.12g} and {:.12g} lie so close that "
                    "no place between them is free; choose a wider interval",
                    slice.low.place, slice.high.place));
  }
  if (middle.n_below < slice.low.n_below || middle.n_below > slice.high.n_below) {
    throw Error(fmt::format(
        "blocklanczos: the pivots count {} eigenvalues below {:.9g}, {} below {:.9g} and {} below "
        "{:.9g}: round-off decides, or B is not positive semidefinite",
        slice.low.n_below, slice.low.place, middle.n_below, middle.place, slice.high.n_below,
        slice.high.place));
  }
  return middle;
}

std::vector<Slice> Slicing::halves(const Slice& slice, const Cut& middle) const
{
  std::vector<Slice> some;
  for (const Slice& half :
       {Slice{.low = middle, .high = slice.high}, Slice{.low = slice.low, .high = middle}})
    if (half.size() > 0) some.push_back(half);
  return some;
}

/// The part of a slice that has all its eigenvalues, if it is so small that a shift inside it
/// would be better: in steps that grow, since the upper end of an interval may be anywhere.
std::optional<Slice> Slicing::closer(const Slice& slice, const Cut& middle) const
{
  const bool is_low_empty = middle.n_below == slice.low.n_below;
  const bool is_high_empty = middle.n_below == slice.high.n_below;
  if (!is_low_empty && !is_high_empty) return std::nullopt;
  Slice part = is_low_empty ? Slice{.low = middle, .high = slice.high}
                            : Slice{.low = slice.low, .high = middle};
  if (part.width() < 100.0 * margin_) return std::nullopt;
  const bool is_halved = slice.share == 0.5;
  if (!is_halved && is_low_empty != slice.is_from_high) return std::nullopt;  // close to them
  part.is_from_high = is_halved ? is_low_empty : slice.is_from_high;
  part.share = is_halved ? 0.25 : slice.share * slice.share;
  return part;
}

void Slicing::treat(const Slice& slice)
{
  constexpr PetscInt most = 120;  // pairs for one factor
  const Cut middle = inner_cut(slice);
  if (const std::optional<Slice> part = closer(slice, middle)) {
    open_.push_back(*part);
    return;
  }
  if (slice.size() > most && slice.width() > 100.0 * margin_) {
    for (const Slice& half : halves(slice, middle)) open_.push_back(half);
    return;
  }
  if (!collect(slice, middle.place)) found_.is_complete = false;
}

/// The number of leading Ritz pairs, up to n, that lie in the window and have converged.
PetscInt Slicing::n_converged(const Window& window, PetscInt n,
                              const linear::BlockIteration& iteration)
{
  constexpr double least = 1e-4;  // of the distance to sigma: eigenvalues may be zero
  PetscInt i = 0;
  for (; i < std::min(n, iteration.n_vectors()) && window.has(iteration.theta(i)); ++i) {
    const double distance = 1.0 / iteration.theta(i), lambda = window.sigma + distance;
    const double size =
        std::copysign(std::max(std::abs(lambda), least * std::abs(distance)), lambda);
    PetscReal error = 0.0;
    petsc::check((*eps_->converged)(eps_, size, 0.0, iteration.residual(i) * distance * distance,
                                    &error, eps_->convergedctx));
    if (!(error < eps_->tol)) break;
  }
  return i;
}

void Slicing::refuse_count(const Slice& slice, PetscInt n_found)
{
  throw Error(fmt::format(
      "blocklanczos: the pivots count {} eigenvalues in {:.9g} .. {:.9g}, of which {} were found: "
      "round-off decides, or B is not positive semidefinite; choose other ends, or "
      "-st_pc_factor_mat_solver_type mumps",
      slice.size(), slice.low.place, slice.high.place, n_found));
}

/// Block Lanczos about sigma, until as many pairs as were counted have converged.
/// @return false where patience ends before
bool Slicing::collect(const Slice& slice, double sigma)
{
  const PetscInt n = slice.size(), b = block_size_;
  const Window window{.sigma = sigma, .low = slice.low.place, .high = slice.high.place};
  const auto before = [&](double x, double y) { return window.comes_before(x, y); };
  const linear::BlockOperator op = pencil_.inverse();
  linear::BlockIteration iteration(pencil_.B(), b, std::min(9 * n / 4 + 24 * b, eps_->n) + b);
  iteration.start(op);
  PetscInt n_found = 0, n_kept_before = -1, next_look = n + n / 2;
  for (PetscInt steps = 0; steps < eps_->max_it; ++steps) {
    if (iteration.is_full())
      iteration.restart(std::min((n + iteration.n_vectors()) / 2, iteration.n_vectors() - 1));
    iteration.step(op);
    ++eps_->its;
    const PetscInt n_vectors = iteration.n_vectors();
    const bool looks = n_vectors >= next_look || iteration.is_full() || iteration.is_exhausted();
    if (looks) {
      next_look = n_vectors + n_vectors / 20;  // the projected problem costs more than a step
      iteration.order_ritz_values(before);
      n_found = n_converged(window, n, iteration);
    }
    monitor(static_cast<PetscInt>(found_.pairs.size()) + n_found);
    if (n_found == n) {
      keep(slice, sigma, iteration, op);
      return true;
    }
    if (!looks || !(window.has_only(n_found, iteration) || iteration.is_exhausted())) continue;
    if (iteration.is_exhausted() && n_found == n_kept_before) refuse_count(slice, n_found);
    n_kept_before = n_found;
    begin_anew(eps_, iteration, n_found, op);  // copies are missing
    next_look = 0;
  }
  return false;
}

void Slicing::keep(const Slice& slice, double sigma, const linear::BlockIteration& iteration,
                   const linear::BlockOperator& op)
{
  const petsc::Matrix X = iteration.purified_vectors(0, slice.size(), op);
  std::vector<Eigenvalue> values;
  for (PetscInt i = 0; i < slice.size(); ++i) {
    const double distance = 1.0 / iteration.theta(i);
    values.push_back({.lambda = sigma + distance, .distance = std::abs(distance)});
  }
  const std::vector<PairErrors> errors = pair_errors(eps_, X, values);
  for (PetscInt i = 0; i < slice.size(); ++i) {
    const auto [lambda, distance] = values[std::size_t(i)];
    if (!(errors[std::size_t(i)].scaled <= std::max(1e-4, 100.0 * eps_->tol))) {
      throw Error(
          fmt::format("blocklanczos: lambda = {:.9g} does not satisfy A x = lambda B x (its "
                      "residual is {:.1e}): the factor at sigma = {:.9g} has no digits",
                      lambda, errors[std::size_t(i)].scaled, sigma));
    }
    Vec column = nullptr;
    IntervalPair pair{.lambda = lambda, .error = iteration.residual(i) * distance, .x = {}};
    petsc::check(MatDenseGetColumnVecRead(X, i, &column));
    petsc::check(BVCreateVec(eps_->V, pair.x.put()));
    petsc::check(VecCopy(column, pair.x));
    petsc::check(MatDenseRestoreColumnVecRead(X, i, &column));
    found_.pairs.push_back(std::move(pair));
  }
}

/// Tells the number of pairs; eigenvalues are told at the end, in their order.
void Slicing::monitor(PetscInt n_converged)
{
  petsc::check(EPSMonitor(eps_, eps_->its, n_converged, eps_->eigr, eps_->eigi, eps_->errest, 0));
}

IntervalPairs Slicing::all()
{
  Cut low = cut(eps_->inta - margin_, -margin_, margin_);
  Cut high = cut(eps_->intb + margin_, margin_, margin_);
  if (high.n_below < low.n_below) {
    throw Error(
        fmt::format("blocklanczos: the pivots count {} eigenvalues below {:.9g} and {} below "
                    "{:.9g}: B is not positive semidefinite",
                    low.n_below, low.place, high.n_below, high.place));
  }
  found_.is_complete = true;
  eps_->nev = high.n_below - low.n_below;
  if (eps_->nev > 0) open_.push_back({.low = low, .high = high});
  while (!open_.empty()) {
    const Slice slice = open_.back();
    open_.pop_back();
    treat(slice);
  }
  std::erase_if(found_.pairs, [&](const IntervalPair& pair) {  // counted beyond the ends
    return pair.lambda < eps_->inta - blur_ || pair.lambda > eps_->intb + blur_;
  });
  std::ranges::sort(found_.pairs, {}, &IntervalPair::lambda);
  found_.certificate = {.low = low.place,
                        .high = high.place,
                        .below_low = low.n_below,
                        .below_high = high.n_below,
                        .n_factors = pencil_.n_factors()};
  return std::move(found_);
}

}  // namespace

IntervalPairs pairs_of_interval(EPS eps, PetscInt block_size)
{
  return Slicing(eps, block_size).all();
}

PetscErrorCode view_certificate(const Certificate& certificate, PetscViewer viewer)
{
  PetscFunctionBegin;
  if (certificate.n_factors == 0) PetscFunctionReturn(0);
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  certified by %" PetscInt_FMT " factors: %" PetscInt_FMT
                                   " eigenvalues below %.9g, %" PetscInt_FMT " below %.9g\n",
                                   certificate.n_factors, certificate.below_low, certificate.low,
                                   certificate.below_high, certificate.high));
  PetscFunctionReturn(0);
}

}  // namespace chladni::plugin
