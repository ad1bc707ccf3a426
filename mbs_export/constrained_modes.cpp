#include "mbs_export/constrained_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/body_option_error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index;

constexpr double partner_gap = 1e-4;

double hertz(double omega)
{
  return omega / (2.0 * std::numbers::pi);
}

/// The modes asked for, true at each index.
std::vector<char> chosen(const Eigen::VectorXd& omega, const KeptModes& keep)
{
  const Index n = omega.size();
  std::vector<char> is_kept(static_cast<std::size_t>(n), !keep.list);
  if (keep.count) {
    if (*keep.count < 0 || *keep.count > n) {
      throw BodyOptionError(
          "keep.modes", fmt::format("{} modes asked for, the held body has {}", *keep.count, n));
    }
    std::fill(is_kept.begin() + *keep.count, is_kept.end(), false);
  } else if (keep.up_to_Hz) {
    for (Index i = 0; i < n; ++i) is_kept[i] = hertz(omega[i]) <= *keep.up_to_Hz;
  } else if (keep.list) {
    for (const int number : *keep.list) {
      if (number < 1 || number > n) {
        throw BodyOptionError("keep.list",
                              fmt::format("mode {} asked for, the modes are 1 to {}", number, n));
      }
      is_kept[number - 1] = true;
    }
  }
  return is_kept;
}

}  // namespace

ConstrainedModes constrained_modes(const ModeShift& shift)
{
  const linear::Eigenmodes elastic = linear::eigenmodes(shift.K_c, shift.M_c, shift.R_c);
  const Index n_rigid = shift.R_c.cols(), n_elastic = elastic.lambda.size();
  ConstrainedModes modes{.omega = Eigen::VectorXd::Zero(n_rigid + n_elastic),
                         .X = Eigen::MatrixXd(shift.K_c.rows(), n_rigid + n_elastic),
                         .n_rigid = static_cast<int>(n_rigid)};
  modes.omega.tail(n_elastic) = elastic.lambda.cwiseSqrt();
  modes.X << shift.R_c, elastic.X;
  return modes;
}

std::vector<ModeCluster> mode_clusters(const Eigen::VectorXd& omega)
{
  std::vector<ModeCluster> clusters;
  for (int first = 0, end; first < int(omega.size()); first = end) {
    for (end = first + 1; end < int(omega.size()); ++end)
      if (omega[end] - omega[end - 1] > partner_gap * omega[end]) break;
    clusters.push_back({first, end});
  }
  return clusters;
}

ModeSelection select_modes(const Eigen::VectorXd& omega, const KeptModes& keep)
{
  if (int(keep.count.has_value()) + int(keep.up_to_Hz.has_value()) + int(keep.list.has_value()) >
      1) {
    throw BodyOptionError("keep",
                          "give only one of a number of modes, a highest frequency, and a list");
  }
  const std::vector<char> asked = chosen(omega, keep);
  ModeSelection selection{.kept = {}, .neglected = {}, .n_partners = 0};
  for (const auto [first, end] : mode_clusters(omega)) {
    const auto n_asked = std::count(asked.begin() + first, asked.begin() + end, true);
    if (n_asked > 0) selection.n_partners += end - first - static_cast<int>(n_asked);
    for (int i = first; i < end; ++i)
      (n_asked > 0 ? selection.kept : selection.neglected).push_back(i);
  }
  if (selection.kept.empty()) {
    throw BodyOptionError(
        "keep", fmt::format("no mode is left; the lowest of {} has {:.6g} Hz", omega.size(),
                            omega.size() > 0 ? hertz(omega[0]) : 0.0));
  }
  return selection;
}

}  // namespace chladni::mbs_export
