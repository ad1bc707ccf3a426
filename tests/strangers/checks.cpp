#include "checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string_view>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::strangers {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double rounding = 1e-10;     // relative, of eigenvalues
constexpr double as_projected = 1e-9;  // K_r and M_r are those of T to this

double squared_omega(double f_Hz)
{
  return std::pow(2.0 * std::numbers::pi * f_Hz, 2);
}

bool is(const Reduction& how, std::string_view type)
{
  return how.type == type;
}

/// What lambda_i may be off by without anybody's fault.
double slack(const Spectrum& spectrum, std::size_t i)
{
  return rounding * spectrum.lambda[i] + spectrum.doubt[i];
}

/// What a solver by shift and invert at 0 may add that is stable in the norm: mu = 1 / lambda is
/// off by some units in the last place of the largest mu, and K by some of its norm.
double rounding_of_solver(const Spectrum& spectrum, std::size_t i)
{
  constexpr double units = 16.0 * std::numeric_limits<double>::epsilon();
  const auto& lambda = spectrum.lambda;
  const double lowest = *std::ranges::find_if(lambda, [](double l) { return l > 0.0; });
  return units * (lambda.back() + lambda[i] * (lambda[i] / lowest)) + spectrum.doubt[i];
}

void check_number_of_modes(const Reference& exact, const Reduction& how, const Answer& answer,
                           Failures& failures)
{
  if (!is(how, CMSCRAIGBAMPTON)) return;
  const CountBelow below = count_below(exact.held, squared_omega(how.cutoff_Hz));
  const int least = how.modes > 0 ? how.modes : how.cutoff_Hz > 0.0 ? below.surely : 0;
  if (answer.n_modes < least)
    failures.push_back({"too-few-modes", fmt::format("{} of {}", answer.n_modes, least)});
}

/// The lowest fixed-interface modes, each as often as it is there.
void check_modes(const Reference& exact, const Answer& answer, Failures& failures)
{
  constexpr double accuracy = 1e-8;  // of lambda; modes converge to 1e-7 in the vector
  std::vector<double> lambda;
  for (int k = 0; k < answer.n_modes; ++k)
    lambda.push_back(answer.K_r(answer.n_masters + k, answer.n_masters + k));
  std::ranges::sort(lambda);
  if (lambda.size() > exact.held.lambda.size()) {
    failures.push_back(
        {"too-many-modes", fmt::format("{} of {}", lambda.size(), exact.held.lambda.size())});
    return;
  }
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    const double error = std::abs(lambda[i] - exact.held.lambda[i]);
    if (error <= accuracy * exact.held.lambda[i] + rounding_of_solver(exact.held, i)) continue;
    // Of forty within a hundred-thousandth a few may be found before the lowest, if that is said.
    constexpr double cluster = 1e-4;
    if (answer.quality.modes.missing > 0 && error < cluster * exact.held.lambda[i]) continue;
    failures.push_back(
        {"other-modes", fmt::format("mode {} of {}: {:.10g} instead of {:.10g}", i, lambda.size(),
                                    lambda[i], exact.held.lambda[i])});
    return;
  }
}

/// |T^T A T - A_r| against what round-off in T^T |A| T is worth.
double projection_error(const MatrixXd& T, const MatrixXd& A, const MatrixXd& A_r)
{
  const MatrixXd difference = T.transpose() * A * T - A_r;
  const MatrixXd size = T.cwiseAbs().transpose() * A.cwiseAbs() * T.cwiseAbs();
  double worst = 0.0;
  for (Index j = 0; j < size.cols(); ++j) {
    for (Index i = 0; i < size.rows(); ++i) {
      const double d = std::sqrt(size(i, i) * size(j, j));
      if (d > 0.0)
        worst = std::max(worst, std::abs(difference(i, j)) / d);
      else if (difference(i, j) != 0.0)
        worst = 1.0;
    }
  }
  return worst;
}

/// What a solver by shift and invert at 0 leaves between the first mode and the last, both of unit
/// length: some units in the last place of 1 / lambda_1 in 1 / lambda_k.
double rounding_of_modes(const Answer& answer)
{
  constexpr double units = 16.0 * std::numeric_limits<double>::epsilon();
  if (answer.n_modes == 0) return 0.0;
  const VectorXd lambda = answer.K_r.diagonal().tail(answer.n_modes);
  return units * lambda.maxCoeff() / lambda.minCoeff();
}

