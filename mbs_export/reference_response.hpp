#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "mbs_export/constrained_modes.hpp"
#include "mbs_export/loaded_dofs.hpp"

namespace chladni::mbs_export {

/// Frequency responses of the complete held body at its loaded DOFs, H(Omega) = B^T ((1 + i eta)
/// diag(omega^2) - Omega^2)^-1 B, at the frequencies where a basis is compared with it. The
/// hysteretic damping eta = 0.02 (1 % of critical damping at a resonance) is used for the
/// comparison only and limits the resonances.
struct ReferenceResponse {
  Eigen::VectorXd omega;  ///< [n] all modes of the held body, rad/s, ascending
  Eigen::MatrixXd B;      ///< [n x m] mode shapes at the loads, in units of each
  Eigen::VectorXd unit;   ///< [m] scales that make forces and moments comparable
  std::vector<ModeCluster> clusters;
  std::vector<int> resonances;      ///< clusters that the loads excite within the range
  Eigen::VectorXd Omega;            ///< [G], rad/s, ascending: resonances and between them
  std::vector<Eigen::MatrixXcd> H;  ///< [G] of [m x m]
  Eigen::MatrixXd size;             ///< [m x G] reference of relative errors of the response
};

/// The modes that a load moves, and rigid ones, or the first mode where there are none. The others,
/// such as modes in the plane of a disc that is loaded along its normal, are zeros in all
/// responses.
/// @return ascending, 0-based
std::vector<int> moved_modes(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B);

/// The modes of a reference alone, which tell its sizes in any band.
/// @param omega  [n] rad/s, all modes of the held body
/// @param B      [n x m] mode shapes at the loads
ReferenceResponse reference_modes(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                  const LoadedDofs& loads);

/// The reference of a body. Its grid has each resonance that contributes more than the tolerance,
/// points 1 % beside it on both sides, three frequencies between neighbours, and the ends of the
/// range.
/// @param omega  [n] rad/s, all modes of the held body
/// @param B      [n x m] mode shapes at the loads
ReferenceResponse reference_response(const Eigen::VectorXd& omega, const Eigen::MatrixXd& B,
                                     const LoadedDofs& loads, const Tolerance& tolerance);

/// The sizes that errors of the responses to each load are relative to, |H e_j|, or the root sum of
/// squares of what the modes contribute if it is larger.
struct SizesInBand {
  Eigen::VectorXd at_least;   ///< [m] what they are not below at any frequency of the band
  Eigen::VectorXd in_middle;  ///< [m] at one frequency
};

/// The sizes of `reference_modes` from one frequency to another one. Bounds are the tighter the
/// narrower the band.
/// @param from, to  rad/s, from < to
SizesInBand sizes_in_band(const ReferenceResponse& reference, double from, double to);

/// The diagonal of (1 + i eta) diag(omega^2) - Omega^2.
Eigen::VectorXcd damped_stiffness(const Eigen::VectorXd& omega, double Omega);
/// 1 + i eta.
std::complex<double> stiffness_factor();

}  // namespace chladni::mbs_export
