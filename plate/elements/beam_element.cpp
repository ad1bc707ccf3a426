#include "plate/elements/beam_element.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "common/error.hpp"
#include "plate/elements/interpolation.hpp"
#include "plate/elements/shell_strains.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::RowVector3d, Eigen::RowVectorXd,
    Eigen::VectorXd;

namespace {

/// Bending of a straight line of order p in one plane. The deflection w is of degree 2 p + 1, and
/// the rotation of the sections beta is what the moments ask for,
///   kappa G A (w' - beta) + E I beta'' = 0:   beta = w' + a w''' + a^2 w^(5) + ...,
/// a = E I / (kappa G A). Nodes at equal distances have w and beta. p = 1 is the beam without loads
/// between its nodes; a = 0 are Hermite's polynomials.
/// Source: Friedman and Kosmatka, Comput. Struct. 47 (1993) 473, for p = 1.
class StraightBending {
 public:
  /// @param length  l, m
  /// @param a       m^2
  StraightBending(int order, double length, double a);

  /// w, beta and the derivatives of beta by x as linear forms in (w_1, beta_1, w_2, ...).
  struct Forms {
    Eigen::RowVectorXd w, beta, beta_x, beta_xx;  ///< [1 x 2 p + 2]
  };

  /// @param xi  in [-1, 1]
  Forms at(double xi) const;

 private:
  double half_;  ///< l / 2
  /// Coefficients of the powers of xi, [2 p + 2 x 2 p + 2].
  Eigen::MatrixXd w_, beta_, beta_x_, beta_xx_;
};

/// d/dxi of polynomials by their coefficients.
MatrixXd derivative(Index n)
{
  MatrixXd D = MatrixXd::Zero(n, n);
  for (Index k = 1; k < n; ++k) D(k - 1, k) = static_cast<double>(k);
  return D;
}

RowVectorXd powers(double xi, Index n)
{
  RowVectorXd p = RowVectorXd::Ones(n);
  for (Index k = 1; k < n; ++k) p[k] = p[k - 1] * xi;
  return p;
}

/// D + a D^3 + a^2 D^5 + ...
MatrixXd rotation_of_deflection(const MatrixXd& D, double a)
{
  MatrixXd sum = MatrixXd::Zero(D.rows(), D.cols()), term = D;
  for (Index k = 1; k < D.rows(); k += 2, term = a * term * D * D) sum += term;
  return sum;
}

StraightBending::StraightBending(int order, double length, double a) : half_(0.5 * length)
{
  const Index n = 2 * Index{order} + 2;
  const MatrixXd D = derivative(n);
  const MatrixXd B = rotation_of_deflection(D, a / (half_ * half_));
  MatrixXd values(n, n);  // of w and beta l / 2 at the nodes, for each power
  for (Index i = 0; i <= order; ++i) {
    const RowVectorXd at_node = powers(-1.0 + 2.0 * double(i) / order, n);
    values.row(2 * i) = at_node;
    values.row(2 * i + 1) = at_node * B;
  }
  // Without these scales digits are lost where a is large.
  const Eigen::VectorXd scales = values.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
  w_ = scales.asDiagonal() * (values * scales.asDiagonal()).partialPivLu().inverse();
  for (Index i = 1; i < n; i += 2) w_.col(i) *= half_;
  beta_ = B * w_ / half_;
  beta_x_ = D * beta_ / half_;
  beta_xx_ = D * beta_x_ / half_;
}

StraightBending::Forms StraightBending::at(double xi) const
{
  const RowVectorXd p = powers(xi, w_.rows());
  return {.w = p * w_, .beta = p * beta_, .beta_x = p * beta_x_, .beta_xx = p * beta_xx_};
}

/// rho times A, A, A, I_y + I_z, I_y, I_z of the motions of a section.
Eigen::Vector<double, 6> inertia_of(const BeamSection& section)
{
  const double rho = section.material.density;
  const double rotary = section.has_rotary_inertia ? rho : 0.0;
  const double m = rho * section.area;
  return {m, m, m, rho * (section.I_y + section.I_z), rotary * section.I_y, rotary * section.I_z};
}

/// The rows of some forms at points, each with the root of its weight in a sum of squares.
StrainRows root_rows(const std::vector<AxisPoint>& points, SectionForms AxisPoint::*forms,
                     const Eigen::Vector<double, 6>& weights)
{
  StrainRows rows(6 * std::ssize(points), (points.front().*forms).cols());
  for (Eigen::Index q = 0; q < std::ssize(points); ++q) {
    const AxisPoint& point = points[static_cast<std::size_t>(q)];
    rows.middleRows<6>(6 * q) = (point.length * weights).cwiseSqrt().asDiagonal() * (point.*forms);
  }
  return rows;
}

}  // namespace

