#include "plate/elements/beam_element.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "common/error.hpp"
#include "plate/elements/interpolation.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::RowVector4d;

using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Bending in one plane: stiffnesses and inertias per length of a beam of length l.
struct BendingSection {
  double EI, rho_A, rho_I;
  double Phi;  ///< 12 EI / (kappa G A l^2)
};

/// In (w_1, beta_1, w_2, beta_2); beta is the rotation of the section, w' without shear.
struct BendingMatrices {
  Matrix4d K, M;
};

/// w and beta of the unloaded beam at x = xi l, [1 x 4].
struct BendingShapes {
  RowVector4d w, beta;
};

BendingShapes bending_shapes(double xi, double l, double Phi)
{
  const double xi2 = xi * xi;
  const double xi3 = xi2 * xi;
  const double shear = 0.5 * Phi * (xi - xi2);
  BendingShapes N;
  N.w << 1.0 - 3.0 * xi2 + 2.0 * xi3 + Phi * (1.0 - xi), l * (xi - 2.0 * xi2 + xi3 + shear),
      3.0 * xi2 - 2.0 * xi3 + Phi * xi, l * (xi3 - xi2 - shear);
  N.beta << 6.0 / l * (xi2 - xi), 1.0 - 4.0 * xi + 3.0 * xi2 + Phi * (1.0 - xi),
      6.0 / l * (xi - xi2), 3.0 * xi2 - 2.0 * xi + Phi * xi;
  return {.w = N.w / (1.0 + Phi), .beta = N.beta / (1.0 + Phi)};
}

BendingMatrices bending_matrices(const BendingSection& section, double l)
{
  const double Phi = section.Phi;
  BendingMatrices bending;
  bending.K << 12.0, 6.0 * l, -12.0, 6.0 * l,                       //
      6.0 * l, (4.0 + Phi) * l * l, -6.0 * l, (2.0 - Phi) * l * l,  //
      -12.0, -6.0 * l, 12.0, -6.0 * l,                              //
      6.0 * l, (2.0 - Phi) * l * l, -6.0 * l, (4.0 + Phi) * l * l;
  bending.K *= section.EI / (l * l * l * (1.0 + Phi));
  // int rho A w^T w + rho I beta^T beta dx; four points are exact for degree 6.
  static const GaussRule rule = gauss_legendre(4);
  bending.M.setZero();
  for (Index q = 0; q < rule.x.size(); ++q) {
    const BendingShapes N = bending_shapes(0.5 * (1.0 + rule.x[q]), l, Phi);
    bending.M +=
        0.5 * l * rule.w[q] *
        (section.rho_A * N.w.transpose() * N.w + section.rho_I * N.beta.transpose() * N.beta);
  }
  return bending;
}

double shear_modulus(const Material& material)
{
  return 0.5 * material.young / (1.0 + material.poisson);
}

BendingSection bending_section(const BeamSection& section, double I, double kappa, double l)
{
  const double EI = section.material.young * I;
  const double shear = kappa * shear_modulus(section.material) * section.area;
  return {.EI = EI,
          .rho_A = section.material.density * section.area,
          .rho_I = section.has_rotary_inertia ? section.material.density * I : 0.0,
          .Phi = section.theory == BeamTheory::timoshenko ? 12.0 * EI / (shear * l * l) : 0.0};
}

/// Adds the part of one plane: rows and columns `dofs`, beta = sign * rotation.
void add_bending(const BendingMatrices& bending, const std::array<int, 4>& dofs, double sign,
                 Matrix12d& K, Matrix12d& M)
{
  const Eigen::Vector4d D(1.0, sign, 1.0, sign);
  K(dofs, dofs) += D.asDiagonal() * bending.K * D.asDiagonal();
  M(dofs, dofs) += D.asDiagonal() * bending.M * D.asDiagonal();
}

/// Adds a rod: stiffness and inertia per length along the DOFs i and 6 + i.
void add_rod(int i, double stiffness, double inertia, Matrix12d& K, Matrix12d& M)
{
  const std::array<int, 2> dofs{i, 6 + i};
  Eigen::Matrix2d difference, mean;
  difference << 1.0, -1.0, -1.0, 1.0;
  mean << 2.0, 1.0, 1.0, 2.0;
  K(dofs, dofs) += stiffness * difference;
  M(dofs, dofs) += inertia / 6.0 * mean;
}

struct BeamMatrices {
  Matrix12d K, M;
};

/// K_e and M_e in the local axes.
BeamMatrices local_matrices(const BeamSection& section, double l)
{
  const double rho = section.material.density;
  BeamMatrices beam{.K = Matrix12d::Zero(), .M = Matrix12d::Zero()};
  add_rod(0, section.material.young * section.area / l, rho * section.area * l, beam.K, beam.M);
  add_rod(3, shear_modulus(section.material) * section.J / l, rho * (section.I_y + section.I_z) * l,
          beam.K, beam.M);
  // A positive slope of v turns about +z, a positive slope of w about -y.
  add_bending(bending_matrices(bending_section(section, section.I_z, section.shear_factor_y, l), l),
              {1, 5, 7, 11}, 1.0, beam.K, beam.M);
  add_bending(bending_matrices(bending_section(section, section.I_y, section.shear_factor_z, l), l),
              {2, 4, 8, 10}, -1.0, beam.K, beam.M);
  return beam;
}

