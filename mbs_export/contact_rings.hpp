#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// The contact rings of a body, one for every attachment set of three or more nodes that lie at
/// equal angles on one circle about the z axis and whose displacement z is a master. With the nodal
/// rotations theta_r = theta . e_r and theta_t = theta . e_t the slopes are W_r = -theta_t and W_t
/// = theta_r; they are zero where the rotations x and y of a node are no masters.
/// @param attachment_modes  [6 n_nodes x n_modes]
std::vector<ContactRing> contact_rings(const ReducedSystem& reduced,
                                       const Eigen::MatrixXd& attachment_modes);

/// Circumferential Fourier coefficients: value(phi) = sum_n cosine_n cos(n phi) + sine_n sin(n
/// phi), n = 0 .. floor(N / 2), exact at the N nodes.
struct FourierCoefficients {
  Eigen::MatrixXd cosine;  ///< [floor(N / 2) + 1 x n_modes]
  Eigen::MatrixXd sine;    ///< [floor(N / 2) + 1 x n_modes]
};

/// The Fourier coefficients of values at equally spaced angles.
/// @param angles  [N], rad, equally spaced on the full circle
/// @param values  [N x n_modes] at these angles
FourierCoefficients fourier_coefficients(const Eigen::VectorXd& angles,
                                         const Eigen::MatrixXd& values);

}  // namespace chladni::mbs_export