ElementMatrices beam_matrices(const NodeVectors& x, const BeamSection& section, LineFields fields)
{
  const BeamFields at = beam_fields(x, section, fields);
  // K = int B^T C B ds, M = int N^T m N ds
  return {.K = gram_matrix(root_rows(at.strained, &AxisPoint::strain, at.stiffness)),
          .M = gram_matrix(root_rows(at.moved, &AxisPoint::motion, inertia_of(section)))};
}

Eigen::MatrixXd beam_section_forces(const NodeVectors& x, const BeamSection& section,
                                    LineFields fields)
{
  return beam_fields(x, section, fields).forces;
}

namespace {

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

bool is_straight(const NodeVectors& x)
{
  constexpr double round_off = 1e-8;  // of the length, in coordinates of a file
  const Index p = x.rows() - 1;
  const RowVector3d chord = x.row(p) - x.row(0);
  for (Index i = 1; i < p; ++i) {
    const RowVector3d place = x.row(0) + double(i) / double(p) * chord;
    if ((x.row(i) - place).norm() > round_off * chord.norm()) return false;
  }
  return true;
}

BeamSection oriented(const BeamSection& section, const NodeVectors& x)
{
  if (section.orientation || !is_symmetric(section) || is_straight(x)) return section;
  const Index p = x.rows() - 1;
  const RowVector3d chord = x.row(p) - x.row(0);
  RowVector3d normal = RowVector3d::Zero();
  for (Index i = 1; i < p; ++i) {
    const RowVector3d across = chord.cross(RowVector3d(x.row(i) - x.row(0)));
    if (across.norm() > normal.norm()) normal = across;
  }
  if (normal.norm() < 1e-8 * chord.squaredNorm()) return section;
  if (normal.z() < 0.0) normal = -normal;
  normal.normalize();
  BeamSection with = section;
  with.orientation = std::array{normal[0], normal[1], normal[2]};
  return with;
}

std::vector<Matrix3d> node_axes(const NodeVectors& x, const BeamSection& section)
{
  const BeamSection with = oriented(section, x);
  const Index n = x.rows();
  if (is_straight(x)) {
    const Matrix3d of_chord = beam_axes(x.row(n - 1) - x.row(0), with);
    return std::vector<Matrix3d>(static_cast<std::size_t>(n), of_chord);
  }
  const VectorXd nodes = VectorXd::LinSpaced(n, -1.0, 1.0);
  const NodeVectors tangents = lagrange_derivatives(nodes, nodes) * x;
  std::vector<Matrix3d> axes;
  for (Index i = 0; i < n; ++i) axes.push_back(beam_axes(tangents.row(i), with));
  for (const int points : {static_cast<int>(n) - 1, static_cast<int>(n)}) {
    const NodeVectors inside = lagrange_derivatives(nodes, gauss_legendre(points).x) * x;
    for (Index q = 0; q < inside.rows(); ++q) beam_axes(inside.row(q), with);
  }
  return axes;
}

namespace {

const GaussRule& axis_rule(Index n)
{
  static std::map<Index, GaussRule> cache;
  const auto it = cache.find(n);
  if (it != cache.end()) return it->second;
  return cache.emplace(n, gauss_legendre(static_cast<int>(n))).first->second;
}

/// EI / (kappa G A) of both planes, m^2.
struct ShearRatios {
  double xy, xz;
};

ShearRatios shear_ratios(const BeamSection& section)
{
  if (section.theory == BeamTheory::bernoulli_euler) return {.xy = 0.0, .xz = 0.0};
  const double E_over_GA = 2.0 * (1.0 + section.material.poisson) / section.area;
  return {.xy = E_over_GA * section.I_z / section.shear_factor_y,
          .xz = E_over_GA * section.I_y / section.shear_factor_z};
}

Eigen::Vector<double, 6> stiffness_of(const BeamSection& section)
{
  const double E = section.material.young, G = 0.5 * E / (1.0 + section.material.poisson);
  const double GA = G * section.area;
  return {E * section.area,
          section.shear_factor_y * GA,
          section.shear_factor_z * GA,
          G * section.J,
          E * section.I_y,
          E * section.I_z};
}

/// Whether shear counts so little that static shapes are better than those of degree p: measured
/// on simply supported beams.
bool is_slender(Index order, const ShearRatios& a, double length)
{
  const double ratio = std::max(a.xy, a.xz) / (length * length);
  switch (order) {
    case 1:
      return true;
    case 2:
      return ratio < 6.0;
    case 3:
      return ratio < 0.05;
    case 4:
      return ratio < 0.01;
    default:
      return ratio == 0.0;
  }
}

/// The forms in the global DOFs from those in the local ones.
SectionForms in_global_dofs(const SectionForms& local, const Matrix3d& axes)
{
  SectionForms global(6, local.cols());
  for (Index i = 0; i < local.cols(); i += 3)
    global.middleCols<3>(i) = local.middleCols<3>(i) * axes;
  return global;
}

/// A straight line with the bending of static shapes.
class SlenderLine {
 public:
  SlenderLine(const NodeVectors& x, const BeamSection& section)
      : x_(x),
        axes_(beam_axes(x.row(x.rows() - 1) - x.row(0), section)),
        length_((x.row(x.rows() - 1) - x.row(0)).norm()),
        nodes_(VectorXd::LinSpaced(x.rows(), -1.0, 1.0)),
        a_(shear_ratios(section)),
        stiffness_(stiffness_of(section)),
        xy_(static_cast<int>(x.rows()) - 1, length_, a_.xy),
        xz_(static_cast<int>(x.rows()) - 1, length_, a_.xz)
  {}