/// Local components of the DOFs of two nodes from global ones.
Matrix12d to_local(const Matrix3d& axes)
{
  Matrix12d T = Matrix12d::Zero();
  for (Index i = 0; i < 12; i += 3) T.block<3, 3>(i, i) = axes;
  return T;
}

bool is_symmetric(const BeamSection& section)
{
  return section.I_y == section.I_z && (section.theory == BeamTheory::bernoulli_euler ||
                                        section.shear_factor_y == section.shear_factor_z);
}

/// The global z axis, or x for a beam that is nearly parallel to z.
RowVector3d any_across(const RowVector3d& e_x)
{
  return std::abs(e_x.z()) < 0.9 ? RowVector3d::UnitZ() : RowVector3d::UnitX();
}

}  // namespace

Matrix3d beam_axes(const RowVector3d& along, const BeamSection& section)
{
  if (!(along.norm() > 0.0)) {
    throw Error(
        fmt::format("beam section of group \"{}\": an element has no length; its two nodes "
                    "stand at one place",
                    section.group));
  }
  const RowVector3d e_x = along.normalized();
  if (!section.orientation && !is_symmetric(section)) {
    throw Error(
        fmt::format("beam section of group \"{}\": y and z of the section differ; give "
                    "`orientation`, a vector towards its z axis",
                    section.group));
  }
  const RowVector3d v =
      section.orientation ? RowVector3d(section.orientation->data()).normalized() : any_across(e_x);
  const RowVector3d across = v - v.dot(e_x) * e_x;
  if (!(across.norm() > 1e-6)) {
    throw Error(
        fmt::format("beam section of group \"{}\": `orientation` is parallel to an element "
                    "along ({:.6g}, {:.6g}, {:.6g}); choose a vector across the beam",
                    section.group, e_x[0], e_x[1], e_x[2]));
  }
  const RowVector3d e_z = across.normalized();
  Matrix3d axes;
  axes << e_x, e_z.cross(e_x), e_z;
  return axes;
}

ElementMatrices beam_matrices(const NodeVectors& x, const BeamSection& section)
{
  const Index n = 6 * x.rows();
  ElementMatrices chain{.K = MatrixXd::Zero(n, n), .M = MatrixXd::Zero(n, n)};
  for (Index i = 0; i + 1 < x.rows(); ++i) {
    const RowVector3d along = x.row(i + 1) - x.row(i);
    const Matrix12d T = to_local(beam_axes(along, section));
    const BeamMatrices beam = local_matrices(section, along.norm());
    chain.K.block<12, 12>(6 * i, 6 * i) += T.transpose() * beam.K * T;
    chain.M.block<12, 12>(6 * i, 6 * i) += T.transpose() * beam.M * T;
  }
  return chain;
}

Eigen::Matrix<double, 6, 12> beam_shapes(double xi, const RowVector3d& along,
                                         const BeamSection& section)
{
  const double l = along.norm();
  const auto shapes = [&](double I, double kappa) {
    return bending_shapes(xi, l, bending_section(section, I, kappa, l).Phi);
  };
  const BendingShapes v = shapes(section.I_z, section.shear_factor_y);
  const BendingShapes w = shapes(section.I_y, section.shear_factor_z);
  Eigen::Matrix<double, 6, 12> N = Eigen::Matrix<double, 6, 12>::Zero();
  for (const int i : {0, 3}) {  // a rod, and its torsion
    N(i, i) = 1.0 - xi;
    N(i, 6 + i) = xi;
  }
  constexpr std::array in_xy{1, 5, 7, 11}, in_xz{2, 4, 8, 10};
  for (std::size_t k = 0; k < 4; ++k) {
    // A positive slope of v turns about +z, a positive slope of w about -y.
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    const auto column = static_cast<Index>(k);
    N(1, in_xy[k]) = v.w[column];
    N(5, in_xy[k]) = v.beta[column];
    N(2, in_xz[k]) = sign * w.w[column];
    N(4, in_xz[k]) = -sign * w.beta[column];
  }
  return N * to_local(beam_axes(along, section));
}

MatrixXd beam_section_forces(const NodeVectors& x, const BeamSection& section)
{
  MatrixXd S = MatrixXd::Zero(12 * (x.rows() - 1), 6 * x.rows());
  for (Index i = 0; i + 1 < x.rows(); ++i) {
    const RowVector3d along = x.row(i + 1) - x.row(i);
    // The nodal forces act on the face with normal -x at the first end, with +x at the second.
    Matrix12d forces =
        local_matrices(section, along.norm()).K * to_local(beam_axes(along, section));
    forces.topRows<6>() *= -1.0;
    S.block<12, 12>(12 * i, 6 * i) = forces;
  }
  return S;
}

}  // namespace chladni::plate
