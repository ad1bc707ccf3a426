#include "mbs_export/reference_response.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

namespace {

constexpr double zeta = 0.01;  // of critical, in the comparison only

/// Units in which forces and moments count alike: each of the two divided by the square root of its
/// mean static flexibility.
VectorXd commensurable_units(const VectorXd& omega, const MatrixXd& B,
                             const std::vector<char>& is_moment)
{
  const VectorXd flexibility_k =
      (omega.array() > 0.0).select(omega.array().max(1e-300).square().inverse(), 0.0);
  const VectorXd flexibility = B.cwiseAbs2().transpose() * flexibility_k;
  double sum[2] = {0.0, 0.0};
  Index n[2] = {0, 0};
  for (Index j = 0; j < B.cols(); ++j) {
    const int unit = is_moment[std::size_t(j)] ? 1 : 0;
    sum[unit] += flexibility[j];
    ++n[unit];
  }
  VectorXd units = VectorXd::Ones(B.cols());
  for (Index j = 0; j < B.cols(); ++j) {
    const int unit = is_moment[std::size_t(j)] ? 1 : 0;
    if (sum[unit] > 0.0) units[j] = std::sqrt(static_cast<double>(n[unit]) / sum[unit]);
  }
  return units;
}

/// [m x n] squares of what each mode contributes to the response to each load.
MatrixXd contributions(const VectorXd& omega, const MatrixXd& B, double Omega)
{
  const VectorXd weight =
      B.rowwise().squaredNorm().array() / damped_stiffness(omega, Omega).array().abs2().max(1e-300);
  return B.cwiseAbs2().transpose() * weight.asDiagonal();
}

MatrixXcd flexibility(const VectorXd& omega, const MatrixXd& B, double Omega)
{
  const VectorXcd of_modes = damped_stiffness(omega, Omega).cwiseInverse();
  MatrixXcd H(B.cols(), B.cols());
  H.real() = B.transpose() * (of_modes.real().asDiagonal() * B);
  H.imag() = B.transpose() * (of_modes.imag().asDiagonal() * B);
  return H;
}

constexpr double no_size = 1e-300;  // of a load that moves nothing

VectorXd size_of(const MatrixXcd& H, const VectorXd& omega, const MatrixXd& B, double Omega)
{
  const VectorXd incoherent = contributions(omega, B, Omega).rowwise().sum().cwiseSqrt();
  return H.colwise().norm().transpose().cwiseMax(incoherent).cwiseMax(no_size);
}

/// Clusters that respond at their own frequency with more than `error` of what all modes do.
std::vector<int> resonances(const ReferenceResponse& reference, const Tolerance& tolerance)
{
  std::vector<int> excited;
  for (std::size_t c = 0; c < reference.clusters.size(); ++c) {
    const auto [first, end] = reference.clusters[c];
    const double Omega = reference.omega[first];
    if (Omega == 0.0 || Omega > 2.0 * std::numbers::pi * tolerance.up_to_Hz) continue;
    const MatrixXd squares = contributions(reference.omega, reference.B, Omega);
    const VectorXd own = squares.middleCols(first, end - first).rowwise().sum();
    const VectorXd all = squares.rowwise().sum();
    if ((own.array() > tolerance.error * tolerance.error * all.array()).any())
      excited.push_back(static_cast<int>(c));
  }
  return excited;
}

/// Ascending, without neighbours closer than a tenth of a resonance's width.
VectorXd thinned(std::vector<double> Omega)
{
  std::ranges::sort(Omega);
  std::vector<double> grid;
  for (const double x : Omega)
    if (grid.empty() || x - grid.back() > 0.1 * zeta * x) grid.push_back(x);
  return Eigen::Map<const VectorXd>(grid.data(), Index(grid.size()));
}

VectorXd frequency_grid(const ReferenceResponse& reference, double Omega_max)
{
  // A free body answers static loads with infinite motion; its range begins above zero.
  double lowest = reference.omega[0] == 0.0 ? 1e-2 * Omega_max : 0.0;
  if (!reference.resonances.empty()) {
    lowest = std::min(
        lowest,
        0.1 * reference.omega[reference.clusters[std::size_t(reference.resonances[0])].first]);
  }
  std::vector<double> knots{lowest}, grid{lowest, Omega_max};
  for (const int c : reference.resonances)
    knots.push_back(reference.omega[reference.clusters[std::size_t(c)].first]);
  for (std::size_t i = 1; i < knots.size(); ++i)
    for (const double x : {1.0 - zeta, 1.0, 1.0 + zeta})
      if (x * knots[i] <= Omega_max) grid.push_back(x * knots[i]);
  knots.push_back(Omega_max);
  for (std::size_t i = 1; i < knots.size(); ++i)
    for (const double part : {0.25, 0.5, 0.75})
      if (knots[i] > knots[i - 1]) grid.push_back(knots[i - 1] + part * (knots[i] - knots[i - 1]));
  std::erase_if(grid, [&](double x) { return x < lowest; });
  return thinned(std::move(grid));
}

}  // namespace