void check_projection(const Reference& exact, const Answer& answer, Failures& failures)
{
  const double of_K = projection_error(answer.T, exact.K, answer.K_r);
  const double of_M = projection_error(answer.T, exact.M, answer.M_r);
  const double allowed = as_projected + rounding_of_modes(answer);
  if (of_K <= allowed && of_M <= allowed) return;
  failures.push_back(
      {"projection", fmt::format("K_r is off by {:.1e}, M_r by {:.1e}", of_K, of_M)});
}

/// Reported eigenvalue i stands against the full one after the rigid motions.
void check_eigenvalues(const Reference& exact, const Answer& answer, Failures& failures)
{
  const auto n_rigid = static_cast<std::size_t>(exact.n_rigid);
  if (answer.quality.n_zero != exact.n_free_rigid) {
    failures.push_back({"rigid-motions", fmt::format("{} instead of {}", answer.quality.n_zero,
                                                     exact.n_free_rigid)});
    return;
  }
  if (n_rigid + answer.lambda.size() > exact.whole.lambda.size()) {
    failures.push_back({"too-many", fmt::format("{} frequencies of {}", answer.lambda.size(),
                                                exact.whole.lambda.size() - n_rigid)});
    return;
  }
  for (std::size_t i = 0; i < answer.lambda.size(); ++i) {
    const double lambda = exact.whole.lambda[n_rigid + i];
    const double allowed = as_projected * lambda + rounding_of_solver(exact.whole, n_rigid + i) +
                           answer.rounding_of(i) * lambda;
    if (answer.lambda[i] >= lambda - allowed) continue;
    failures.push_back(
        {"below", fmt::format("frequency {}: lambda {:.12g} is {:.1e} below {:.12g}", i,
                              answer.lambda[i], 1.0 - answer.lambda[i] / lambda, lambda)});
    return;
  }
}

void check_bounds(const Reference& exact, const Answer& answer, Failures& failures)
{
  const auto n_rigid = static_cast<std::size_t>(exact.n_rigid);
  for (std::size_t i = 0; i < answer.bounds.size(); ++i) {
    const double lambda = exact.whole.lambda[n_rigid + i];
    const double error = answer.lambda[i] / lambda - 1.0;
    if (answer.bounds[i] >= error - slack(exact.whole, n_rigid + i) / lambda) continue;
    failures.push_back({"bound", fmt::format("frequency {} of {}: bound {:.3g}, error {:.3g}", i,
                                             answer.bounds.size(), answer.bounds[i], error)});
    return;
  }
}

/// eta, with what rounding adds, bounds the distance to some eigenvalue.
void check_distances(const Reference& exact, const Answer& answer, Failures& failures)
{
  for (std::size_t i = 0; i < answer.eta2.size(); ++i) {
    const auto near = [&](std::size_t j) {
      const double lambda = exact.whole.lambda[j];
      return std::abs(answer.lambda[i] - lambda) <=
             (std::sqrt(answer.eta2[i]) + answer.rounding[i]) * lambda + slack(exact.whole, j);
    };
    bool found = false;
    for (std::size_t j = 0; j < exact.whole.lambda.size() && !found; ++j) found = near(j);
    if (found || std::sqrt(answer.eta2[i]) >= 1.0) continue;  // infinity is an eigenvalue too
    failures.push_back({"eta", fmt::format("frequency {}: no eigenvalue within {:.3g} of {:.12g}",
                                           i, std::sqrt(answer.eta2[i]), answer.lambda[i])});
    return;
  }
}

void check_count(const char* what, const CMSCount& count, const Spectrum& spectrum,
                 Failures& failures)
{
  if (count.upto == 0.0) return;
  const CountBelow below = count_below(spectrum, squared_omega(count.upto));
  if (count.missing >= 0 && count.missing == count.expected - count.found &&
      count.expected >= below.surely && count.expected <= below.perhaps)
    return;
  failures.push_back(
      {"count", fmt::format("{}: {} expected, {} found, {} missing below {:.12g}; "
                            "there are {} to {}",
                            what, count.expected, count.found, count.missing,
                            squared_omega(count.upto), below.surely, below.perhaps)});
}

std::vector<int> all_but(const std::vector<int>& rows, Index n)
{
  std::vector<int> others;
  for (int i = 0; i < n; ++i)
    if (std::ranges::find(rows, i) == rows.end()) others.push_back(i);
  return others;
}

/// Of the reduced model.
std::vector<int> held_rows(const Pencil& pencil)
{
  std::vector<int> rows;
  for (std::size_t i = 0; i < pencil.masters.size(); ++i)
    if (std::ranges::find(pencil.held, pencil.masters[i]) != pencil.held.end())
      rows.push_back(static_cast<int>(i));
  return rows;
}

