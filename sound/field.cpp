#include "sound/field.hpp"

#include <cmath>
#include <numbers>

#include "sound/air_mesh.hpp"

namespace chladni::sound {
namespace {

using Eigen::Index, Eigen::MatrixX3d, Eigen::MatrixXcd, Eigen::Vector3d;
using std::numbers::pi;
using Complex = std::complex<double>;
constexpr Complex i_unit{0.0, 1.0};

/// What a point of the surface adds to the pressure somewhere, per unit of its p and of its v_n.
struct Influence {
  Complex of_p, of_v;

  Influence& operator+=(const Influence& other)
  {
    of_p += other.of_p;
    of_v += other.of_v;
    return *this;
  }
  Influence operator*(double factor) const { return {factor * of_p, factor * of_v}; }
};

/// dG/dn and i omega rho G at distance.
Influence near_influence(const Wave& wave, const Vector3d& x, const Vector3d& y, const Vector3d& n)
{
  const Vector3d d = y - x;
  const double distance = d.norm();
  const Complex G = std::exp(-i_unit * wave.k() * distance) / (4.0 * pi * distance);
  return {-(i_unit * wave.k() + 1.0 / distance) * (d.dot(n) / distance) * G,
          i_unit * wave.omega * wave.medium.density * G};
}

/// The same times R exp(ikR) for R to infinity in the direction e.
Influence far_influence(const Wave& wave, const Vector3d& e, const Vector3d& y, const Vector3d& n)
{
  const Complex G = std::exp(i_unit * wave.k() * e.dot(y)) / (4.0 * pi);
  return {i_unit * wave.k() * e.dot(n) * G, i_unit * wave.omega * wave.medium.density * G};
}

using Kernel = Influence (*)(const Wave&, const Vector3d&, const Vector3d&, const Vector3d&);

/// A place of listening, as the kernels take it, and how far it is from a point of the meridian.
struct Listener {
  Kernel kernel;
  Vector3d x;
};

/// Enough equal steps of the angle for rounding: the integrand is analytic in a strip whose width
/// is the distance over the radius.
int n_angles_about(const Field& field, const Listener& listener, const Vector3d& y)
{
  const double r = y[0], k_r = field.wave.k() * r;
  constexpr double digits = 36.0;  // exp(-36) = 2e-16
  double steps = digits + 2.0 * (field.wave.n + k_r);
  if (listener.kernel == near_influence) {
    const double r_x = listener.x.head<2>().norm();
    const double d = std::hypot(r_x - r, listener.x[2] - y[2]);
    steps += digits * std::sqrt(r * r_x) / d;
  }
  return static_cast<int>(std::min(steps, 1e4)) / 2 * 2 + 2;
}

/// The influence of a circle on which p and v_n go with cos(n phi), on the amplitude at phi = 0.
Influence circle_influence(const Field& field, const Listener& listener, const Vector3d& y,
                           const Vector3d& n)
{
  const Vector3d x(listener.x.head<2>().norm(), 0.0, listener.x[2]);
  const int steps = n_angles_about(field, listener, y);
  Influence sum{};
  for (int i = 0; i <= steps / 2; ++i) {  // even in phi
    const double phi = 2.0 * pi * i / steps, c = std::cos(phi), s = std::sin(phi);
    const double weight = (i == 0 || 2 * i == steps ? 1.0 : 2.0) * 2.0 * pi / steps;
    sum += listener.kernel(field.wave, x, {y[0] * c, y[0] * s, y[2]}, {n[0] * c, n[0] * s, n[2]}) *
           (weight * std::cos(field.wave.n * phi));
  }
  return sum;
}

Influence influence(const Field& field, const Listener& listener, Index point)
{
  const auto& surface = field.surface;
  if (field.mesh->dimension() == 2) {
    return circle_influence(field, listener, {surface.x(point, 0), 0.0, surface.x(point, 1)},
                            {surface.normal(point, 0), 0.0, surface.normal(point, 1)});
  }
  return listener.kernel(field.wave, listener.x, surface.x.row(point).transpose(),
                         surface.normal.row(point).transpose());
}

/// Sum over the surface; in a half space also over its image, where p and v_n are opposite.
MatrixXcd integrate(const Field& field, Kernel kernel, const MatrixX3d& x)
{
  const MatrixXcd p = field.surface.trace.cast<Complex>() * field.p;
  MatrixXcd sum = MatrixXcd::Zero(x.rows(), field.n_fields());
  for (Index i = 0; i < x.rows(); ++i) {
    const Vector3d at = x.row(i).transpose();
    for (Index j = 0; j < field.surface.n_points(); ++j) {
      Influence of = influence(field, {kernel, at}, j);
      if (field.mesh->half_space)
        of += influence(field, {kernel, at.cwiseProduct(Vector3d(1, 1, -1))}, j) * -1.0;
      const double w = field.surface.weight[j];
      sum.row(i) += w * (of.of_p * p.row(j) + of.of_v * field.v_n.row(j));
    }
  }
  return sum;
}

}  // namespace

Field solve(Exterior& exterior, const MatrixXcd& v_n)
{
  return {.mesh = exterior.shared_mesh(),
          .surface = exterior.surface(),
          .wave = exterior.wave(),
          .v_n = v_n,
          .p = exterior.pressure(v_n)};
}

MatrixXcd kirchhoff_pressure(const Field& field, const MatrixX3d& x)
{
  return integrate(field, near_influence, x);
}

MatrixXcd far_field(const Field& field, const MatrixX3d& directions)
{
  return integrate(field, far_influence, directions);
}

MatrixXcd pressure_at(const Field& field, const MatrixX3d& x)
{
  const Locator locator(field.mesh);
  MatrixXcd p(x.rows(), field.n_fields());
  for (Index i = 0; i < x.rows(); ++i) {
    const Vector3d at = x.row(i).transpose();
    if ((at - Vector3d(0.0, 0.0, field.mesh->centre)).norm() > field.mesh->inner_radius)
      p.row(i) = kirchhoff_pressure(field, at.transpose());
    else
      p.row(i) = locator.value(at, field.p);
  }
  return p;
}

MatrixXcd complex_power(const Field& field)
{
  const MatrixXcd p = field.surface.trace.cast<Complex>() * field.p;
  return 0.5 * surface_measure(*field.mesh, field.wave.n) * p.transpose() *
         field.surface.weight.cast<Complex>().asDiagonal() * field.v_n.conjugate();
}

Eigen::VectorXd far_power(const Field& field)
{
  const bool meridian = field.mesh->dimension() == 2;
  // The pressure has multipoles up to about k R; a field of tetrahedra has 4 digits, not 10.
  const double k_R = field.wave.k() * field.mesh->inner_radius;
  const int n = static_cast<int>(meridian ? 24.0 + 2.0 * k_R : 12.0 + k_R);
  const Quadrature heights = gauss_points(n);  // z of the unit sphere is 2 t - 1
  const int n_phi = meridian ? 1 : 2 * n;
  const double circumference =
      meridian ? (field.wave.n == 0 ? 2.0 : 1.0) * pi : 2.0 * pi;  // of cos^2(n phi)
  MatrixX3d directions(n * n_phi, 3);
  Eigen::VectorXd weights(n * n_phi);
  for (int i = 0; i < n * n_phi; ++i) {
    const double z = 2.0 * heights.points(i / n_phi, 0) - 1.0, r = std::sqrt(1.0 - z * z);
    const double phi = 2.0 * pi * (i % n_phi) / n_phi;
    directions.row(i) << r * std::cos(phi), r * std::sin(phi), z;
    weights[i] = 2.0 * heights.weights[i / n_phi] * circumference / n_phi;
  }
  const Medium& air = field.wave.medium;
  return far_field(field, directions).cwiseAbs2().transpose() * weights /
         (2.0 * air.density * air.speed_of_sound);
}

}  // namespace chladni::sound