  BeamFields fields() const
  {
    const Index n = x_.rows();
    BeamFields fields{.stiffness = stiffness_, .strained = {}, .moved = {}, .forces = {}};
    const GaussRule& rule = axis_rule(2 * n);  // exact for w^2, of degree 4 p + 2
    for (Index q = 0; q < 2 * n; ++q) {
      fields.strained.push_back(point(rule.x[q]));
      fields.strained.back().length = 0.5 * length_ * rule.w[q];
    }
    fields.moved = fields.strained;
    fields.forces.resize(6 * n, 6 * n);
    for (Index i = 0; i < n; ++i)
      fields.forces.middleRows<6>(6 * i) = in_global_dofs(local_at(nodes_[i]).forces, axes_);
    return fields;
  }

 private:
  struct Local {
    SectionForms motion, strain, forces;
  };

  AxisPoint point(double xi) const
  {
    const Local local = local_at(xi);
    const Index last = x_.rows() - 1;
    return {.length = 0.0,
            .x = 0.5 * (1.0 - xi) * x_.row(0) + 0.5 * (1.0 + xi) * x_.row(last),
            .axes = axes_,
            .motion = in_global_dofs(local.motion, axes_),
            .strain = in_global_dofs(local.strain, axes_)};
  }

  /// Shear forces follow from the moments: Q_y = -dM_z/dx, Q_z = dM_y/dx.
  Local local_at(double xi) const
  {
    const Index n = x_.rows();
    const SectionForms none = SectionForms::Zero(6, 6 * n);
    Local local{.motion = none, .strain = none, .forces = none};
    const VectorXd at = VectorXd::Constant(1, xi);
    const RowVectorXd N = lagrange(nodes_, at);
    const RowVectorXd N_x = 2.0 / length_ * lagrange_derivatives(nodes_, at);
    const StraightBending::Forms v = xy_.at(xi), w = xz_.at(xi);
    for (Index i = 0; i < n; ++i) {
      for (const Index rod : {0, 3}) {  // stretch and twist
        local.motion(rod, 6 * i + rod) = N[i];
        local.strain(rod, 6 * i + rod) = N_x[i];
      }
      for (const Index k : {2 * i, 2 * i + 1}) {
        // A positive slope of v turns about +z, a positive slope of w about -y.
        const bool is_rotation = k % 2 == 1;
        const Index in_xy = 6 * i + (is_rotation ? 5 : 1), in_xz = 6 * i + (is_rotation ? 4 : 2);
        const double sign = is_rotation ? -1.0 : 1.0;
        local.motion(1, in_xy) = v.w[k];
        local.motion(5, in_xy) = v.beta[k];
        local.motion(2, in_xz) = sign * w.w[k];
        local.motion(4, in_xz) = -sign * w.beta[k];
        local.strain(1, in_xy) = -a_.xy * v.beta_xx[k];
        local.strain(5, in_xy) = v.beta_x[k];
        local.strain(2, in_xz) = -sign * a_.xz * w.beta_xx[k];
        local.strain(4, in_xz) = -sign * w.beta_x[k];
        local.forces(1, in_xy) = -stiffness_[5] * v.beta_xx[k];
        local.forces(2, in_xz) = -sign * stiffness_[4] * w.beta_xx[k];
      }
    }
    for (const Index row : {0, 3, 4, 5})
      local.forces.row(row) = stiffness_[row] * local.strain.row(row);
    return local;
  }