/// Every frequency of the range is in the reduced model and as good as promised.
void check_tolerance(const Reference& exact, const Reduction& how, const Answer& answer,
                     Failures& failures)
{
  if (!(how.tolerance > 0.0)) return;
  const std::vector<int> free = all_but(held_rows(exact.pencil), answer.K_r.rows());
  const Spectrum reduced = spectrum(answer.K_r(free, free), answer.M_r(free, free), exact.n_rigid);
  const double last = squared_omega(how.up_to_Hz);
  for (std::size_t i = exact.n_rigid; i < exact.whole.lambda.size(); ++i) {
    if (exact.whole.lambda[i] >= last) return;
    const double error = i < reduced.lambda.size()
                             ? std::sqrt(reduced.lambda[i] / exact.whole.lambda[i]) - 1.0
                             : std::numeric_limits<double>::infinity();
    if (error <= how.tolerance) continue;
    failures.push_back({"tolerance", fmt::format("frequency {}: error {:.3g} for {:.3g}",
                                                 i - exact.n_rigid, error, how.tolerance)});
    return;
  }
}

/// Modes of the body under its support come out as they went in; Rubin's are those of the free one.
void check_free_modes(const Reference& exact, const Reduction& how, const Answer& answer,
                      Failures& failures)
{
  const bool are_of_support = is(how, CMSMIXED) || exact.pencil.held.empty();
  if (!are_of_support || !(is(how, CMSRUBIN) || is(how, CMSMIXED))) return;
  constexpr double accuracy = 1e-8;
  const auto n_rigid = static_cast<std::size_t>(exact.n_rigid);
  for (std::size_t i = 0; i < static_cast<std::size_t>(how.modes); ++i) {
    if (i >= answer.lambda.size())  // the list may end at the last mode that is certified
      return;
    const double lambda = exact.whole.lambda[n_rigid + i];
    const double allowed = accuracy * lambda + rounding_of_solver(exact.whole, n_rigid + i) +
                           answer.rounding_of(i) * lambda;
    if (std::abs(answer.lambda[i] - lambda) <= allowed) continue;
    failures.push_back({"free-modes", fmt::format("frequency {}: lambda {:.12g} instead of {:.12g}",
                                                  i, answer.lambda[i], lambda)});
    return;
  }
}

