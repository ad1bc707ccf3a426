#include "plate/elements/shell_strains.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace chladni::plate {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::RowVector3d, Eigen::Vector3d;

namespace {

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

constexpr std::array<std::pair<int, int>, 3> in_plane_components{{{0, 0}, {1, 1}, {0, 1}}};

void add_membrane(CovariantStrains& s, Eigen::Index q, Eigen::Index dof, const PointFrame& f,
                  const NodeTerms& n)
{
  for (std::size_t r = 0; r < 3; ++r) {
    const auto [A, B] = in_plane_components[r];
    s.m[r].row(q).segment<3>(dof) = 0.5 * (f.a[A] * n.N_a[B] + f.a[B] * n.N_a[A]);
  }
}

void add_bending(CovariantStrains& s, Eigen::Index q, Eigen::Index dof, const PointFrame& f,
                 const NodeTerms& n)
{
  for (std::size_t r = 0; r < 3; ++r) {
    const auto [A, B] = in_plane_components[r];
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

namespace {

using Matrix5d = Eigen::Matrix<double, 5, 5>;

constexpr double kappa = 5.0 / 6.0;

/// Transformation of the covariant components (e_11, e_22, e_12, 2 e_13, 2 e_23) into Cartesian
/// ones (e_11, e_22, 2 e_12, 2 e_13, 2 e_23) of a frame whose third axis is the director, and
/// det(g).
struct LocalFrame {
  Matrix5d T;
  double det;
};

LocalFrame local_frame(const ShellFrame& frame, Index q, double zeta)
{
  const Vector3d g_1 = frame.a_1.row(q) + zeta * frame.d_1.row(q);
  const Vector3d g_2 = frame.a_2.row(q) + zeta * frame.d_2.row(q);
  const Vector3d g_3 = frame.d.row(q);
  const double det = g_1.cross(g_2).dot(g_3);
  const Vector3d e_3 = g_3.normalized();
  const Vector3d e_1 = g_2.cross(e_3).normalized();
  Matrix3d e, contravariant;
  e << e_1, e_3.cross(e_1), e_3;
  contravariant << g_2.cross(g_3) / det, g_3.cross(g_1) / det, g_1.cross(g_2) / det;
  const Matrix3d p = e.transpose() * contravariant;  // p_ik = e_i . g^k
  constexpr std::array<std::pair<int, int>, 5> cartesian{{{0, 0}, {1, 1}, {0, 1}, {0, 2}, {1, 2}}};
  Matrix5d T;
  for (int row = 0; row < 5; ++row) {
    const auto [i, j] = cartesian[row];
    const double engineering = i == j ? 1.0 : 2.0;
    T.row(row) << p(i, 0) * p(j, 0), p(i, 1) * p(j, 1), p(i, 0) * p(j, 1) + p(i, 1) * p(j, 0),
        0.5 * (p(i, 0) * p(j, 2) + p(i, 2) * p(j, 0)),
        0.5 * (p(i, 1) * p(j, 2) + p(i, 2) * p(j, 1));
    T.row(row) *= engineering;
  }
  return {.T = T, .det = det};
}

using FiveRows = Eigen::Matrix<double, 5, Eigen::Dynamic, Eigen::RowMajor>;

/// The five covariant strain rows at one point and height.
FiveRows strain_rows(const CovariantStrains& s, Index q, double zeta)
{
  FiveRows rows(5, s.m[0].cols());
  for (int r = 0; r < 3; ++r)
    rows.row(r) = s.m[r].row(q) + zeta * s.b[r].row(q) + zeta * zeta * s.c[r].row(q);
  for (int r = 0; r < 2; ++r) rows.row(3 + r) = s.g0[r].row(q) + zeta * s.g1[r].row(q);
  return rows;
}

}  // namespace

const std::array<double, 2> thickness_points{-1.0 / std::sqrt(3.0), 1.0 / std::sqrt(3.0)};

Eigen::Matrix<double, Eigen::Dynamic, 5> elasticity_root(const Material& material, Strains which)
{
  const double nu = material.poisson;
  const double plane = std::sqrt(material.young / (1.0 - nu * nu));
  const double G = 0.5 * material.young / (1.0 + nu);
  Matrix5d S = Matrix5d::Zero();
  // [1 nu; nu 1] = [1 0; nu c] [1 nu; 0 c], c^2 = 1 - nu^2
  S.topLeftCorner<2, 2>() << plane, nu * plane, 0.0, plane * std::sqrt(1.0 - nu * nu);
  S(2, 2) = std::sqrt(G);
  S(3, 3) = S(4, 4) = std::sqrt(kappa * G);
  switch (which) {
    case Strains::without_shear:
      return S.topRows<3>();
    case Strains::shear:
      return S.bottomRows<2>();
    case Strains::all:
      break;
  }
  return S;
}

double volume_element(const ShellFrame& frame, Index q, double zeta)
{
  const Vector3d g_1 = frame.a_1.row(q) + zeta * frame.d_1.row(q);
  const Vector3d g_2 = frame.a_2.row(q) + zeta * frame.d_2.row(q);
  return g_1.cross(g_2).dot(frame.d.row(q));
}

Eigen::VectorXd leaning(const Basis& basis, const ShellNodes& nodes)
{
  const NodeVectors& x = nodes.surface.size() > 0 ? nodes.surface : nodes.x;
  const NodeVectors a_1 = basis.N_xi * x, a_2 = basis.N_eta * x, d = basis.N * nodes.D;
  Eigen::VectorXd factor = basis.N * nodes.D.rowwise().norm();  // t / 2
  for (Index q = 0; q < factor.size(); ++q) {
    const Eigen::RowVector3d area = a_1.row(q).cross(a_2.row(q));
    factor[q] *= area.norm() / area.dot(d.row(q));
  }
  return factor;
}

MatrixXd stiffness(const CovariantStrains& strains, const ShellFrame& frame, const Points& points,
                   const Eigen::Matrix<double, Eigen::Dynamic, 5>& root)
{
  const Index n = root.rows();
  StrainRows R(n * 2 * points.size(), strains.m[0].cols());
  Index row = 0;
  for (const double zeta : thickness_points) {
    for (Index q = 0; q < points.size(); ++q, row += n) {
      const LocalFrame local = local_frame(frame, q, zeta);
      const Eigen::Matrix<double, Eigen::Dynamic, 5> weighted =
          std::sqrt(local.det * points.weight[q]) * root * local.T;
      // Coefficient by coefficient: the matrices are too small for a blocked product.
      R.middleRows(row, n) = weighted.lazyProduct(strain_rows(strains, q, zeta));
    }
  }
  return gram_matrix(R);
}

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace {

constexpr Index n_a = 4, n_b = 8;  // a tile of K that fits into the vector registers

// K = R^T R on and above the diagonal, R [n_rows x n] and K [n x n] by rows, n a multiple of 8.

void upper_gram(const double* __restrict R, Index n_rows, Index n, double* __restrict K)
{
  for (Index i = 0; i < n; i += n_a) {
    for (Index j = i / n_b * n_b; j < n; j += n_b) {
      std::array<std::array<double, n_b>, n_a> sum{};
      for (Index k = 0; k < n_rows; ++k) {
        const double* row = R + k * n;
        for (Index a = 0; a < n_a; ++a)
          for (Index b = 0; b < n_b; ++b) sum[a][b] += row[i + a] * row[j + b];
      }
      for (Index a = 0; a < n_a; ++a)
        for (Index b = 0; b < n_b; ++b) K[(i + a) * n + j + b] = sum[a][b];
    }
  }
}

#ifdef __x86_64__
/// The same with vectors of four and fused products: twice as fast as what the compiler makes of
/// the loops above for the same processor.
[[gnu::target("avx2,fma")]] void upper_gram_avx2(const double* __restrict R, Index n_rows, Index n,
                                                 double* __restrict K)
{
  for (Index i = 0; i < n; i += n_a) {
    for (Index j = i / n_b * n_b; j < n; j += n_b) {
      __m256d left[n_a] = {}, right[n_a] = {};  // NOLINT(modernize-avoid-c-arrays): registers
      for (Index k = 0; k < n_rows; ++k) {
        const double* row = R + k * n;
        const __m256d row_left = _mm256_loadu_pd(row + j);
        const __m256d row_right = _mm256_loadu_pd(row + j + 4);
        for (Index a = 0; a < n_a; ++a) {
          const __m256d factor = _mm256_broadcast_sd(row + i + a);
          left[a] = _mm256_fmadd_pd(factor, row_left, left[a]);
          right[a] = _mm256_fmadd_pd(factor, row_right, right[a]);
        }
      }
      for (Index a = 0; a < n_a; ++a) {
        _mm256_storeu_pd(K + (i + a) * n + j, left[a]);
        _mm256_storeu_pd(K + (i + a) * n + j + 4, right[a]);
      }
    }
  }
}
#endif

using UpperGram = void (*)(const double* __restrict, Index, Index, double* __restrict);

UpperGram best_upper_gram()
{
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return upper_gram_avx2;
#endif
  return upper_gram;
}

}  // namespace

Eigen::MatrixXd gram_matrix(const StrainRows& R)
{
  const Index n = R.cols();
  const Index padded = (n + n_b - 1) / n_b * n_b;
  StrainRows wide;
  if (padded != n) {
    wide.setZero(R.rows(), padded);
    wide.leftCols(n) = R;
  }
  StrainRows upper(padded, padded);
  static const UpperGram upper_gram_here = best_upper_gram();
  upper_gram_here(padded == n ? R.data() : wide.data(), R.rows(), padded, upper.data());
  Eigen::MatrixXd K(n, n);
  K.triangularView<Eigen::Upper>() = upper.topLeftCorner(n, n);
  K.triangularView<Eigen::StrictlyLower>() = K.transpose();
  return K;
}

}  // namespace chladni::plate
