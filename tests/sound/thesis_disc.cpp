#include "thesis_disc.hpp"

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

Wave squeal_wave()
{
  return {.medium = {}, .omega = 2.0 * std::numbers::pi * squeal_Hz, .n = 3};
}

}  // namespace chladni::sound::testing
