#include "squeal/stability/near_groups.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/hill.hpp"

namespace chladni::squeal {

using Eigen::Index;

namespace {

/// Indices of states in `TurningModes`, ascending.
using States = std::vector<Eigen::Index>;

/// Two states that must belong to one group.
struct Link {
  Eigen::Index i, j;
};

/// An invariant group, or the link that prevents it.
using Reduced = std::variant<NearGroup, Link>;

using Complex = std::complex<double>;

/// Bytes of the coupling matrix and its harmonics, for each entry and angle; of the iteration, for
/// each state, angle and column; and of the steps that it combines.
constexpr double bytes_an_entry = 20.0, bytes_a_column = 112.0, bytes_combined = 256.0;

/// The iteration ends when F changes by less, 1/s.
constexpr double F_error = 1e-7;

/// A share of another state above this is no small correction; nor is one above the second limit
/// whose harmonics do not end in time.
constexpr double share_limit = 0.5, long_share_limit = 0.03;

constexpr int n_iterations_max = 80;
/// Of the change of X eight steps before, from the 32nd on: what falls no faster does not settle
/// within all of them.
constexpr double slowest = 0.2;
constexpr std::size_t steps_looked_back = 8, steps_until_known = 32;
/// Steps of which a slow iteration combines what they changed, and what is slow: of the change
/// before.
constexpr Index steps_combined = 8;
constexpr double slow = 0.1;
/// Residuals of combined steps may rise now and then.
constexpr double rise_limit = 1e2;

/// Anderson's acceleration of c <- G(c): of the last steps that combination is taken whose residual
/// G(c) - c is least. States that are near each other but not near a group make the plain iteration
/// diverge in a few directions, although the equations of the group have a solution.
class Acceleration {
 public:
  /// @param g  columns of c; of many, fewer steps are combined, which bounds the memory
  explicit Acceleration(Index g)
      : n_combined_(std::clamp<Index>(steps_combined * columns_iterated / g, 1, steps_combined))
  {}

  /// @param image     G(c)
  /// @param residual  G(c) - c
  /// @return the next c
  AngleHarmonics next(const AngleHarmonics& image, const AngleHarmonics& residual)
  {
    if (last_image_.size() > 0) {
      if (std::ssize(images_) == n_combined_) {
        images_.erase(images_.begin());
        residuals_.erase(residuals_.begin());
      }
      images_.push_back((image - last_image_).reshaped());
      residuals_.push_back((residual - last_residual_).reshaped());
    }
    last_image_ = image;
    last_residual_ = residual;
    AngleHarmonics combined = image;
    if (images_.empty()) return combined;
    const Eigen::VectorXcd gamma = combination(residual.reshaped());
    for (std::size_t i = 0; i < images_.size(); ++i)
      combined.reshaped() -= gamma[static_cast<Index>(i)] * images_[i];
    return combined;
  }

 private:
  /// Least squares by the normal equations of columns of norm 1; what depends on others is dropped.
  Eigen::VectorXcd combination(const Eigen::VectorXcd& residual) const
  {
    constexpr double dependent = 1e-10;
    const auto n = std::ssize(residuals_);
    Eigen::MatrixXcd R(n, n);
    Eigen::VectorXcd r(n), scale(n);
    for (Index i = 0; i < n; ++i) {
      const Eigen::VectorXcd& f = residuals_[static_cast<std::size_t>(i)];
      scale[i] = f.norm() > 0.0 ? 1.0 / f.norm() : 0.0;
      r[i] = scale[i] * f.dot(residual);
      for (Index j = 0; j <= i; ++j) {
        R(i, j) = scale[i] * scale[j] * f.dot(residuals_[static_cast<std::size_t>(j)]);
        R(j, i) = std::conj(R(i, j));
      }
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXcd> solver;
    solver.setThreshold(dependent);
    solver.compute(R);
    return scale.cwiseProduct(Eigen::VectorXcd(solver.solve(r)));
  }

  Index n_combined_;
  AngleHarmonics last_image_, last_residual_;
  std::vector<Eigen::VectorXcd> images_, residuals_;  ///< changes from step to step
};

/// The iteration for one group; X is zero in the rows of the group. In each step P B P^* multiplies
/// the columns of `put` at every sample, for all groups at once; `take` is given the product.
class Reduction {
 public:
  Reduction(const TurningModes& modes, double tolerance, States states)
      : modes_(&modes),
        tolerance_(tolerance),
        states_(std::move(states)),
        g_(static_cast<Index>(states_.size())),
        kept_(3 * modes.B.cols() / 8),
        X_(AngleSamples::Zero(modes.size() * g_, modes.B.cols())),
        F_(AngleSamples::Zero(g_ * g_, modes.B.cols())),
        F_before_(F_),
        acceleration_(g_)
  {}

