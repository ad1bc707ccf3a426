#include "random_pencils.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "building.hpp"
#include "dice.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::strangers {

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// A spectrum without zeros, ascending.
struct Values {
  std::vector<double> lambda;
  std::string words;
};

Values draw_values(Dice& dice, int n)
{
  const int kind = dice.integer(0, 5);
  const double widest = dice.spread(3.0, 1e6);
  std::vector<double> lambda(n);
  for (double& value : lambda) value = dice.spread(1.0, widest);
  if (kind == 1) {  // even
    for (int i = 0; i < n; ++i) lambda[i] = 1.0 + i;
  } else if (kind == 2) {  // a few values, each several times
    const int n_values = dice.integer(1, 1 + n / 4);
    for (int i = n_values; i < n; ++i) lambda[i] = lambda[dice.integer(0, n_values - 1)];
  } else if (kind == 3) {  // partners close to each other
    const double gap = dice.spread(1e-12, 1e-3);
    for (int i = 1; i < n; i += 2) lambda[i] = lambda[i - 1] * (1.0 + gap);
  } else if (kind == 4) {  // one cluster and the rest
    const int n_equal = dice.integer(2, n);
    const double gap = dice.chance(0.5) ? 0.0 : dice.spread(1e-12, 1e-6);
    for (int i = 1; i < n_equal; ++i) lambda[i] = lambda[0] * (1.0 + gap * i);
  } else if (kind == 5) {  // the lowest far below
    lambda[0] = 1.0 / dice.spread(10.0, 1e5);
  }
  std::ranges::sort(lambda);
  const char* names[] = {"spread", "even", "multiple", "partners", "cluster", "one low"};
  return {lambda, fmt::format("{} to {:.1e}", names[kind], widest)};
}

/// H_1 ... H_k of reflections: few leave it nearly diagonal.
MatrixXd draw_orthogonal(Dice& dice, int n)
{
  MatrixXd Q = MatrixXd::Identity(n, n);
  for (int k = dice.integer(0, 3); k > 0; --k) {
    VectorXd v(n);
    for (double& x : v) x = dice.chance(0.3) ? 0.0 : dice.uniform(-1.0, 1.0);
    if (v.squaredNorm() == 0.0) continue;
    Q -= (2.0 / v.squaredNorm()) * (Q * v) * v.transpose();
  }
  return Q;
}

/// A congruence that is not orthogonal; it changes no eigenvalue.
MatrixXd draw_congruence(Dice& dice, int n)
{
  MatrixXd L = MatrixXd::Identity(n, n);
  const double widest = dice.spread(1.0, 30.0);
  for (int i = 0; i < n; ++i) {
    L(i, i) = dice.spread(1.0 / widest, widest);
    if (i > 0 && dice.chance(0.5)) L(i, i - 1) = dice.uniform(-0.5, 0.5);
  }
  return L;
}

void set(std::vector<Entry>& A, const MatrixXd& values)
{
  std::vector<int> all(values.rows());
  std::iota(all.begin(), all.end(), 0);
  add(A, all, 0.5 * (values + values.transpose()));
}

/// K = L Q diag(lambda) Q^T L^T, M = L L^T; or, that M may be singular, K = L L^T and M of 1 /
/// lambda.
std::string fill_by_spectrum(Dice& dice, Pencil& pencil)
{
  const Values values = draw_values(dice, pencil.n);
  VectorXd lambda = VectorXd::Map(values.lambda.data(), pencil.n);
  const MatrixXd Q = draw_orthogonal(dice, pencil.n), L = draw_congruence(dice, pencil.n);
  const MatrixXd LQ = L * Q;
  if (dice.chance(0.5)) {
    pencil.n_rigid = dice.chance(0.3) ? dice.integer(1, 3) : 0;
    lambda.head(pencil.n_rigid).setZero();
    set(pencil.K, LQ * lambda.asDiagonal() * LQ.transpose());
    set(pencil.M, L * L.transpose());
    return "lambda " + values.words;
  }
  const int n_massless = dice.chance(0.5) ? dice.integer(1, pencil.n / 3) : 0;
  VectorXd mu = lambda.cwiseInverse();
  mu.tail(n_massless).setZero();
  set(pencil.K, L * L.transpose());
  set(pencil.M, LQ * mu.asDiagonal() * LQ.transpose());
  return fmt::format("mu {}, {} massless", values.words, n_massless);
}

