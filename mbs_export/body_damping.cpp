#include "mbs_export/body_damping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mbs_export/body_option_error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Linear between the frequencies of the table.
double ratio_at(double f_Hz, Index mode, const Damping& damping)
{
  const std::vector<double>& at = damping.at_Hz;
  constexpr double same = 1e-9;
  if (f_Hz < at.front() * (1.0 - same) || f_Hz > at.back() * (1.0 + same)) {
    throw BodyOptionError(
        "damping.ratio",
        fmt::format("mode {} has {:.6g} Hz, and the ratios are given from {:.6g} to {:.6g} Hz; add "
                    "a frequency, or keep fewer modes",
                    mode + 1, f_Hz, at.front(), at.back()));
  }
  const auto above = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(at, f_Hz) - at.begin(), 1,
                                                std::ssize(at) - 1);
  const auto i = static_cast<std::size_t>(above);
  const double s = std::clamp((f_Hz - at[i - 1]) / (at[i] - at[i - 1]), 0.0, 1.0);
  return (1.0 - s) * damping.ratios[i - 1] + s * damping.ratios[i];
}

VectorXd ratios_of(const VectorXd& omega, const Damping& damping)
{
  const Index n = omega.size();
  VectorXd zeta = VectorXd::Zero(n);
  if (!damping.at_Hz.empty()) {
    for (Index i = 0; i < n; ++i)
      if (omega[i] > 0.0) zeta[i] = ratio_at(omega[i] / (2.0 * std::numbers::pi), i, damping);
    return zeta;
  }
  if (damping.ratios.size() == 1) return VectorXd::Constant(n, damping.ratios[0]);
  if (Index(damping.ratios.size()) != n) {
    throw BodyOptionError(
        "damping.ratio",
        fmt::format("{} ratios for {} modes; give one for all, one for each, or a table over the "
                    "frequency",
                    damping.ratios.size(), n));
  }
  return Eigen::Map<const VectorXd>(damping.ratios.data(), n);
}

/// Of dampers and loss factors of the model.
BodyDamping of_model(const ReducedSystem& reduced, const BodyCoordinates& modes)
{
  if (reduced.C.size() == 0 && reduced.H.size() == 0) {
    throw BodyOptionError("damping.type",
                          "'matrix' needs dampers or loss factors, and this system has none");
  }
  const Index n = modes.omega.size();
  BodyDamping damping{.C = MatrixXd::Zero(n, n)};
  if (reduced.C.size() > 0) damping.C = modes.T.transpose() * reduced.C * modes.T;
  if (reduced.H.size() == 0) return damping;
  const MatrixXd H = modes.T.transpose() * reduced.H * modes.T;
  damping.H = 0.5 * (H + H.transpose());
  damping.C += viscous_equivalent(damping.H, modes.omega);
  return damping;
}

}  // namespace

MatrixXd viscous_equivalent(const MatrixXd& H, const VectorXd& omega)
{
  const VectorXd scale =
      omega.unaryExpr([](double w) { return w > 0.0 ? 1.0 / std::sqrt(w) : 0.0; });
  return scale.asDiagonal() * H * scale.asDiagonal();
}

BodyDamping body_damping(const ReducedSystem& reduced, const BodyCoordinates& modes,
                         const Damping& damping)
{
  const auto& omega = modes.omega;
  switch (damping.type) {
    case Damping::Type::none:
      return {};
    case Damping::Type::rayleigh:
      return {.C = VectorXd(damping.alpha + damping.beta * omega.array().square()).asDiagonal()};
    case Damping::Type::matrix:
      return of_model(reduced, modes);
    case Damping::Type::modal:
      break;
  }
  return {.C = VectorXd(2.0 * ratios_of(omega, damping).array() * omega.array()).asDiagonal()};
}

}  // namespace chladni::mbs_export
