#include "squeal/stability/near_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "squeal/stability/group_reduction.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
/// Two states whose coupling is above this part of their distance are in one group from the start.
constexpr double near = 0.25;
/// Disjoint sets of states, closed under complex conjugation.
class Sets {
 public:
  explicit Sets(const Eigen::VectorXcd& lambda) : mirror_(static_cast<std::size_t>(lambda.size()))
  {
    std::iota(mirror_.begin(), mirror_.end(), Index{0});
    set_ = mirror_;
    // Eigenvalues of a real matrix: both of a conjugate pair are neighbours.
    for (Index i = 0; i + 1 < lambda.size(); ++i)
      if (lambda[i].imag() != 0.0) {
        std::swap(mirror_[static_cast<std::size_t>(i)], mirror_[static_cast<std::size_t>(i) + 1]);
        ++i;
      }
  }

  void unite(const Link& link)
  {
    merge(set_of(link.i), set_of(link.j));
    merge(set_of(mirror(link.i)), set_of(mirror(link.j)));
  }

  Index set_of(Index i) const { return set_[static_cast<std::size_t>(i)]; }
  Index mirror(Index i) const { return mirror_[static_cast<std::size_t>(i)]; }

  States states(Index set) const
  {
    States found;
    for (std::size_t i = 0; i < set_.size(); ++i)
      if (set_[i] == set) found.push_back(static_cast<Index>(i));
    return found;
  }

  /// One of each pair of mirror images.
  States sets() const
  {
    States found;
    for (std::size_t i = 0; i < set_.size(); ++i)
      if (set_[i] == static_cast<Index>(i) && !is_image(set_[i])) found.push_back(set_[i]);
    return found;
  }

  bool is_its_own_mirror(Index set) const { return set_of(mirror(set)) == set; }

 private:
  /// Sets are called by their lowest state, which has Im lambda > 0 in one of two images.
  bool is_image(Index set) const { return set_of(mirror(set)) < set; }

  void merge(Index a, Index b)
  {
    for (Index& set : set_)
      if (set == std::max(a, b)) set = std::min(a, b);
  }

  States mirror_, set_;
};

/// States that B couples by much of their distance, each harmonic by itself.
void unite_near(Sets& sets, const TurningModes& modes)
{
  const AngleHarmonics c = harmonics_of(modes.B.cast<Complex>());
  const Index m = modes.size(), N = c.cols();
  for (Index column = 0; column < N; ++column) {
    const Index k = order_of(column, N);
    if (std::abs(k) > modes.highest) continue;
    const Eigen::MatrixXcd PB = from_real_pairs(modes.lambda, c.col(column).reshaped(m, m));
    const Eigen::MatrixXcd B = from_real_pairs(modes.lambda, PB.adjoint()).adjoint();
    const Complex turn{0.0, double(k) * modes.step};
    for (Index j = 0; j < m; ++j)
      for (Index i = 0; i < m; ++i)
        if (std::abs(B(i, j)) > near * std::abs(turn - modes.lambda[i] + modes.lambda[j]) && i != j)
          sets.unite({i, j});
  }
}

}  // namespace

std::vector<NearGroup> near_groups(const TurningModes& modes, double tolerance)
{
  Sets sets(modes.lambda);
  unite_near(sets, modes);
  std::vector<std::optional<NearGroup>> done(static_cast<std::size_t>(modes.size()));
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<States> open;
    for (const Index set : sets.sets()) {
      const auto& group = done[static_cast<std::size_t>(set)];
      if (!group || group->states != sets.states(set)) open.push_back(sets.states(set));
    }
    for (Reduced& one : reduced(modes, tolerance, open)) {
      if (const auto* link = std::get_if<Link>(&one)) {
        sets.unite(*link);
        changed = true;
      } else {
        auto& group = std::get<NearGroup>(one);
        done[static_cast<std::size_t>(group.states.front())] = std::move(group);
      }
    }
  }
  std::vector<NearGroup> groups;
  for (const Index set : sets.sets()) {
    groups.push_back(std::move(*done[static_cast<std::size_t>(set)]));
    groups.back().has_mirror = !sets.is_its_own_mirror(set);
  }
  return groups;
}

}  // namespace chladni::squeal
