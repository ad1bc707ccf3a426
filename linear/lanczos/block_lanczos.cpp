#include "linear/lanczos/block_lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "common/told_apart.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

namespace {

PetscInt order_of(Mat M)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(M, &n, nullptr));
  return n;
}

/// Basis vectors that mostly suffice: 2.3 to 2.5 for each of hundreds of pairs, more for fewer. A
/// restart shortly before the end costs as much as half of the iteration.
PetscInt capacity(PetscInt n_pairs, PetscInt n_rows, const BlockLanczosOptions& options)
{
  const PetscInt b = options.block_size;
  const PetscInt wanted = options.max_subspace > 0 ? std::max(options.max_subspace, n_pairs + 4 * b)
                                                   : 9 * n_pairs / 4 + 24 * b;
  return std::min(wanted, n_rows) + b;
}

/// The largest residual of the first n pairs over what is allowed.
double excess(const RitzValues& pairs, PetscInt n, double tolerance)
{
  double largest = 0.0;
  for (PetscInt i = 0; i < n; ++i)
    largest = std::max(largest, pairs.residual[i] / (tolerance * std::abs(pairs.theta[i])));
  return largest;
}

/// Basis vectors that a basis of n lacks at least when its pairs exceed the tolerance by that much:
/// residuals fall the faster the longer they do, at the end by a factor of 10 for each 2.5 %.
PetscInt lacking(PetscInt n, double excess)
{
  return static_cast<PetscInt>(n * std::clamp(0.025 * std::log10(excess), 0.04, 0.15));
}

constexpr double nothing = 1e-14;  // of the largest theta: no share of M

/// The first pairs that have converged and have a share of M. Where M has no more of them, a basis
/// ends with directions that the operator maps to zero; their theta are round-off of either sign,
/// and would be the lowest of all lambda.
PetscInt n_found_first(const RitzValues& pairs, double tolerance)
{
  PetscInt n = n_converged_first(pairs, tolerance);
  while (n > 0 && !(pairs.theta[n - 1] > nothing * pairs.theta[0])) --n;
  return n;
}

}  // namespace

BlockLanczos::BlockLanczos(Mat factor, Mat M, const BlockLanczosOptions& options)
    : BlockLanczos([factor](Mat B, Mat X) { petsc::check(MatMatSolve(factor, B, X)); }, M, options)
{}

BlockLanczos::BlockLanczos(BlockSolve solve, Mat M, const BlockLanczosOptions& options)
    : solve_(std::move(solve)),
      options_(options),
      n_rows_(order_of(M)),
      op_([this](Mat, Mat MQ, Mat Y) {
        PetscInt n_columns = 0;
        petsc::check(MatGetSize(MQ, nullptr, &n_columns));
        solve_(MQ, Y);
        n_solves_ += n_columns;
      }),
      iteration_(M, options.block_size, capacity(0, n_rows_, options), options.scratch)
{}

/// The projected eigenproblem costs more than a step where the basis is large: it is not solved
/// before the basis is half as large again as the number of pairs, and then as seldom as `lacking`
/// allows.
bool BlockLanczos::is_too_early(PetscInt n_pairs) const
{
  if (iteration_.is_exhausted()) return false;
  const PetscInt n = iteration_.n_vectors();
  if (iteration_.is_full()) return n < 1;
  const bool is_first_sequence = iteration_.sequence().known.empty();
  return n < std::max(next_look_, is_first_sequence ? n_pairs + n_pairs / 2 : 0);
}

/// By the Ritz values up to lambda, which are never more than the eigenvalues there.
void BlockLanczos::raise(Goal& goal)
{
  PetscInt n_below = 0;
  while (n_below < iteration_.n_vectors() && iteration_.theta(n_below) > 0.0 &&
         lambda(n_below) <= goal.lambda)
    ++n_below;
  goal.n_pairs = std::max(goal.n_pairs, std::min(n_below + 1, goal.most));
  iteration_.reserve(capacity(goal.n_pairs, n_rows_, options_));
}

bool BlockLanczos::has_converged(Goal& goal)
{
  const PetscInt n = iteration_.n_vectors();
  // It takes 2.4 to 3.5 vectors for each pair.
  report_progress(std::min(0.99, double(n) / (3.2 * goal.n_pairs)));
  if (is_too_early(goal.n_pairs)) return false;
  iteration_.order_ritz_values(std::greater<>());
  raise(goal);
  const PetscInt n_pairs = goal.n_pairs;
  const RitzValues pairs = iteration_.pairs();
  const PetscInt n_first = n_found_first(pairs, options_.tolerance);
  n_converged_ = std::min(n_first, n_pairs);
  if (iteration_.is_exhausted()) return has_ended(pairs, n_pairs);
  next_look_ = n + lacking(n, excess(pairs, std::min(n_pairs, n), options_.tolerance));
  const Copies copies = iteration_.copies_among_first(n_converged_, options_.tolerance);
  if (copies == Copies::may_lack) begin_anew(n_first, n_pairs);
  return copies == Copies::all_there && n_converged_ == n_pairs;
}

/// Keeps the wanted Ritz vectors and half of the others.
void BlockLanczos::restart(PetscInt n_pairs)
{
  const PetscInt n = iteration_.n_vectors();
  iteration_.restart(std::min(n - 1, n_pairs + (n - n_pairs) / 2));
  next_look_ = 0;
}