/// A random tree of springs and some more; masses may vanish; some bodies are free.
std::string fill_by_springs(Dice& dice, Pencil& pencil)
{
  const double stiffest = dice.spread(1.0, 1e5), heaviest = dice.spread(1.0, 1e3);
  for (int i = 1; i < pencil.n; ++i) {
    const int other = dice.chance(0.5) ? i - 1 : dice.integer(0, i - 1);
    add_spring(pencil.K, other, i, dice.spread(1.0, stiffest));
  }
  for (int k = dice.integer(0, pencil.n); k > 0; --k) {
    const int i = dice.integer(0, pencil.n - 1), j = dice.integer(0, pencil.n - 1);
    if (i != j) add_spring(pencil.K, i, j, dice.spread(1.0, stiffest));
  }
  pencil.n_rigid = dice.chance(0.5) ? 1 : 0;
  if (pencil.n_rigid == 0) add_diagonal(pencil.K, dice.integer(0, pencil.n - 1), 1.0);
  const double without_mass = dice.chance(0.4) ? dice.uniform(0.0, 0.6) : 0.0;
  add_diagonal(pencil.M, 0, 1.0);
  for (int i = 1; i < pencil.n; ++i)
    if (!dice.chance(without_mass)) add_diagonal(pencil.M, i, dice.spread(1.0, heaviest));
  return fmt::format("springs to {:.1e}, masses to {:.1e}, {:.0f} % massless", stiffest, heaviest,
                     100.0 * without_mass);
}

/// Equal branches on a hub, row 0.
std::string fill_by_branches(Dice& dice, Pencil& pencil)
{
  const int length = dice.integer(1, 4);
  const int n_branches = std::max(1, (pencil.n - 1) / length);
  pencil.n = 1 + length * n_branches;
  std::vector<double> k(length), m(length);
  for (int i = 0; i < length; ++i) {
    k[i] = dice.spread(1.0, 100.0);
    m[i] = dice.spread(1.0, 10.0);
  }
  const double detuning = dice.chance(0.5) ? 0.0 : dice.spread(1e-10, 1e-2);
  for (int b = 0; b < n_branches; ++b) {
    for (int i = 0; i < length; ++i) {
      const int row = 1 + b * length + i;
      add_spring(pencil.K, i == 0 ? 0 : row - 1, row, k[i] * (1.0 + detuning * b));
      add_diagonal(pencil.M, row, m[i]);
    }
  }
  pencil.n_rigid = dice.chance(0.5) ? 1 : 0;
  if (pencil.n_rigid == 0) add_diagonal(pencil.K, 0, dice.spread(0.1, 100.0));
  add_diagonal(pencil.M, 0, dice.spread(0.1, 100.0));
  return fmt::format("{} branches of {}, detuned {:.1e}", n_branches, length, detuning);
}

void draw_masters(Dice& dice, Pencil& pencil, bool with_hub)
{
  std::vector<int> rows(pencil.n);
  std::iota(rows.begin(), rows.end(), 0);
  for (int i = pencil.n - 1; i > 0; --i) std::swap(rows[i], rows[dice.integer(0, i)]);
  const int most = std::max(pencil.n_rigid + 1, pencil.n / 3);
  const int n_m = std::max({1, pencil.n_rigid, dice.chance(0.3) ? 1 : dice.integer(1, most)});
  pencil.masters.assign(rows.begin(), rows.begin() + n_m);
  if (dice.chance(0.03)) pencil.masters = rows;  // no slaves are left
  if (with_hub && std::ranges::find(pencil.masters, 0) == pencil.masters.end())
    pencil.masters.front() = 0;
  for (const int i : pencil.masters)
    if (dice.chance(0.5)) pencil.held.push_back(i);
  if (dice.chance(0.5)) pencil.held.clear();
  if (dice.chance(0.1)) pencil.held = pencil.masters;
}

/// Two rows without mass, tied to another one by one bar of any direction: across it they move
/// with neither stiffness nor mass, but for round-off.
void add_massless_mechanism(Dice& dice, Pencil& pencil)
{
  const int x = pencil.n, y = pencil.n + 1;
  const double angle = dice.uniform(0.0, 2.0 * std::numbers::pi), k = dice.spread(1e-2, 1e4);
  const VectorXd bar = std::sqrt(k) * Eigen::Vector3d(std::cos(angle), std::sin(angle), -1.0);
  const std::array<int, 3> rows{x, y, dice.integer(0, pencil.n - 1)};
  add(pencil.K, rows, bar * bar.transpose());
  pencil.n += 2;
  for (const int row : {x, y})
    if (dice.chance(0.5)) pencil.masters.push_back(row);
}

/// What no method may take: the word of the refusal that is due. Empty where nothing is wrong.
std::string spoil(Dice& dice, Pencil& pencil)
{
  if (dice.chance(0.02)) {
    pencil.masters.clear();
    pencil.held.clear();
    return "0 masters";
  }
  if (std::ssize(pencil.masters) == pencil.n) return "leave at least one slave";
  if (!dice.chance(0.05)) return {};
  add_massless_mechanism(dice, pencil);
  return "stiffness|no mass|not positive definite";
}

