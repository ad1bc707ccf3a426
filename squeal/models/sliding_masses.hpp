#pragma once

#include <Eigen/Core>
#include <string_view>
#include <utility>
#include <vector>

#include "squeal/friction.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Up to three coordinates, without memory from the heap.
template <class Scalar>
using FewVector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, 3, 1>;
using FewMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// A point at which a mass is pressed on a moving surface or on another mass.
struct SlidingPoint {
  FewVector<double> along;   ///< W_t: W_t . q' is its velocity along the motion of the surface
  FewVector<double> normal;  ///< W_n: W_n . q is how far it is pressed into the surface
  double stiffness;          ///< k_c of the contact, N/m
  double preload;            ///< N_0, N
};

/// Masses on springs and dampers that rub at a few points. The coordinates q are counted from the
/// sliding equilibrium:
///   M q'' + D q' + K q = sum of W_t (T - T at rest) - W_n (N - N_0) over the points
///   N = N_0 + k_c W_n . q,   v_r = V - W_t . q',   T = mu(v) N v_r / v
struct SlidingMasses {
  FewVector<double> M;  ///< diagonal
  FewMatrix D, K;
  std::vector<SlidingPoint> points;
  Eigen::Index observed;  ///< the coordinate that counts as the motion of the pad
  double radius;          ///< V = radius * speed is the velocity of the surface, m
  FrictionLaw friction;
  ContactLaw law;
};

/// The numbers of a model by the keys of the scene. Names without a table are those that all brakes
/// share.
using Places = std::vector<std::pair<std::string_view, double*>>;

}  // namespace chladni::squeal