/// How many of the motions without energy the support prevents. In coordinates of unit stiffness
/// each of them has the length 1, and rows that none moves hold round-off.
int rank_of_held_motions(const Reference& exact)
{
  constexpr double none = 1e-11;
  if (exact.n_rigid == 0 || exact.pencil.held.empty()) return 0;
  const VectorXd scale = exact.K.diagonal().unaryExpr(
      [](double K_ii) { return K_ii > 0.0 ? 1.0 / std::sqrt(K_ii) : 1.0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(
      MatrixXd(scale.asDiagonal() * exact.K * scale.asDiagonal()));
  const MatrixXd motions = eigen.eigenvectors().leftCols(exact.n_rigid);
  const Eigen::JacobiSVD<MatrixXd> at_held(MatrixXd(motions(exact.pencil.held, Eigen::all)));
  return static_cast<int>((at_held.singularValues().array() > none).count());
}

}  // namespace

Reference reference(const Pencil& pencil)
{
  Reference exact{.pencil = pencil,
                  .K = dense(pencil.K, pencil.n),
                  .M = dense(pencil.M, pencil.n),
                  .n_rigid = pencil.n_rigid,
                  .n_free_rigid = pencil.n_rigid};
  if (!pencil.refusal.empty()) return exact;
  const std::vector<int> free = all_but(pencil.held, pencil.n);
  exact.n_rigid = pencil.n_rigid - rank_of_held_motions(exact);
  exact.whole = spectrum(exact.K(free, free), exact.M(free, free), exact.n_rigid);
  exact.held = held_spectrum(exact.K, exact.M, pencil.masters);
  return exact;
}

void check_spectrum(const Reference& exact, const Answer& answer, Failures& failures)
{
  check_eigenvalues(exact, answer, failures);
  check_count("model", answer.quality.model, exact.whole, failures);
  check_count("complete", answer.quality.complete, exact.whole, failures);
  if (answer.quality.n_zero != exact.n_free_rigid) return;
  check_bounds(exact, answer, failures);
  check_distances(exact, answer, failures);
}

namespace {

/// Whether a message says that M has too few digits, of an M that is singular to nine of them:
/// round-off decides then how far its pairs come, on other ranks otherwise.
bool lacks_digits(const Reference& exact, const std::string& message)
{
  constexpr double nine_digits = 1e-9;  // of a matrix with unit diagonal
  const bool says_so = message.find("M is nearly singular") != std::string::npos ||
                       message.find("the mass of a coordinate is round-off") != std::string::npos;
  if (!says_so) return false;
  const VectorXd d = exact.M.diagonal();
  const VectorXd scale = (d.array() > 0.0).select(d.array().rsqrt(), 0.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(
      MatrixXd(scale.asDiagonal() * exact.M * scale.asDiagonal()), Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] < nine_digits;
}

/// The property that a refusal of a sound pencil lacks.
std::string refused(const Reference& exact, const std::string& message)
{
  return lacks_digits(exact, message) ? "digits-of-M" : "refused";
}

}  // namespace

Failures check_refusal(const Pencil& pencil, const Answer& answer)
{
  if (!answer.code) return {{"accepted", "it must be refused: " + pencil.refusal}};
  std::istringstream reasons(pencil.refusal);
  for (std::string reason; std::getline(reasons, reason, '|');)
    if (answer.message.find(reason) != std::string::npos) return {};
  return {{"unclear", answer.message}};
}

Failures check(const Reference& exact, const Reduction& how, const Answer& answer)
{
  if (answer.code) return {{refused(exact, answer.message), answer.message}};
  Failures failures;
  check_number_of_modes(exact, how, answer, failures);
  if (is(how, CMSCRAIGBAMPTON)) check_modes(exact, answer, failures);
  check_projection(exact, answer, failures);
  check_free_modes(exact, how, answer, failures);
  if (is(how, CMSCRAIGBAMPTON)) check_count("modes", answer.quality.modes, exact.held, failures);
  check_spectrum(exact, answer, failures);
  if (answer.quality.n_zero == exact.n_free_rigid) check_tolerance(exact, how, answer, failures);
  return failures;
}

Failures check(const Reference& exact, int n, double target, const Eigenpairs& pairs)
{
  constexpr double accuracy = 1e-8;
  constexpr double of_residual = 1e-8;
  if (pairs.code) return {{"refused", pairs.message}};
  Failures failures;
  if (std::ssize(pairs.lambda) < n)
    failures.push_back({"not-converged", fmt::format("{} of {}", pairs.lambda.size(), n)});
  const double worst = pairs.residual.empty() ? 0.0 : std::ranges::max(pairs.residual);
  if (!(worst <= of_residual)) failures.push_back({"residual", fmt::format("{:.1e}", worst)});
  std::vector<std::size_t> order(exact.whole.lambda.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {},
                           [&](std::size_t i) { return std::abs(exact.whole.lambda[i] - target); });
  std::vector<double> expected, found(pairs.lambda);
  found.resize(std::min<std::size_t>(found.size(), n));
  for (std::size_t i = 0; i < found.size(); ++i) expected.push_back(exact.whole.lambda[order[i]]);
  std::ranges::sort(expected);
  std::ranges::sort(found);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double scale = std::max(std::abs(expected[i]), std::abs(target));
    if (std::abs(found[i] - expected[i]) <=
        accuracy * scale + rounding_of_solver(exact.whole, order[i]))
      continue;
    failures.push_back({"eigenvalues", fmt::format("{} of {}: {:.12g} instead of {:.12g}", i,
                                                   found.size(), found[i], expected[i])});
    break;
  }
  return failures;
}

double least_of_slaves(const Reference& exact)
{
  std::vector<int> slaves;
  for (int i = 0; i < exact.pencil.n; ++i)
    if (std::ranges::find(exact.pencil.masters, i) == exact.pencil.masters.end())
      slaves.push_back(i);
  if (slaves.empty()) return 1.0;
  const MatrixXd K_ss = exact.K(slaves, slaves);
  if (!(K_ss.diagonal().minCoeff() > 0.0)) return 0.0;
  const VectorXd scale = K_ss.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(
      scale.asDiagonal() * K_ss * scale.asDiagonal(), Eigen::EigenvaluesOnly);
  return std::max(0.0, eigen.eigenvalues()[0]);
}

namespace {

/// The largest changes of entries of K_G and M_G.
struct Rounding {
  double K, M;
};

/// What the rounding of the entries of K and M does to K_G and M_G, with the constraint modes
/// T = [I; Psi]. K_G = T^T K T is stationary in Psi, so that a change E of K changes it by T^T E T.
/// Psi changes by -K_ss^-1 E_s T, and M_G = T^T M T with it. Ranks eliminate in other orders, which
/// is as good as such a change (the backward error of Cholesky's method is one of the entries, some
/// units of sqrt(K_ii K_jj)): they cannot agree better than this, and no program can that takes K
/// as it is. With the diagonal of K_ss made 1 it is at most n eps K_mm / lambda_min: for Hilbert's
/// matrix one unit is 1e-8 of K_G and 3e-8 of M_G, where ranks differ by 3e-9.
Rounding rounding_of_entries(const Reference& exact, const Answer& answer)
{
  constexpr double units = 2.0 * std::numeric_limits<double>::epsilon();
  const std::vector<int> slaves = all_but(exact.pencil.masters, exact.pencil.n);
  const MatrixXd T = answer.T.leftCols(answer.n_masters).cwiseAbs();
  const MatrixXd K = exact.K.cwiseAbs(), M = exact.M.cwiseAbs(), K_ss = exact.K(slaves, slaves);
  const MatrixXd inverse = Eigen::PartialPivLU<MatrixXd>(K_ss).inverse();
  const MatrixXd of_Psi = inverse.cwiseAbs() * (K(slaves, Eigen::all) * T);
  const MatrixXd of_M =
      T.transpose() * M * T + 2.0 * of_Psi.transpose() * (M(slaves, Eigen::all) * T);
  return {.K = units * (T.transpose() * K * T).maxCoeff(), .M = units * of_M.maxCoeff()};
}

}  // namespace

Failures compare(const Reference& exact, const Answer& all, const Answer& one)
{
  constexpr double same = 1e-9;
  Failures failures;
  const auto differs = [&](const std::string& figures) { failures.push_back({"ranks", figures}); };
  if ((all.code == 0) != (one.code == 0)) {
    const bool is_due = lacks_digits(exact, all.code ? all.message : one.message);
    failures.push_back({is_due ? "digits-of-M" : "ranks",
                        fmt::format("all: {}; one: {}", all.message, one.message)});
    return failures;
  }
  if (all.code) return failures;
  if (all.n_modes != one.n_modes || all.quality.n_zero != one.quality.n_zero) {
    differs(fmt::format("{} modes, {} rigid motions; one: {}, {}", all.n_modes, all.quality.n_zero,
                        one.n_modes, one.quality.n_zero));
    return failures;
  }
  if (all.lambda.size() != one.lambda.size() || all.bounds.size() != one.bounds.size()) {
    failures.push_back(
        {"length", fmt::format("{} frequencies, {} bounds; one: {}, {}", all.lambda.size(),
                               all.bounds.size(), one.lambda.size(), one.bounds.size())});
  }
  for (std::size_t i = 0; i < std::min(all.lambda.size(), one.lambda.size()); ++i) {
    const std::size_t at = exact.n_rigid + i;
    const bool is_known = at < exact.whole.lambda.size();
    const double allowed = (same + all.rounding_of(i) + one.rounding_of(i)) * one.lambda[i] +
                           (is_known ? 2.0 * rounding_of_solver(exact.whole, at) : 0.0);
    if (std::abs(all.lambda[i] - one.lambda[i]) <= allowed) continue;
    differs(
        fmt::format("frequency {}: lambda {:.12g}; one: {:.12g}", i, all.lambda[i], one.lambda[i]));
    break;
  }
  const Index m = all.n_masters;
  const auto difference = [m](const MatrixXd& A, const MatrixXd& B, double least) {
    const double size = std::max(B.topLeftCorner(m, m).cwiseAbs().maxCoeff(), least);
    return (A - B).topLeftCorner(m, m).cwiseAbs().maxCoeff() / (size > 0.0 ? size : 1.0);
  };
  const double own_mass = exact.M.diagonal()(exact.pencil.masters).maxCoeff();
  const double of_K = difference(all.K_r, one.K_r, 0.0);
  const double of_M = difference(all.M_r, one.M_r, own_mass);
  if (of_K <= same && of_M <= same) return failures;
  constexpr double most = 1e-7;  // whatever K is
  const Rounding of_entries = rounding_of_entries(exact, one);
  const double size_K = one.K_r.topLeftCorner(m, m).cwiseAbs().maxCoeff();
  const double size_M = std::max(one.M_r.topLeftCorner(m, m).cwiseAbs().maxCoeff(), own_mass);
  if (of_K > same + std::min(most, of_entries.K / size_K) ||
      of_M > same + std::min(most, of_entries.M / size_M))
    differs(fmt::format("K_G by {:.1e}, M_G by {:.1e}", of_K, of_M));
  return failures;
}

}  // namespace chladni::strangers
