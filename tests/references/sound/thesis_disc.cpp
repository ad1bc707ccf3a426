#include "tests/references/sound/thesis_disc.hpp"

#include <cmath>
#include <numbers>

namespace chladni::sound::testing {
namespace {

/// Vogel and Skinner: U = C_1 J_3 + C_2 Y_3 + C_3 exp(-beta r_a) I_3 + C_4 exp(beta r_i) K_3. The
/// coefficients to ten digits of the condition U(r_i) = U'(r_i) = 0 are solved for again.
constexpr double beta = 3.53593932264 / disc_radius;

double part(int i, double x, int n)
{
  switch (i) {
    case 0:
      return std::cyl_bessel_j(n, x);
    case 1:
      return std::cyl_neumann(n, x);
    case 2:
      return std::cyl_bessel_i(n, x) * std::exp(-beta * disc_radius);
    default:
      return std::cyl_bessel_k(n, x) * std::exp(beta * hub_radius);
  }
}

/// d/dx of the part of order 3.
double part_slope(int i, double x)
{
  const double low = part(i, x, 2), high = part(i, x, 4);
  if (i < 2) return 0.5 * (low - high);
  return (i == 2 ? 0.5 : -0.5) * (low + high);
}

constexpr double C[] = {1.7775527, 8.0078385e-3, 5.5190321, 3.1039483e-3};

}  // namespace

double deflection(double r)
{
  if (r < hub_radius) return 0.0;
  double U = 0.0;
  for (int i = 0; i < 4; ++i) U += C[i] * part(i, beta * r, 3);
  return U;
}

double slope(double r)
{
  if (r < hub_radius) return 0.0;
  double U = 0.0;
  for (int i = 0; i < 4; ++i) U += C[i] * beta * part_slope(i, beta * r);
  return U;
}

Eigen::MatrixXcd disc_velocity(const BodySurface& surface, double rim)
{
  Eigen::MatrixXcd v(surface.n_points(), 1);
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    const double r = surface.x(i, 0), zeta = surface.x(i, 1);
    v(i, 0) = surface.normal(i, 1) * deflection(r) - rim * surface.normal(i, 0) * zeta * slope(r);
  }
  return v;
}

Eigen::MatrixXcd disc_velocity_in_space(const BodySurface& surface)
{
  Eigen::MatrixXcd v(surface.n_points(), 1);
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    const double x = surface.x(i, 0), y = surface.x(i, 1), zeta = surface.x(i, 2);
    const double r = std::hypot(x, y), phi = std::atan2(y, x);
    const double n_r = (surface.normal(i, 0) * x + surface.normal(i, 1) * y) / std::max(r, 1e-9);
    v(i, 0) = (surface.normal(i, 2) * deflection(r) - n_r * zeta * slope(r)) * std::cos(3.0 * phi);
  }
  return v;
}

Wave squeal_wave()
{
  return {.medium = {}, .omega = 2.0 * std::numbers::pi * squeal_Hz, .n = 3};
}

mbs_export::ModalBody thesis_body()
{
  const double scale = 1.0 / std::sqrt(modal_mass), pi = std::numbers::pi;
  const int n_radii = 16, n_angles = 48, n_ring = 60;
  mbs_export::ModalBody body{};
  body.kinds = {mbs_export::ModeKind::constrained, mbs_export::ModeKind::constrained};
  body.omega = Eigen::Vector2d::Constant(2.0 * pi * squeal_Hz);
  body.picture.positions.resize(n_radii * n_angles, 3);
  body.picture.transformation = Eigen::MatrixXd::Zero(3 * n_radii * n_angles, 2);
  for (int i = 0; i < n_radii * n_angles; ++i) {
    const double r = hub_radius + (disc_radius - hub_radius) * (i % n_radii) / (n_radii - 1);
    const int angle = i / n_radii;
    const double phi = 2.0 * pi * angle / n_angles;
    body.picture.positions.row(i) << r * std::cos(phi), r * std::sin(phi), 0.0;
    body.picture.transformation.row(3 * i + 2) << std::cos(3 * phi), std::sin(3 * phi);
    body.picture.transformation.row(3 * i + 2) *= scale * deflection(r);
  }
  mbs_export::ContactRing ring{.name = "track",
                               .radius = 0.13,
                               .height = 0.0,
                               .nodes = {},
                               .angles = {},
                               .W = {},
                               .W_r = {},
                               .W_t = {}};
  ring.angles = Eigen::VectorXd::LinSpaced(n_ring, 0.0, 2.0 * pi * (n_ring - 1) / n_ring);
  Eigen::MatrixXd waves(n_ring, 2), turned(n_ring, 2);
  waves << (3.0 * ring.angles.array()).cos(), (3.0 * ring.angles.array()).sin();
  turned << -waves.col(1), waves.col(0);
  ring.W = scale * deflection(0.13) * waves;
  ring.W_r = scale * slope(0.13) * waves;
  ring.W_t = scale * 3.0 * deflection(0.13) / 0.13 * turned;
  body.rings.push_back(ring);
  return body;
}

}  // namespace chladni::sound::testing