std::complex<double> stiffness_factor()
{
  return {1.0, 2.0 * zeta};
}

VectorXcd damped_stiffness(const VectorXd& omega, double Omega)
{
  return stiffness_factor() * omega.cwiseAbs2().cast<std::complex<double>>().array() -
         Omega * Omega;
}

std::vector<int> moved_modes(const VectorXd& omega, const MatrixXd& B)
{
  std::vector<int> moved;
  for (int k = 0; k < int(omega.size()); ++k)
    if (omega[k] == 0.0 || !B.row(k).isZero(0.0)) moved.push_back(k);
  if (moved.empty()) moved.push_back(0);
  return moved;
}

ReferenceResponse reference_modes(const VectorXd& omega, const MatrixXd& B, const LoadedDofs& loads)
{
  const VectorXd unit = commensurable_units(omega, B, loads.is_moment);
  return {.omega = omega,
          .B = B * unit.asDiagonal(),
          .unit = unit,
          .clusters = {},
          .resonances = {},
          .Omega = {},
          .H = {},
          .size = {}};
}

ReferenceResponse reference_response(const VectorXd& omega, const MatrixXd& B,
                                     const LoadedDofs& loads, const Tolerance& tolerance)
{
  ReferenceResponse reference = reference_modes(omega, B, loads);
  reference.clusters = mode_clusters(omega);
  reference.resonances = resonances(reference, tolerance);
  reference.Omega = frequency_grid(reference, 2.0 * std::numbers::pi * tolerance.up_to_Hz);
  reference.size.resize(B.cols(), reference.Omega.size());
  for (Index g = 0; g < reference.Omega.size(); ++g) {
    MatrixXcd H = flexibility(omega, reference.B, reference.Omega[g]);
    reference.size.col(g) = size_of(H, omega, reference.B, reference.Omega[g]);
    reference.H.push_back(std::move(H));
  }
  return reference;
}

SizesInBand sizes_in_band(const ReferenceResponse& reference, double from, double to)
{
  const VectorXd& omega = reference.omega;
  const MatrixXd& B = reference.B;
  const double s_from = from * from, s_to = to * to, s_middle = 0.5 * (s_from + s_to);
  const Eigen::ArrayXd lambda = omega.array().square(), norms = B.rowwise().norm();
  // |d|^2 of the modes, which is convex in s = Omega^2.
  const auto squares = [&](const auto& s) -> Eigen::ArrayXd {
    return (lambda - s).square() + (stiffness_factor().imag() * lambda).square();
  };
  const Eigen::ArrayXd largest = squares(s_from).max(squares(s_to));
  const VectorXd least_shares = (largest > 0.0).select(norms.square() / largest.max(no_size), 0.0);
  VectorXd at_least = (B.cwiseAbs2().transpose() * least_shares).cwiseSqrt().cwiseMax(no_size);
  const MatrixXcd H = flexibility(omega, B, std::sqrt(s_middle));
  const Eigen::ArrayXd smallest = squares(lambda.max(s_from).min(s_to));
  if (smallest.minCoeff() > 0.0) {  // |dH/ds| <= |B|^T |d|^-2 |B|
    const VectorXd slope = B.cwiseAbs().transpose() * (norms / smallest).matrix();
    at_least = at_least.cwiseMax(H.colwise().norm().transpose() - (s_to - s_middle) * slope);
  }
  return {.at_least = std::move(at_least), .in_middle = size_of(H, omega, B, std::sqrt(s_middle))};
}

}  // namespace chladni::mbs_export