  Index size() const { return g_; }
  std::optional<Reduced>& outcome() { return outcome_; }

  /// The states of the group and what belongs to them of the others at the sample s, [m x g].
  void put(Index s, Eigen::Ref<Eigen::MatrixXcd> W)
  {
    W = matrix(X_, s, modes_->size());
    for (Index j = 0; j < g_; ++j) W(states_[static_cast<std::size_t>(j)], j) += 1.0;
  }

  /// B_qg + B_qq X - X (B_gg + B_gq X) in the place of X, and F with it.
  void take(Index s, const Eigen::Ref<const Eigen::MatrixXcd>& BW)
  {
    auto X = matrix(X_, s, modes_->size());
    auto F = matrix(F_, s, g_);
    F = BW(states_, every);
    X = (BW - X * F).eval();
  }

  /// After all samples.
  void step()
  {
    AngleHarmonics c = balanced(std::move(X_));
    const AngleHarmonics change = c - c_before(c);
    const double size = std::sqrt(change.cwiseAbs2().maxCoeff());
    const bool diverges = n_steps_ > 2 && size > rise_limit * least_;
    sizes_.push_back(size);
    const bool creeps = sizes_.size() > steps_until_known &&
                        size > slowest * sizes_.end()[-1 - std::ptrdiff_t(steps_looked_back)];
    if (!(c.cwiseAbs2().maxCoeff() < share_limit * share_limit) || diverges ||
        (creeps && !repeats_F())) {
      outcome_ = worst(change);
      return;
    }
    least_ = std::min(least_, size);
    // After a plain step the change of F is what the residual does to it; a combination of steps
    // may stand still.
    const bool repeats = repeats_F(), settled = repeats && !is_combined_;
    F_before_ = F_;
    is_slow_ = is_slow_ || (sizes_.size() > 1 && size > slow * sizes_.end()[-2]);
    is_combined_ = is_slow_ && !repeats;
    c_ = is_combined_ ? acceleration_.next(c, change) : std::move(c);
    if (settled)
      outcome_ = group_or_link();
    else if (++n_steps_ == n_iterations_max)
      outcome_ = worst(c_);
    else
      X_ = samples_of(c_);
  }

 private:
  Eigen::Map<Eigen::MatrixXcd> matrix(AngleSamples& f, Index column, Index rows) const
  {
    return {f.col(column).data(), rows, g_};
  }

  bool repeats_F() const
  {
    return n_steps_ > 0 && (F_ - F_before_).cwiseAbs2().maxCoeff() < F_error * F_error;
  }

  AngleHarmonics c_before(const AngleHarmonics& c) const
  {
    return c_.size() > 0 ? c_ : AngleHarmonics::Zero(c.rows(), c.cols());
  }

  AngleHarmonics balanced(AngleSamples rest) const
  {
    AngleHarmonics c = harmonics_of(std::move(rest));
    const Index m = modes_->size(), N = c.cols();
    for (Index column = 0; column < N; ++column) {
      const Index k = order_of(column, N);
      Eigen::Map<Eigen::MatrixXcd> X(c.col(column).data(), m, g_);
      if (std::abs(k) > kept_) {
        X.setZero();
        continue;
      }
      const Complex turn{0.0, double(k) * modes_->step};
      for (Index j = 0; j < g_; ++j) {
        const Eigen::ArrayXcd d = turn + lambda(j) - modes_->lambda.array();
        // What is not excited has no share, even in resonance to the last digit.
        X.col(j) = (X.col(j).array() == Complex(0.0)).select(X.col(j), X.col(j).array() / d);
      }
      X(states_, every).setZero();
    }
    return c;
  }

  Complex lambda(Index j) const { return modes_->lambda[states_[static_cast<std::size_t>(j)]]; }

