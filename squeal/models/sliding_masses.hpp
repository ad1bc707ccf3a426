#pragma once

#include <Eigen/Core>

#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "squeal/brake_options.hpp"
#include "squeal/friction.hpp"
#include "squeal/model_options.hpp"
#include "squeal/models/brake.hpp"

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

/// Masses that rub, with x = (q w, q'), w^2 = K_11 / M_1. The first contact point appears as the
/// upper pad of a pair and the last one as the lower pad: `z` is the observed coordinate of both,
/// f_t the friction on the mass.
class SlidingBrake final : public LumpedBrake {
 public:
  using Model = std::variant<Oscillator, TwoMasses, TiltingBlock>;

  explicit SlidingBrake(const Model& model);

  Eigen::MatrixXd state_matrix(double speed) const override;
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  std::vector<ParameterValue> parameters() const override;
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;

  Eigen::Index size() const override { return 2 * masses_.M.size(); }
  Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const override;
  ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const override;
  Eigen::VectorXd start(double displacement) const override;
  double rest_height() const override { return 0.0; }

 private:
  Model model_;
  SlidingMasses masses_;
};

/// q = (x, y); the pad moves by y.
SlidingMasses sliding_masses(const Oscillator& oscillator);

Places places_in(Oscillator& oscillator);

/// Friction coefficient at which the frequencies of the undamped oscillator coincide and flutter
/// begins, mu = ((k_x - k_y - k_c)^2 / 4 + k_xy^2) / (k_xy k_c).
double flutter_friction(const Oscillator& oscillator);

}  // namespace chladni::squeal
