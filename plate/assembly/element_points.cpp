#include "plate/assembly/element_points.hpp"

#include "plate/sections/directors.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::MatrixXd;

PlacedPoints element_points(const MassModel& model, const mesh::ElementBlock& block, int element)
{
  const int group = block.group[element];
  const NodeVectors x = element_positions(model.mesh, block, element);
  if (block.shape == mesh::Shape::line) {
    const LineFields fields = line_fields(model.sections.on_surface, block.element_nodes(element));
    return {
        .points = beam_mass_points(x, model.structure.beams[model.sections.beam[group]], fields),
        .arms = {}};
  }
  const ShellSection& section = model.structure.shells[model.sections.shell[group]];
  const ShellNodes shell = shell_nodes(model.mesh, block, element, model.directors, section);
  PlacedPoints placed{
      .points = shell_mass_points(block.shape, block.order, shell, section.material.density),
      .arms = {}};
  if (section.offset != Profile(0.0)) placed.arms = shell.x - x;
  return placed;
}

MatrixXd element_moments(const MassPoints& points)
{
  MatrixXd moments(points.N[0].cols(), n_moments);
  for (Index l = 0; l < 3; ++l) {
    const StrainRows& N_l = points.N[static_cast<std::size_t>(l)];
    moments.col(l) = N_l.transpose() * points.dm;
    for (Index k = 0; k < 3; ++k)
      moments.col(3 + 3 * k + l) = N_l.transpose() * points.dm.cwiseProduct(points.x.col(k));
  }
  return moments;
}

}  // namespace chladni::plate
