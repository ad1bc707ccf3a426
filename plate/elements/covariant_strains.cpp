#include "plate/elements/covariant_strains.hpp"

#include <Eigen/Geometry>

namespace chladni::plate {

namespace {

using Eigen::RowVector3d;

CovariantStrains zero_strains(Eigen::Index n_points, Eigen::Index n_dofs, StrainParts parts)
{
  CovariantStrains strains;
  const auto set_zero = [=](auto& components) {
    for (StrainRows& rows : components) rows.setZero(n_points, n_dofs);
  };
  if (parts != StrainParts::shear) set_zero(strains.m);
  if (parts != StrainParts::membrane) {
    set_zero(strains.g0);
    set_zero(strains.g1);
  }
  if (parts == StrainParts::all) {
    set_zero(strains.b);
    set_zero(strains.c);
  }
  return strains;
}

/// The frame at one point, with indices 0, 1 for the two surface coordinates.
struct PointFrame {
  std::array<RowVector3d, 2> a, d_a;
  RowVector3d d;
};

/// Strain rows of one node at one point.
struct NodeTerms {
  double N;
  std::array<double, 2> N_a;
  std::array<RowVector3d, 2> Dxa, Dxd_a;  ///< D_i x a_a, D_i x d_a
  RowVector3d Dxd;                        ///< D_i x d
};

constexpr std::array<std::pair<int, int>, 3> components{{{0, 0}, {1, 1}, {0, 1}}};

void add_membrane(CovariantStrains& s, Eigen::Index q, Eigen::Index dof, const PointFrame& f,
                  const NodeTerms& n)
{
  for (std::size_t r = 0; r < 3; ++r) {
    const auto [A, B] = components[r];
    s.m[r].row(q).segment<3>(dof) = 0.5 * (f.a[A] * n.N_a[B] + f.a[B] * n.N_a[A]);
  }
}

void add_bending(CovariantStrains& s, Eigen::Index q, Eigen::Index dof, const PointFrame& f,
                 const NodeTerms& n)
{
  for (std::size_t r = 0; r < 3; ++r) {
    const auto [A, B] = components[r];
    s.b[r].row(q).segment<3>(dof) = 0.5 * (f.d_a[A] * n.N_a[B] + f.d_a[B] * n.N_a[A]);
    s.b[r].row(q).segment<3>(dof + 3) = 0.5 * (n.Dxa[A] * n.N_a[B] + n.Dxa[B] * n.N_a[A]);
    s.c[r].row(q).segment<3>(dof + 3) = 0.5 * (n.Dxd_a[A] * n.N_a[B] + n.Dxd_a[B] * n.N_a[A]);
  }
}

void add_shear(CovariantStrains& s, Eigen::Index q, Eigen::Index dof, const PointFrame& f,
               const NodeTerms& n)
{
  for (std::size_t A = 0; A < 2; ++A) {
    s.g0[A].row(q).segment<3>(dof) = f.d * n.N_a[A];
    s.g0[A].row(q).segment<3>(dof + 3) = n.Dxa[A] * n.N;
    s.g1[A].row(q).segment<3>(dof + 3) = n.Dxd * n.N_a[A] + n.Dxd_a[A] * n.N;
  }
}

}  // namespace

ShellFrame shell_frame(const Basis& basis, const ShellNodes& nodes)
{
  return {.a_1 = basis.N_xi * nodes.x,
          .a_2 = basis.N_eta * nodes.x,
          .d = basis.N * nodes.D,
          .d_1 = basis.N_xi * nodes.D,
          .d_2 = basis.N_eta * nodes.D};
}

CovariantStrains covariant_strains(const Basis& basis, const ShellNodes& nodes, StrainParts parts)
{
  return covariant_strains(basis, shell_frame(basis, nodes), nodes.D, parts);
}

CovariantStrains covariant_strains(const Basis& field, const ShellFrame& frame,
                                   const NodeVectors& directors, StrainParts parts)
{
  CovariantStrains strains = zero_strains(field.N.rows(), 6 * directors.rows(), parts);
  for (Eigen::Index q = 0; q < field.N.rows(); ++q) {
    const PointFrame f{.a = {frame.a_1.row(q), frame.a_2.row(q)},
                       .d_a = {frame.d_1.row(q), frame.d_2.row(q)},
                       .d = frame.d.row(q)};
    for (Eigen::Index i = 0; i < directors.rows(); ++i) {
      const RowVector3d D = directors.row(i);
      const NodeTerms terms{.N = field.N(q, i),
                            .N_a = {field.N_xi(q, i), field.N_eta(q, i)},
                            .Dxa = {D.cross(f.a[0]), D.cross(f.a[1])},
                            .Dxd_a = {D.cross(f.d_a[0]), D.cross(f.d_a[1])},
                            .Dxd = D.cross(f.d)};
      if (parts != StrainParts::shear) add_membrane(strains, q, 6 * i, f, terms);
      if (parts != StrainParts::membrane) add_shear(strains, q, 6 * i, f, terms);
      if (parts == StrainParts::all) add_bending(strains, q, 6 * i, f, terms);
    }
  }
  return strains;
}

}  // namespace chladni::plate