/// Wider blocks from the second time on: an eigenvalue of several hundred copies takes few rounds
/// then.
void BlockLanczos::begin_anew(PetscInt n_kept, PetscInt n_pairs)
{
  constexpr PetscInt n_steps = 8;  // that a sequence mostly takes
  unresolved_from_ = all_of_them;  // what the new sequence does not find is noted at its end
  const bool is_second = !iteration_.sequence().known.empty();
  const PetscInt widest = std::max(options_.block_size, n_pairs / 4);
  const PetscInt width =
      std::min({widest, (is_second ? 2 : 1) * iteration_.block_size(), n_rows_ - n_kept});
  iteration_.reserve(std::min(n_kept + n_steps * width, n_rows_) + width);
  iteration_.begin_anew(n_kept, width, op_);
  next_look_ = n_kept + n_steps / 2 * width;
}

/// Whether a basis that is all that M can see has given what it can. What was left out of its
/// blocks as dependent keeps pairs from converging: a new sequence, orthogonal to those that did
/// converge, finds the others, except where round-off is all there is of them.
bool BlockLanczos::has_ended(const RitzValues& pairs, PetscInt n_pairs)
{
  const PetscInt n_first = n_found_first(pairs, options_.tolerance);
  if (n_first >= n_pairs) return true;
  double theta = iteration_.lost_theta();
  for (std::size_t i = n_first; i < pairs.theta.size(); ++i)
    theta = std::max(theta, pairs.theta[i] + pairs.residual[i]);
  note_unresolved(theta);
  if (unresolved_from_ == all_of_them || n_first <= n_kept_before_) return true;
  n_kept_before_ = n_first;
  begin_anew(n_first, n_pairs);
  if (!iteration_.is_exhausted()) return false;
  note_unresolved(std::max(theta, iteration_.lost_theta()));
  return true;
}

/// That pairs with theta up to this may exist, which do not converge.
void BlockLanczos::note_unresolved(double theta)
{
  const double largest = iteration_.n_vectors() > 0 ? iteration_.theta(0) : theta;
  unresolved_from_ = theta > nothing * largest ? 1.0 / theta : all_of_them;
}

void BlockLanczos::require_resolved(double lambda) const
{
  if (lambda <= unresolved_from_) return;
  throw Error(fmt::format(
      "block_lanczos: {} pairs converge to {:.1e}, up to lambda = {:.6g}; of the others the "
      "products with M are round-off: M is nearly singular, or masses differ too much; ask for "
      "fewer or raise the tolerance",
      n_converged_, options_.tolerance, unresolved_from_));
}

void BlockLanczos::converge(PetscInt n_pairs)
{
  converge(Goal{.n_pairs = n_pairs});
}

void BlockLanczos::converge_beyond(double lambda, PetscInt most)
{
  constexpr PetscInt first_guess = 4;
  converge(Goal{.n_pairs = std::min(std::max(n_converged_, first_guess), most),
                .lambda = lambda,
                .most = most});
}

void BlockLanczos::converge(Goal goal)
{
  iterate(goal);
  iteration_.release_memory_of_steps();
}

void BlockLanczos::iterate(Goal goal)
{
  iteration_.reserve(capacity(goal.n_pairs, n_rows_, options_));
  if (n_solves_ == 0) iteration_.start(op_);
  next_look_ = 0;
  if (iteration_.n_vectors() > 0 && has_converged(goal)) return;
  for (PetscInt i = 0; i < options_.max_steps; ++i) {
    if (iteration_.is_exhausted()) return note_unresolved(iteration_.lost_theta());
    if (iteration_.is_full()) restart(goal.n_pairs);
    iteration_.step(op_);
    if (has_converged(goal)) return;
  }
  iteration_.order_ritz_values(std::greater<>());
  const RitzValues pairs = iteration_.pairs();
  const PetscInt n = n_found_first(pairs, options_.tolerance);
  const auto next = std::size_t(n);
  const double residual =
      next < pairs.theta.size() ? pairs.residual[next] / std::abs(pairs.theta[next]) : 0.0;
  const auto [reached, asked] = told_apart(residual, options_.tolerance);
  const std::string why = n >= goal.n_pairs ? ", but multiple eigenvalues may have further copies"
                          : residual > options_.tolerance
                              ? fmt::format(", and the next one to {}", reached)
                              : "";
  throw Error(fmt::format(
      "block_lanczos: of {} pairs {} converged to {} in {} block solves{}; ask for fewer or raise "
      "the tolerance",
      goal.n_pairs, std::min(n, goal.n_pairs), asked, options_.max_steps, why));
}

EigenPairs block_lanczos(Mat factor, Mat M, const BlockLanczosOptions& options)
{
  BlockLanczos lanczos(factor, M, options);
  lanczos.converge(options.n_pairs);
  if (lanczos.n_pairs() < options.n_pairs) lanczos.require_resolved(all_of_them);
  EigenPairs pairs{.lambda = {},
                   .residual = {},
                   .X = lanczos.vectors(0, lanczos.n_pairs()),
                   .n_solves = lanczos.n_solves()};
  for (PetscInt i = 0; i < lanczos.n_pairs(); ++i) {
    pairs.lambda.push_back(lanczos.lambda(i));
    pairs.residual.push_back(lanczos.residual(i));
  }
  return pairs;
}

}  // namespace chladni::linear
