#include "mbs_export/response_sizes.hpp"

#include <numbers>

#include "common/eigen_every.hpp"
#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/body_option_error.hpp"
#include "mbs_export/held_body.hpp"
#include "mbs_export/response_error.hpp"

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

MatrixXd least_sizes(const ReferenceResponse& reference, const VectorXd& Omega)
{
  MatrixXd least = reference.size.rowwise().maxCoeff().replicate(1, Omega.size());
  for (Index g = 0; g < reference.Omega.size(); ++g) {
    auto around = least.col(nearest(Omega, reference.Omega[g]));
    around = around.cwiseMin(reference.size.col(g)).eval();
  }
  return least;
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
  const HeldBody body = held_body(reduced, options.fixed);
  const LoadedDofs loads = loaded_dofs(reduced, body.held, options.interface_modes);
  const MatrixXd B = body.U(loads.dofs, every).transpose();
  const ReferenceResponse reference =
      reference_response(body.constrained.omega, B, loads, options.keep.tolerance.value());
  ResponseSizes sizes = response_sizes(reference, *options.keep.tolerance);
  sizes.names = loads.names;
  for (const int dof : loads.dofs) sizes.rows.push_back(master_of(reduced, dof));
  return sizes;
}

}  // namespace chladni::mbs_export
