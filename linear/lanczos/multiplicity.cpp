#include "linear/lanczos/multiplicity.hpp"

#include <algorithm>
#include <cmath>

namespace chladni::linear {

namespace {

/// Whether two eigenvalues converge as one: a vector within the tolerance may mix their
/// eigenvectors.
class SameValue {
 public:
  SameValue(std::span<const double> theta, double tolerance)
      : gap_(std::clamp(100.0 * tolerance, 1e-8, 1e-4))
  {
    for (const double t : theta) round_off_ = std::max(round_off_, 1e-14 * std::abs(t));
  }
  /// Of all values.
  double round_off() const { return round_off_; }
  bool operator()(double a, double b) const
  {
    return std::abs(a - b) <= std::max(round_off_, gap_ * std::max(std::abs(a), std::abs(b)));
  }

 private:
  double gap_;
  double round_off_ = 0.0;
};

/// Both ascend in the same order: whether each of theta is the next of the known ones.
std::vector<bool> are_known(std::span<const double> theta, const KrylovSequence& sequence,
                            const SameValue& is_same)
{
  std::vector<bool> known(theta.size(), false);
  std::size_t next = 0;
  for (std::size_t i = 0; i < theta.size() && next < sequence.known.size(); ++i) {
    known[i] = is_same(theta[i], sequence.known[next]);
    if (known[i]) ++next;
  }
  return known;
}

PetscInt count(const std::vector<bool>& flags, PetscInt first, PetscInt last)
{
  return static_cast<PetscInt>(std::count(flags.begin() + first, flags.begin() + last, true));
}

/// Some cluster that ends before pair n has as many new members as the sequence has sources.
bool a_cluster_is_full(std::span<const double> theta, const std::vector<bool>& known,
                       PetscInt n_sources, const SameValue& is_same)
{
  const auto n = static_cast<PetscInt>(theta.size());
  for (PetscInt first = 0, last = 1; last < n; ++last) {
    if (is_same(theta[last - 1], theta[last])) continue;
    if (last - first - count(known, first, last) >= n_sources) return true;
    first = last;
  }
  return false;
}

}  // namespace

PetscInt n_converged_first(const RitzValues& pairs, double tolerance)
{
  std::size_t n = 0;
  while (n < pairs.theta.size() && pairs.residual[n] <= tolerance * std::abs(pairs.theta[n])) ++n;
  return static_cast<PetscInt>(n);
}

PetscInt n_known_among(std::span<const double> theta, const KrylovSequence& sequence,
                       double tolerance)
{
  const std::vector<bool> known = are_known(theta, sequence, {theta, tolerance});
  return count(known, 0, static_cast<PetscInt>(known.size()));
}

Copies copies_among(const RitzValues& pairs, PetscInt n, const KrylovSequence& sequence,
                    double tolerance)
{
  const std::span<const double> theta(pairs.theta.data(), n);
  const SameValue is_same(pairs.theta, tolerance);
  const std::vector<bool> known = are_known(theta, sequence, is_same);
  if (a_cluster_is_full(theta, known, sequence.n_sources, is_same)) return Copies::may_lack;
  const auto n_all = static_cast<PetscInt>(pairs.theta.size());
  const auto n_known = static_cast<PetscInt>(sequence.known.size());
  // The first that was neither known or guessed nor is among the n must show itself.
  const PetscInt n_to_show = n_known > 0               ? n_known + (n - count(known, 0, n)) + 1
                             : n <= sequence.n_guesses ? sequence.n_guesses + 1
                                                       : 0;
  const double relative = std::max(resolved, tolerance);
  for (PetscInt i = 0; i < std::min(n_to_show, n_all); ++i) {
    const double allowed = std::max(relative * std::abs(pairs.theta[i]), is_same.round_off());
    if (pairs.residual[i] > allowed) return Copies::not_yet_known;
  }
  return Copies::all_there;
}

}  // namespace chladni::linear
