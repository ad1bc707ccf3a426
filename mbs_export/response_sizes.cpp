#include "mbs_export/response_sizes.hpp"

#include <numbers>

#include "common/eigen_every.hpp"
#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/body_option_error.hpp"
#include "mbs_export/held_body.hpp"
#include "mbs_export/held_modes.hpp"
#include "mbs_export/reference_response.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

int master_of(const ReducedSystem& reduced, int dof)
{
  if (const auto row = master_row(reduced, dof / 6, dof % 6)) return *row;
  throw BodyOptionError("keep.tolerance",
                        "responses can be compared with the FE model at masters only, and nodes of "
                        "a ring of harmonics are none");
}

/// What sizes are not below in a band: the least of both halves, until it is close to a size that
/// occurs.
class LeastSizes {
 public:
  explicit LeastSizes(const ReferenceResponse& reference) : reference_(reference) {}

  VectorXd between(double from, double to)
  {
    occurring_ = sizes_in_band(reference_, from, to).in_middle;
    return at_least(from, to, 0);
  }

 private:
  VectorXd at_least(double from, double to, int depth)
  {
    constexpr double close = 0.7;
    constexpr int deepest = 10;
    const SizesInBand sizes = sizes_in_band(reference_, from, to);
    occurring_ = occurring_.cwiseMin(sizes.in_middle);
    if (depth == deepest || (sizes.at_least.array() >= close * occurring_.array()).all())
      return sizes.at_least;
    const double middle = 0.5 * (from + to);
    const VectorXd lower = at_least(from, middle, depth + 1);
    return lower.cwiseMin(at_least(middle, to, depth + 1));
  }

  const ReferenceResponse& reference_;
  VectorXd occurring_;  ///< the least sizes of all frequencies that were looked at
};

/// All modes of the held body, and their motion at some DOFs.
struct Shapes {
  VectorXd omega;  ///< [n] rad/s
  MatrixXd B;      ///< [n x m]
};

/// Without rigid-body motions, and where masters are held, one eigenproblem is enough.
Shapes shapes_at(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                 const std::vector<int>& dofs)
{
  const HeldModeShapes modes = held_mode_shapes(reduced, fixed);
  if (modes.n_rigid == 0)
    return {modes.omega, attachment_motion(reduced, modes.X)(dofs, every).transpose()};
  const HeldBody body = held_body(reduced, fixed);
  return {body.constrained.omega, body.U(dofs, every).transpose()};
}

}  // namespace

ResponseSizes response_sizes(const ReferenceResponse& reference, const Tolerance& tolerance)
{
  constexpr Index n_bands = 24;
  const double end = 2.0 * std::numbers::pi * tolerance.up_to_Hz;
  ResponseSizes sizes{.rows = {},
                      .names = {},
                      .unit = reference.unit,
                      .Omega = VectorXd::LinSpaced(n_bands + 1, 0.0, end),
                      .size = MatrixXd(reference.B.cols(), n_bands)};
  LeastSizes least(reference);
  for (Index g = 0; g < n_bands; ++g)
    sizes.size.col(g) = least.between(sizes.Omega[g], sizes.Omega[g + 1]);
  return sizes;
}

ResponseSizes response_sizes(const ReducedSystem& reduced, const BodyOptions& options)
{
  const LoadedDofs loads =
      loaded_dofs(reduced, held_dofs(reduced, options.fixed), options.interface_modes);
  const Shapes shapes = shapes_at(reduced, options.fixed, loads.dofs);
  const std::vector<int> moved = moved_modes(shapes.omega, shapes.B);
  ResponseSizes sizes =
      response_sizes(reference_modes(shapes.omega(moved), shapes.B(moved, every), loads),
                     options.keep.tolerance.value());
  sizes.names = loads.names;
  for (const int dof : loads.dofs) sizes.rows.push_back(master_of(reduced, dof));
  return sizes;
}

}  // namespace chladni::mbs_export
