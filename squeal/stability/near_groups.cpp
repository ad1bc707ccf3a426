#include "squeal/stability/near_groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using States = std::vector<Index>;

/// Two states whose coupling is above this part of their distance are in one group from the start.
constexpr double near = 0.25;
/// The iteration ends when F changes by less, 1/s.
constexpr double F_error = 1e-7;
/// A share of another state above this is no small correction; nor is one above the second limit
/// whose harmonics do not end in time.
constexpr double share_limit = 0.5, long_share_limit = 0.03;
constexpr int n_iterations_max = 80;

/// Two states that must be in one group.
struct Link {
  Index i, j;
};

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
  const AngleHarmonics c = harmonics_of(modes.B);
  const Index m = modes.size(), N = c.cols();
  for (Index column = 0; column < N; ++column) {
    const Index k = order_of(column, N);
    if (std::abs(k) > modes.highest) continue;
    const Eigen::Map<const Eigen::MatrixXcd> B(c.col(column).data(), m, m);
    const Complex turn{0.0, double(k) * modes.step};
    for (Index j = 0; j < m; ++j)
      for (Index i = 0; i < m; ++i)
        if (std::abs(B(i, j)) > near * std::abs(turn - modes.lambda[i] + modes.lambda[j]) && i != j)
          sets.unite({i, j});
  }
}

/// The iteration for one group; X is zero in the rows of the group.
class Reduction {
 public:
  Reduction(const TurningModes& modes, double tolerance, States states)
      : modes_(modes),
        tolerance_(tolerance),
        states_(std::move(states)),
        g_(static_cast<Index>(states_.size())),
        kept_(3 * modes.B.cols() / 8),
        X_(AngleSamples::Zero(modes.size() * g_, modes.B.cols())),
        F_(AngleSamples::Zero(g_ * g_, modes.B.cols()))
  {}

  std::variant<NearGroup, Link> solve()
  {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < n_iterations_max; ++i) {
      const AngleSamples F = F_;
      AngleHarmonics c = balanced(rest());
      const AngleHarmonics change = c - c_before(c);
      const double size = std::sqrt(change.cwiseAbs2().maxCoeff());
      const bool diverges = i > 2 && size > 3.0 * least;
      if (!(c.cwiseAbs2().maxCoeff() < share_limit * share_limit) || diverges) return worst(change);
      least = std::min(least, size);
      c_ = c;
      X_ = samples_of(std::move(c));
      if (i > 0 && (F_ - F).cwiseAbs2().maxCoeff() < F_error * F_error) return group_or_link();
    }
    return worst(c_);
  }

 private:
  Eigen::Map<Eigen::MatrixXcd> matrix(AngleSamples& f, Index column, Index rows) const
  {
    return {f.col(column).data(), rows, g_};
  }

  AngleHarmonics c_before(const AngleHarmonics& c) const
  {
    return c_.size() > 0 ? c_ : AngleHarmonics::Zero(c.rows(), c.cols());
  }

  /// B_qg + B_qq X - X (B_gg + B_gq X), and F with it.
  AngleSamples rest()
  {
    const Index m = modes_.size();
    AngleSamples all(X_.rows(), X_.cols());
    Eigen::MatrixXcd W(m, g_), F_s(g_, g_);
    for (Index s = 0; s < X_.cols(); ++s) {
      const auto X = matrix(X_, s, m);
      W = X;
      for (Index j = 0; j < g_; ++j) W(states_[static_cast<std::size_t>(j)], j) += 1.0;
      auto R = matrix(all, s, m);
      R.noalias() = modes_.at(s) * W;
      F_s = R(states_, Eigen::all);
      R.noalias() -= X * F_s;
      matrix(F_, s, g_) = F_s;
    }
    return all;
  }

  AngleHarmonics balanced(AngleSamples rest) const
  {
    AngleHarmonics c = harmonics_of(std::move(rest));
    const Index m = modes_.size(), N = c.cols();
    for (Index column = 0; column < N; ++column) {
      const Index k = order_of(column, N);
      Eigen::Map<Eigen::MatrixXcd> X(c.col(column).data(), m, g_);
      if (std::abs(k) > kept_) {
        X.setZero();
        continue;
      }
      const Complex turn{0.0, double(k) * modes_.step};
      for (Index j = 0; j < g_; ++j) X.col(j).array() /= turn + lambda(j) - modes_.lambda.array();
      X(states_, Eigen::all).setZero();
    }
    return c;
  }

  Complex lambda(Index j) const { return modes_.lambda[states_[static_cast<std::size_t>(j)]]; }

  Link worst(const AngleHarmonics& change) const
  {
    Index row = 0, column = 0;
    change.cwiseAbs2().maxCoeff(&row, &column);
    return {row % modes_.size(), states_[static_cast<std::size_t>(row / modes_.size())]};
  }

  /// What is left out of X is less than its last harmonics; it moves F by B times that, and reaches
  /// an exponent by way of another state, of which the group has its largest share.
  double truncation() const
  {
    double last = 0.0, share = 0.0;
    const Index N = c_.cols();
    for (Index column = 0; column < N; ++column) {
      const double size = c_.col(column).norm();
      share = std::max(share, size);
      if (4 * std::abs(order_of(column, N)) > 3 * kept_) last = std::max(last, size);
    }
    return last * modes_.B.colwise().norm().maxCoeff() * std::min(1.0, share);
  }

  std::variant<NearGroup, Link> group_or_link()
  {
    const double error = modes_.highest > 0 ? truncation() : 0.0;
    if (error > tolerance_ && c_.cwiseAbs2().maxCoeff() > long_share_limit * long_share_limit)
      return worst(c_);
    for (Index j = 0; j < g_; ++j) F_.row(j * g_ + j).array() += lambda(j);
    return NearGroup{states_, true, harmonics_of(F_), kept_, error};
  }

  const TurningModes& modes_;
  double tolerance_;
  States states_;
  Index g_, kept_;
  AngleSamples X_, F_;
  AngleHarmonics c_;
};

}  // namespace

std::vector<NearGroup> near_groups(const TurningModes& modes, double tolerance)
{
  Sets sets(modes.lambda);
  unite_near(sets, modes);
  std::vector<std::optional<NearGroup>> done(static_cast<std::size_t>(modes.size()));
  for (bool changed = true; changed;) {
    changed = false;
    for (const Index set : sets.sets()) {
      auto& group = done[static_cast<std::size_t>(set)];
      const States states = sets.states(set);
      if (group && group->states == states) continue;
      auto outcome = Reduction(modes, tolerance, states).solve();
      if (const auto* link = std::get_if<Link>(&outcome)) {
        sets.unite(*link);
        changed = true;
        break;
      }
      group = std::get<NearGroup>(std::move(outcome));
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