  const NodeVectors& x_;
  Matrix3d axes_;
  double length_;
  VectorXd nodes_;
  ShearRatios a_;
  Eigen::Vector<double, 6> stiffness_;
  StraightBending xy_, xz_;
};

/// e_x x theta in the local axes.
Matrix3d turn_of_axis()
{
  Matrix3d turn = Matrix3d::Zero();
  turn(1, 2) = -1.0;
  turn(2, 1) = 1.0;
  return turn;
}

/// The points of a Gauss rule on an isoparametric line.
std::vector<AxisPoint> isoparametric_points(const NodeVectors& x, const BeamSection& section,
                                            const GaussRule& rule)
{
  const Index n = x.rows();
  const VectorXd nodes = VectorXd::LinSpaced(n, -1.0, 1.0);
  const MatrixXd N = lagrange(nodes, rule.x), N_xi = lagrange_derivatives(nodes, rule.x);
  std::vector<AxisPoint> points;
  for (Index q = 0; q < rule.x.size(); ++q) {
    const RowVector3d tangent = N_xi.row(q) * x;
    const double ds = tangent.norm();
    AxisPoint point{.length = ds * rule.w[q],
                    .x = N.row(q) * x,
                    .axes = beam_axes(tangent, section),
                    .motion = SectionForms::Zero(6, 6 * n),
                    .strain = SectionForms::Zero(6, 6 * n)};
    for (Index i = 0; i < n; ++i) {
      for (const Index rows : {0, 3}) {
        point.motion.block<3, 3>(rows, 6 * i + rows) = N(q, i) * point.axes;
        point.strain.block<3, 3>(rows, 6 * i + rows) = N_xi(q, i) / ds * point.axes;
      }
      point.strain.block<3, 3>(0, 6 * i + 3) = N(q, i) * turn_of_axis() * point.axes;
    }
    points.push_back(std::move(point));
  }
  return points;
}

/// [6 n x 6 n] The section forces at the Gauss points, of degree p - 1, continued to the nodes.
MatrixXd continued_forces(const BeamFields& fields, const GaussRule& rule, Index n)
{
  const MatrixXd to_nodes = lagrange(rule.x, VectorXd::LinSpaced(n, -1.0, 1.0));
  MatrixXd forces = MatrixXd::Zero(6 * n, 6 * n);
  for (Index i = 0; i < n; ++i)
    for (Index q = 0; q < rule.x.size(); ++q) {
      forces.middleRows<6>(6 * i) += (to_nodes(i, q) * fields.stiffness).asDiagonal() *
                                     fields.strained[static_cast<std::size_t>(q)].strain;
    }
  return forces;
}

BeamFields isoparametric_fields(const NodeVectors& x, const BeamSection& section)
{
  const Index p = x.rows() - 1;
  const BeamSection with = oriented(section, x);
  BeamFields fields{.stiffness = stiffness_of(section),
                    .strained = isoparametric_points(x, with, axis_rule(p)),
                    .moved = isoparametric_points(x, with, axis_rule(p + 1)),
                    .forces = {}};
  if (section.theory == BeamTheory::bernoulli_euler) {
    double length = 0.0;
    for (const AxisPoint& point : fields.strained) length += point.length;
    const double rigid = 1e5 * 12.0 / (length * length);
    fields.stiffness[1] = rigid * fields.stiffness[5];
    fields.stiffness[2] = rigid * fields.stiffness[4];
  }
  fields.forces = continued_forces(fields, axis_rule(p), x.rows());
  return fields;
}

}  // namespace

BeamFields beam_fields(const NodeVectors& x, const BeamSection& section, LineFields fields)
{
  const Index p = x.rows() - 1;
  const double chord = (x.row(p) - x.row(0)).norm();
  const bool is_best =
      fields == LineFields::best && is_straight(x) && is_slender(p, shear_ratios(section), chord);
  if (p == 1 || is_best) return SlenderLine(x, section).fields();
  return isoparametric_fields(x, section);
}

}  // namespace chladni::plate
