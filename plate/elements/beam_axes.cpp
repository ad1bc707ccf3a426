#include "plate/elements/beam_axes.hpp"

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
using Eigen::RowVector3d;
using Eigen::VectorXd;

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

}  // namespace chladni::plate