/// Whether the slaves can move with all masters held, or nearly so: then any method may refuse.
bool moves_when_held(const Reference& exact)
{
  constexpr double nearly = 1e-9;  // of a matrix with unit diagonal
  return least_of_slaves(exact) < nearly;
}

double in_Hz(double lambda)
{
  return std::sqrt(lambda) / (2.0 * std::numbers::pi);
}

Reduction draw_reduction(Dice& dice, const Reference& exact)
{
  const int n_held = static_cast<int>(exact.held.lambda.size());
  const int n_rigid = exact.n_rigid, n = static_cast<int>(exact.whole.lambda.size());
  const int kind = n_held == 0 ? 0 : dice.integer(0, 8);
  if (kind == 0) return {.type = CMSGUYAN};
  if (n == n_rigid && kind >= 4) return {.type = CMSGUYAN};  // no mode to ask for
  const int few = std::max(1, (n - n_rigid) / 3);
  if (kind == 6) return {.type = CMSMIXED, .modes = dice.integer(1, few)};
  if (kind >= 7) {
    return {.type = kind == 7 ? CMSMIXED : CMSAUTO,
            .tolerance = dice.spread(1e-6, 1e-1),
            .up_to_Hz =
                in_Hz(exact.whole.lambda[dice.integer(n_rigid, n - 1)] * dice.uniform(0.9, 1.5))};
  }
  if (kind <= 2) return {.modes = dice.integer(1, n_held)};
  if (kind == 3) {
    return {.cutoff_Hz =
                in_Hz(exact.held.lambda[dice.integer(0, n_held - 1)] * dice.uniform(1.0001, 2.0))};
  }
  if (kind == 4) {
    return {.tolerance = dice.spread(1e-6, 1e-1),
            .up_to_Hz =
                in_Hz(exact.whole.lambda[dice.integer(n_rigid, n - 1)] * dice.uniform(0.9, 1.5))};
  }
  if (n <= exact.n_free_rigid) return {.type = CMSGUYAN};  // these are modes of the free body
  return {.type = CMSRUBIN, .modes = dice.integer(1, std::min(few, n - exact.n_free_rigid))};
}

std::string words_of(const Reduction& how)
{
  if (how.cutoff_Hz > 0.0) return fmt::format("all modes below {:.6g} Hz", how.cutoff_Hz);
  if (how.tolerance > 0.0) {
    return fmt::format("{} with tolerance {:.1e} up to {:.6g} Hz", how.type, how.tolerance,
                       how.up_to_Hz);
  }
  return fmt::format("{} with {} modes", how.type, how.modes);
}

}  // namespace

namespace {

/// One more try with the same dice.
Draw try_once(Dice& dice, std::uint64_t seed)
{
  const double size = dice.uniform();
  Pencil pencil{.name = fmt::format("seed {}", seed),
                .n = 5 + static_cast<int>(56.0 * size * size)};
  const int family = dice.integer(0, 3);
  const std::string kind = family <= 1   ? fill_by_spectrum(dice, pencil)
                           : family == 2 ? fill_by_springs(dice, pencil)
                                         : fill_by_branches(dice, pencil);
  draw_masters(dice, pencil, family == 3 && dice.chance(0.7));
  const std::string words =
      fmt::format("{} rows, {} masters, {} of them held, {} rigid motions, {}", pencil.n,
                  pencil.masters.size(), pencil.held.size(), pencil.n_rigid, kind);
  Reference matrices{
      .pencil = pencil, .K = dense(pencil.K, pencil.n), .M = dense(pencil.M, pencil.n)};
  return {.pencil = pencil, .exact = std::move(matrices), .how = {}, .words = words};
}

}  // namespace

Draw draw(std::uint64_t seed)
{
  Dice dice(seed);
  Draw drawn = try_once(dice, seed);
  while (moves_when_held(drawn.exact)) drawn = try_once(dice, seed);
  drawn.exact = reference(drawn.pencil);
  drawn.how = draw_reduction(dice, drawn.exact);
  drawn.how.is_shuffled = dice.chance(0.2);
  drawn.pencil.refusal = spoil(dice, drawn.pencil);
  // What was added may have moved the first mode above the cut-off, which is told first.
  if (drawn.how.cutoff_Hz > 0.0 && !drawn.pencil.refusal.empty())
    drawn.pencil.refusal += "|raise cutoff_Hz";
  drawn.words += "; " + words_of(drawn.how) + (drawn.how.is_shuffled ? ", shuffled" : "");
  if (!drawn.pencil.refusal.empty()) drawn.words += ", to be refused: " + drawn.pencil.refusal;
  return drawn;
}

}  // namespace chladni::strangers
