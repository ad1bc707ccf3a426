#include <Eigen/Geometry>

#include "plate/elements/assumed_strains.hpp"

namespace chladni::plate {

namespace {

using Eigen::RowVector3d;

/// How far the diagonals' middles are apart, x_d = (x_1 - x_2 + x_3 - x_4) / 4, in the
/// contravariant frame of the centre.
struct Distortion {
  double c_r, c_s;
};

Distortion distortion(const NodeVectors& x)
{
  const RowVector3d x_r = 0.25 * (-x.row(0) + x.row(1) - x.row(2) + x.row(3));
  const RowVector3d x_s = 0.25 * (-x.row(0) - x.row(1) + x.row(2) + x.row(3));
  const RowVector3d x_d = 0.25 * (x.row(0) - x.row(1) - x.row(2) + x.row(3));
  const RowVector3d area = x_r.cross(x_s);
  const double J = area.squaredNorm();
  return {.c_r = x_d.dot(x_s.cross(area)) / J, .c_s = x_d.dot(area.cross(x_r)) / J};
}

/// A and B: middles of the edges s = 1, -1; C and D: of r = 1, -1; E: the centre.
Points tying_points()
{
  Points tying{.xi = Eigen::VectorXd(5), .eta = Eigen::VectorXd(5), .weight = {}};
  tying.xi << 0.0, 0.0, 1.0, -1.0, 0.0;
  tying.eta << 1.0, -1.0, 0.0, 0.0, 0.0;
  return tying;
}

}  // namespace

std::array<StrainRows, 3> assume_bilinear_membrane(const Points& integration,
                                                   const ShellNodes& nodes)
{
  static const Basis at_tying = lagrange_basis(mesh::Shape::quadrilateral, 1, tying_points());
  const auto m = covariant_strains(at_tying, nodes, StrainParts::membrane).m;
  const auto e_rr_A = m[0].row(0), e_rr_B = m[0].row(1);
  const auto e_ss_C = m[1].row(2), e_ss_D = m[1].row(3);
  const auto e_rs_E = m[2].row(4);
  const auto [c_r, c_s] = distortion(nodes.x);
  const double d = c_r * c_r + c_s * c_s - 1.0;  // negative for each convex element
  const StrainRows bilinear = (0.5 * c_r * (c_r - 1.0) * e_rr_A + 0.5 * c_r * (c_r + 1.0) * e_rr_B +
                               0.5 * c_s * (c_s - 1.0) * e_ss_C + 0.5 * c_s * (c_s + 1.0) * e_ss_D +
                               2.0 * c_r * c_s * e_rs_E) /
                              d;
  const StrainRows linear_rr = 0.5 * (e_rr_A - e_rr_B);
  const StrainRows linear_ss = 0.5 * (e_ss_C - e_ss_D);
  std::array<StrainRows, 3> assumed;
  assumed.fill(StrainRows(integration.size(), m[0].cols()));
  for (Eigen::Index q = 0; q < integration.size(); ++q) {
    const double r = integration.xi[q];
    const double s = integration.eta[q];
    assumed[0].row(q) = 0.5 * (e_rr_A + e_rr_B) + s * linear_rr + (s * s - 1.0) * bilinear;
    assumed[1].row(q) = 0.5 * (e_ss_C + e_ss_D) + r * linear_ss + (r * r - 1.0) * bilinear;
    assumed[2].row(q) = e_rs_E + 0.5 * r * linear_rr + 0.5 * s * linear_ss + r * s * bilinear;
  }
  return assumed;
}

}  // namespace chladni::plate
