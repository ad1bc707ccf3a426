#include "plate/elements/beam_element.hpp"

#include "plate/elements/strain_energy.hpp"

namespace chladni::plate {

namespace {

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

}  // namespace chladni::plate
