#include "mbs_export/response_sizes.hpp"

#include <limits>
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

constexpr Index n_frequencies = 12;

/// n_frequencies of the range.
VectorXd frequencies(double Omega_max)
{
  return VectorXd::LinSpaced(n_frequencies, Omega_max / n_frequencies, Omega_max);
}

/// The place of the frequency that is nearest.
Index nearest(const VectorXd& Omega, double one)
{
  Index place = 0;
  (Omega.array() - one).abs().minCoeff(&place);
  return place;
}

/// Of the frequencies of the reference that are nearest to each; where there are none, of the two
/// on both sides.
MatrixXd least_sizes(const ReferenceResponse& reference, const VectorXd& Omega)
{
  constexpr double unknown = std::numeric_limits<double>::infinity();
  MatrixXd least = MatrixXd::Constant(reference.size.rows(), Omega.size(), unknown);
  const auto lower = [&](Index place, Index g) {
    least.col(place) = least.col(place).cwiseMin(reference.size.col(g)).eval();
  };
  const Index n = reference.Omega.size();
  for (Index g = 0; g < n; ++g) lower(nearest(Omega, reference.Omega[g]), g);
  for (Index place = 0; place < Omega.size(); ++place) {
    if (least.rows() == 0 || least(0, place) < unknown) continue;
    const Index above = (reference.Omega.array() < Omega[place]).count();
    if (above > 0) lower(place, above - 1);
    if (above < n) lower(place, above);
  }
  return least;
}

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
  const VectorXd Omega = frequencies(2.0 * std::numbers::pi * tolerance.up_to_Hz);
  return {.rows = {},
          .names = {},
          .unit = reference.unit,
          .Omega = Omega,
          .size = least_sizes(reference, Omega)};
}

ResponseSizes response_sizes(const ReducedSystem& reduced, const BodyOptions& options)
{
  const LoadedDofs loads =
      loaded_dofs(reduced, held_dofs(reduced, options.fixed), options.interface_modes);
  const Shapes shapes = shapes_at(reduced, options.fixed, loads.dofs);
  const std::vector<int> moved = moved_modes(shapes.omega, shapes.B);
  const ReferenceResponse reference = reference_response(
      shapes.omega(moved), shapes.B(moved, every), loads, options.keep.tolerance.value());
  ResponseSizes sizes = response_sizes(reference, *options.keep.tolerance);
  sizes.names = loads.names;
  for (const int dof : loads.dofs) sizes.rows.push_back(master_of(reduced, dof));
  return sizes;
}

}  // namespace chladni::mbs_export
