#include "squeal/condensation/condensation_error.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "linear/dense/real_eigenvalues.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXcd;

/// Growth below this part of the frequency is neither growth nor decay.
constexpr double neutral = 1e-4;

/// Eigenvalues with Im >= 0: an oscillation near critical damping may have become two decays.
std::vector<Complex> of_upper_half(const VectorXcd& lambda)
{
  std::vector<Complex> upper;
  for (const Complex& one : lambda)
    if (one.imag() >= 0.0) upper.push_back(one);
  return upper;
}

/// Whether an eigenvalue is an oscillation of the band, and remains one within the tolerance. Near
/// the end of the band, and near critical damping, it may be one in one of the brakes alone.
bool is_oscillation_of_band(const Complex& lambda, const CondensationOptions& wanted)
{
  const double size = std::abs(lambda);
  const double doubt = std::max(0.01 * wanted.highest, 2.0 * wanted.tolerance * size);
  return lambda.imag() > 2.0 * std::sqrt(wanted.tolerance) * size &&
         lambda.imag() + doubt <= wanted.highest;
}

/// Of each exact eigenvalue the place of its own among those found: the nearest pairs first.
std::vector<std::size_t> partners(const VectorXcd& exact, const std::vector<Complex>& found)
{
  struct Pair {
    double distance;
    std::size_t exact, found;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < static_cast<std::size_t>(exact.size()); ++i)
    for (std::size_t j = 0; j < found.size(); ++j)
      pairs.push_back({std::abs(exact[Index(i)] - found[j]), i, j});
  std::ranges::sort(pairs, {}, &Pair::distance);
  std::vector<std::size_t> partner(static_cast<std::size_t>(exact.size()), found.size());
  std::vector<bool> taken(found.size(), false);
  for (const auto& [distance, i, j] : pairs) {
    if (partner[i] < found.size() || taken[j]) continue;
    partner[i] = j;
    taken[j] = true;
  }
  return partner;
}

bool changes_stability(const Complex& exact, const Complex& found)
{
  const double limit = neutral * std::abs(exact);
  return std::max(std::abs(exact.real()), std::abs(found.real())) > limit &&
         exact.real() * found.real() < 0.0;
}

}  // namespace

CondensationError condensation_error(const VectorXcd& exact, const Eigen::MatrixXd& A,
                                     const CondensationOptions& wanted)
{
  const std::vector<Complex> found = of_upper_half(linear::real_eigenvalues(A));
  const std::vector<std::size_t> partner = partners(exact, found);
  CondensationError error{.n_eigenvalues = static_cast<int>(exact.size()), .n_states = 1};
  for (std::size_t i = 0; i < partner.size(); ++i) {
    const Complex& one = exact[Index(i)];
    if (partner[i] == found.size()) {
      error.eigenvalues = 1.0;
      continue;
    }
    const Complex& mine = found[partner[i]];
    error.eigenvalues = std::max(error.eigenvalues, std::abs(mine - one) / std::abs(one));
    error.growth = std::max(error.growth, std::abs(mine.real() - one.real()));
    if (changes_stability(one, mine)) error.eigenvalues = 1.0;
  }
  for (std::size_t j = 0; j < found.size(); ++j) {
    const bool is_own = std::ranges::find(partner, j) != partner.end();
    if (!is_own && is_oscillation_of_band(found[j], wanted)) error.eigenvalues = 1.0;
    const bool grows = found[j].real() > neutral * std::abs(found[j]);
    if (found[j].imag() > wanted.highest && grows) ++error.n_unstable_beyond;
  }
  return error;
}

CondensationError worst_of(const CondensationError& one, const CondensationError& other)
{
  return {.eigenvalues = std::max(one.eigenvalues, other.eigenvalues),
          .growth = std::max(one.growth, other.growth),
          .n_eigenvalues = one.n_eigenvalues + other.n_eigenvalues,
          .n_states = one.n_states + other.n_states,
          .n_unstable_beyond = std::max(one.n_unstable_beyond, other.n_unstable_beyond)};
}

}  // namespace chladni::squeal
