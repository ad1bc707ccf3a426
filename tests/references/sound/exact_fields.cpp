#include "tests/references/sound/exact_fields.hpp"

#include <cmath>

namespace chladni::sound::testing {
namespace {

using Complex = std::complex<double>;
constexpr Complex i_unit{0.0, 1.0};

struct Difference {
  double largest = 0.0, largest_exact = 0.0, square = 0.0, square_exact = 0.0;
};

Difference difference(const AirMesh& mesh, const Wave& wave, const Eigen::VectorXcd& p,
                      const Multipole& exact)
{
  Difference d;
  for (Eigen::Index i = 0; i < mesh.n_nodes(); ++i) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    if (mesh.dimension() == 2)
      x << mesh.positions(i, 0), 0.0, mesh.positions(i, 1);
    else
      x = mesh.positions.row(i).transpose();
    if (x.norm() > mesh.inner_radius) continue;
    const Complex q = pressure(exact, wave, x);
    d.largest = std::max(d.largest, std::abs(p[i] - q));
    d.largest_exact = std::max(d.largest_exact, std::abs(q));
    d.square += std::norm(p[i] - q);
    d.square_exact += std::norm(q);
  }
  return d;
}

}  // namespace

Complex pressure(const Multipole& multipole, const Wave& wave, double r, double z)
{
  const double R = std::hypot(r, z), x = wave.k() * R;
  const auto l = static_cast<unsigned>(multipole.l), n = static_cast<unsigned>(multipole.n);
  return (std::sph_bessel(l, x) - i_unit * std::sph_neumann(l, x)) *
         std::assoc_legendre(l, n, z / R);
}

Complex pressure(const Multipole& multipole, const Wave& wave, const Eigen::Vector3d& x)
{
  return pressure(multipole, wave, x.head<2>().norm(), x[2]) *
         std::cos(multipole.n * std::atan2(x[1], x[0]));
}

Eigen::MatrixXcd normal_velocity(const Multipole& multipole, const Wave& wave,
                                 const BodySurface& surface)
{
  const bool meridian = surface.x.cols() == 2;
  Eigen::MatrixXcd v(surface.n_points(), 1);
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    const auto at = [&](double s) {
      const Eigen::VectorXd x = surface.x.row(i) + s * surface.normal.row(i);
      return meridian ? pressure(multipole, wave, x[0], x[1])
                      : pressure(multipole, wave, Eigen::Vector3d(x));
    };
    // Differences of order 4; 1e-3 of the radius leaves 1e-11.
    const double s = 1e-3 * surface.x.row(i).norm();
    const Complex slope = (8.0 * (at(s) - at(-s)) - (at(2 * s) - at(-2 * s))) / (12.0 * s);
    v(i, 0) = i_unit / (wave.omega * wave.medium.density) * slope;
  }
  return v;
}

double field_error(const AirMesh& mesh, const Wave& wave, const Eigen::VectorXcd& p,
                   const Multipole& exact)
{
  const Difference d = difference(mesh, wave, p, exact);
  return d.largest / d.largest_exact;
}

double mean_field_error(const AirMesh& mesh, const Wave& wave, const Eigen::VectorXcd& p,
                        const Multipole& exact)
{
  const Difference d = difference(mesh, wave, p, exact);
  return std::sqrt(d.square / d.square_exact);
}

Outline solid_disc(double radius, double thickness)
{
  const double h = 0.5 * thickness;
  return {.quadrilaterals = {{Eigen::Vector2d(0.0, -h), Eigen::Vector2d(radius, -h),
                              Eigen::Vector2d(radius, h), Eigen::Vector2d(0.0, h)}}};
}

}  // namespace chladni::sound::testing
