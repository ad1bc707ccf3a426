#include "plate/elements/beam_fields.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "plate/elements/beam_axes.hpp"
#include "plate/elements/interpolation.hpp"
#include "plate/elements/straight_bending.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

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