  Link worst(const AngleHarmonics& change) const
  {
    Index row = 0, column = 0;
    change.cwiseAbs2().maxCoeff(&row, &column);
    return {row % modes_->size(), states_[static_cast<std::size_t>(row / modes_->size())]};
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
    return last * modes_->B.colwise().norm().maxCoeff() * std::min(1.0, share);
  }

  Reduced group_or_link()
  {
    const double error = modes_->highest > 0 ? truncation() : 0.0;
    if (error > tolerance_ && c_.cwiseAbs2().maxCoeff() > long_share_limit * long_share_limit)
      return worst(c_);
    for (Index j = 0; j < g_; ++j) F_.row(j * g_ + j).array() += lambda(j);
    return NearGroup{states_, true, harmonics_of(F_), kept_, error, std::move(c_)};
  }

  const TurningModes* modes_;
  double tolerance_;
  States states_;
  Index g_, kept_;
  AngleSamples X_, F_, F_before_;
  AngleHarmonics c_;
  double least_ = std::numeric_limits<double>::infinity();
  std::vector<double> sizes_;  ///< of the changes of X
  bool is_slow_ = false, is_combined_ = false;
  Acceleration acceleration_;
  int n_steps_ = 0;
  std::optional<Reduced> outcome_;
};

/// P B P^* W at the sample s: B is real, and so are the two products.
Eigen::MatrixXcd coupled(const TurningModes& modes, Index s, Eigen::MatrixXcd W)
{
  const Index n = W.cols();
  Eigen::MatrixXcd r = to_real_pairs(modes.lambda, std::move(W));
  Eigen::MatrixXd parts(r.rows(), 2 * n), product(r.rows(), 2 * n);
  parts << r.real(), r.imag();
  product.noalias() = modes.at(s) * parts;
  r.real() = product.leftCols(n);
  r.imag() = product.rightCols(n);
  return from_real_pairs(modes.lambda, std::move(r));
}

/// A group of `reduced` at which the iteration is.
struct Open {
  std::size_t place;
  Reduction reduction;
};

Index n_columns(const std::vector<Open>& open)
{
  Index n = 0;
  for (const Open& one : open) n += one.reduction.size();
  return n;
}

/// A step of each. B is read once for all of them, which is what it costs.
void advance(std::vector<Open>& open, const TurningModes& modes)
{
  for (Index s = 0; s < modes.B.cols(); ++s) {
    Eigen::MatrixXcd W(modes.size(), n_columns(open));
    Index at = 0;
    for (Open& one : open) {
      one.reduction.put(s, W.middleCols(at, one.reduction.size()));
      at += one.reduction.size();
    }
    const Eigen::MatrixXcd BW = coupled(modes, s, std::move(W));
    at = 0;
    for (Open& one : open) {
      one.reduction.take(s, BW.middleCols(at, one.reduction.size()));
      at += one.reduction.size();
    }
  }
  for (Open& one : open) one.reduction.step();
}

/// Performs the fixed-point iteration of `near_groups` for each of the disjoint `groups`, a few at
/// a time.
/// @param tolerance  1/s
std::vector<Reduced> reduced(const TurningModes& modes, double tolerance,
                             const std::vector<States>& groups)
{
  std::vector<Reduced> results(groups.size());
  std::vector<Open> open;
  for (std::size_t next = 0;;) {
    while (next < groups.size() &&
           (open.empty() || n_columns(open) + std::ssize(groups[next]) <= columns_iterated)) {
      open.push_back({next, Reduction(modes, tolerance, groups[next])});
      ++next;
    }
    if (open.empty()) return results;
    require_room(modes.step, modes.size(), modes.B.cols(), n_columns(open));
    advance(open, modes);
    for (Open& one : open)
      if (auto& outcome = one.reduction.outcome()) results[one.place] = std::move(*outcome);
    std::erase_if(open, [](Open& one) { return one.reduction.outcome().has_value(); });
  }
}

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

/// A harmonic of P B P^*, the coupling of the eigenvectors of A_0, between some of the states,
/// which hold both of each conjugate pair.
Eigen::MatrixXcd coupling(const TurningModes& modes, const Eigen::MatrixXcd& B_k,
                          const States& states)
{
  const Eigen::VectorXcd lambda = modes.lambda(states);
  const Eigen::MatrixXcd PB = from_real_pairs(lambda, B_k);
  return from_real_pairs(lambda, PB.adjoint()).adjoint();
}

/// What each state has of those beyond its set by the second order of B, by way of them and back.
struct SecondOrder {
  Eigen::VectorXcd shift;  ///< [m] of lambda, 1/s
  Eigen::VectorXd doubt;   ///< [m] 1/s
};

/// Unites states that B couples by much of their distance, each harmonic by itself.
SecondOrder unite_near(Sets& sets, const TurningModes& modes)
{
  constexpr double of_next_order = 0.5;
  const Index m = modes.size();
  States all(static_cast<std::size_t>(m));
  std::iota(all.begin(), all.end(), Index{0});
  // Of state j by way of i, of all harmonics.
  Eigen::MatrixXcd shift = Eigen::MatrixXcd::Zero(m, m);
  Eigen::MatrixXd doubt = Eigen::MatrixXd::Zero(m, m);
  for (Index k = 1; k <= modes.highest; ++k) {
    const Eigen::MatrixXcd B_k = modes.harmonic(k);
    const Eigen::MatrixXcd up = coupling(modes, B_k, all),
                           down = coupling(modes, B_k.conjugate(), all);
    const auto couple = [&](const Eigen::MatrixXcd& there, const Eigen::MatrixXcd& back,
                            Complex turned, Index i, Index j) {
      if (there(i, j) == Complex(0.0)) return;
      const Complex d = turned - modes.lambda[i] + modes.lambda[j];
      if (i == j || std::norm(there(i, j)) <= near * near * std::norm(d)) {
        const Complex part = back(j, i) * there(i, j) * std::conj(d) / std::norm(d);
        shift(i, j) += part;
        doubt(i, j) += of_next_order * std::sqrt(std::norm(part));
      } else {
        sets.unite({i, j});
      }
    };
    const Complex turn{0.0, double(k) * modes.step};
    for (Index j = 0; j < m; ++j)
      for (Index i = 0; i < m; ++i) {
        couple(up, down, turn, i, j);
        couple(down, up, -turn, i, j);
      }
  }
  // The equations of a set have all harmonics between its states.
  SecondOrder order{Eigen::VectorXcd::Zero(m), Eigen::VectorXd::Zero(m)};
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i < m; ++i) {
      if (sets.set_of(i) == sets.set_of(j)) continue;
      order.shift[j] += shift(i, j);
      order.doubt[j] += doubt(i, j);
    }
  return order;
}

/// Growth rates of a set of states, 1/s.
struct Estimates {
  Eigen::VectorXd growth;
  double doubt;
};

/// The equations of a set by themselves, with the second order of all others in their diagonal.
NearGroup equations_alone(const States& states, const Sets& sets, const TurningModes& modes,
                          const SecondOrder& order)
{
  constexpr double enough = 1.0;  // 1/s: to tell which of the sets count
  const auto g = std::ssize(states);
  States closed = states;
  for (const Index i : states) closed.push_back(sets.mirror(i));
  std::ranges::sort(closed);
  closed.erase(std::unique(closed.begin(), closed.end()), closed.end());
  std::vector<Index> at;
  for (const Index i : states) at.push_back(std::ranges::lower_bound(closed, i) - closed.begin());
  const Index N = power_of_two(2 * modes.highest + 1);
  NearGroup group{states, true, AngleHarmonics::Zero(g * g, N), modes.highest, enough};
  group.doubt = order.doubt(states).maxCoeff();
  if (group.doubt == 0.0) group.error = 0.0;
  for (Index k = 1; k <= modes.highest; ++k) {
    const Eigen::MatrixXcd B_k = modes.harmonic(k)(closed, closed);
    group.F.col(k) = coupling(modes, B_k, closed)(at, at).reshaped();
    group.F.col(N - k) = coupling(modes, B_k.conjugate(), closed)(at, at).reshaped();
  }
  for (Index j = 0; j < g; ++j) {
    const Index i = states[static_cast<std::size_t>(j)];
    group.F(j * g + j, 0) += modes.lambda[i] + order.shift[i];
  }
  return group;
}

Estimates estimates_of(const States& states, const Sets& sets, const TurningModes& modes,
                       const SecondOrder& order)
{
  constexpr Index large = 12;  // its equations take longer than they save
  Estimates found{(modes.lambda + order.shift)(states).real(), order.doubt(states).maxCoeff()};
  if (states.size() == 1) return found;
  if (std::ssize(states) > large) return {found.growth, std::numeric_limits<double>::infinity()};
  const GroupExponents alone =
      group_exponents(equations_alone(states, sets, modes, order), modes.step);
  return {alone.lambda.real(), found.doubt + alone.error};
}

/// Marks the states of the sets that are asked for.
std::vector<char> may_be_wanted(const Sets& sets, const TurningModes& modes,
                                const SecondOrder& order, const GroupsAsked& asked)
{
  std::vector<char> wanted(static_cast<std::size_t>(modes.size()), 0);
  std::vector<double> at_least, at_most;
  for (const Index set : sets.sets()) {
    const Estimates of = estimates_of(sets.states(set), sets, modes, order);
    for (const double growth : of.growth) at_least.push_back(growth - of.doubt);
    at_most.push_back(of.growth.maxCoeff() + of.doubt);
  }
  const Index n = std::clamp<Index>(asked.least_stable, 1, std::ssize(at_least));
  std::ranges::nth_element(at_least, at_least.begin() + (n - 1), std::greater<>());
  double limit = at_least[static_cast<std::size_t>(n - 1)];
  if (asked.with_estimates) limit = std::min(limit, 0.0);
  std::size_t k = 0;
  for (const Index set : sets.sets()) {
    if (at_most[k++] < limit) continue;
    for (const Index i : sets.states(set)) wanted[static_cast<std::size_t>(i)] = 1;
  }
  return wanted;
}

}  // namespace

void require_room(double step, Index m, Index N, Index columns)
{
  const double gibibyte = double(1 << 30);
  const double n_threads = std::max(1U, std::thread::hardware_concurrency());
  const double bytes_a_state = bytes_an_entry * double(m) + bytes_a_column * double(columns) +
                               bytes_combined * double(columns_iterated);
  const double needed = bytes_a_state * double(m) * double(N) * n_threads / gibibyte;
  const double machine = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) / gibibyte;
  if (needed <= machine) return;
  throw Error(fmt::format(
      "stability over a rotation: at {:.6g} rad/s (speed times the symmetry of the disc) {} modes "
      "at {} angles of the disc need {:.3g} gibibyte, and the machine has {:.3g} GiB; the disc is "
      "not axisymmetric: mesh it so, or keep fewer modes in [body]",
      step, m / 2, N, needed, machine));
}

