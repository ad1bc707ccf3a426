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

ReferenceResponse reference_response(const VectorXd& omega, const MatrixXd& B,
                                     const LoadedDofs& loads, const Tolerance& tolerance)
{
  const VectorXd unit = commensurable_units(omega, B, loads.is_moment);
  ReferenceResponse reference{.omega = omega,
                              .B = B * unit.asDiagonal(),
                              .unit = unit,
                              .clusters = mode_clusters(omega),
                              .resonances = {},
                              .Omega = {},
                              .H = {},
                              .size = {}};
  reference.resonances = resonances(reference, tolerance);
  reference.Omega = frequency_grid(reference, 2.0 * std::numbers::pi * tolerance.up_to_Hz);
  reference.size.resize(B.cols(), reference.Omega.size());
  for (Index g = 0; g < reference.Omega.size(); ++g) {
    const VectorXcd flexibility = damped_stiffness(omega, reference.Omega[g]).cwiseInverse();
    MatrixXcd H(B.cols(), B.cols());
    H.real() = reference.B.transpose() * (flexibility.real().asDiagonal() * reference.B);
    H.imag() = reference.B.transpose() * (flexibility.imag().asDiagonal() * reference.B);
    const VectorXd incoherent =
        contributions(omega, reference.B, reference.Omega[g]).rowwise().sum().cwiseSqrt();
    reference.size.col(g) = H.colwise().norm().transpose().cwiseMax(incoherent).cwiseMax(1e-300);
    reference.H.push_back(std::move(H));
  }
  return reference;
}

}  // namespace chladni::mbs_export