std::vector<NearGroup> near_groups(const TurningModes& modes, double tolerance,
                                   std::optional<GroupsAsked> asked)
{
  Sets sets(modes.lambda);
  std::vector<char> wanted(static_cast<std::size_t>(modes.size()), 1);
  const SecondOrder order = unite_near(sets, modes);
  if (asked) wanted = may_be_wanted(sets, modes, order, *asked);
  const auto is_wanted = [&](Index set) {
    return std::ranges::any_of(sets.states(set),
                               [&](Index i) { return wanted[static_cast<std::size_t>(i)] != 0; });
  };
  std::vector<std::optional<NearGroup>> done(static_cast<std::size_t>(modes.size()));
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<States> open;
    for (const Index set : sets.sets()) {
      if (!is_wanted(set)) continue;
      const auto& group = done[static_cast<std::size_t>(set)];
      if (!group || group->states != sets.states(set)) open.push_back(sets.states(set));
    }
    for (Reduced& one : reduced(modes, tolerance, open)) {
      if (const auto* link = std::get_if<Link>(&one)) {
        sets.unite(*link);
        changed = true;
      } else {
        auto& group = std::get<NearGroup>(one);
        if (!asked) group.X = {};  // of all motions they would fill the memory
        done[static_cast<std::size_t>(group.states.front())] = std::move(group);
      }
    }
  }
  std::vector<NearGroup> groups;
  for (const Index set : sets.sets()) {
    if (is_wanted(set))
      groups.push_back(std::move(*done[static_cast<std::size_t>(set)]));
    else if (asked->with_estimates)
      groups.push_back(equations_alone(sets.states(set), sets, modes, order));
    else
      continue;
    groups.back().has_mirror = !sets.is_its_own_mirror(set);
  }
  return groups;
}

}  // namespace chladni::squeal
