#include "cases/sector_forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cases/reduce_steps.hpp"
#include "cases/section_forces.hpp"
#include "common/eigen_every.hpp"
#include "cyclic/turn.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::seqN;
using mbs_export::ResultantModes;

/// Rows of the first sector: x of all coordinates of the whole body, then y.
RowsOf rows_of_phases(const std::vector<HarmonicPart>& parts,
                      const std::vector<std::vector<Index>>& places, Index n)
{
  return [&parts, &places, n](const std::vector<int>& dofs) -> MatrixXd {
    MatrixXd rows = MatrixXd::Zero(std::ssize(dofs), 2 * n);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      rows.leftCols(n)(every, places[p]) = parts[p].sector.x(dofs, every);
      rows.rightCols(n)(every, places[p]) = parts[p].sector.y(dofs, every);
    }
    return rows;
  };
}

std::int64_t largest_element(const mesh::Mesh& mesh)
{
  std::int64_t largest = 0;
  for (const mesh::ElementBlock& block : mesh.blocks)
    for (const std::int64_t number : block.numbers) largest = std::max(largest, number);
  return largest;
}

/// All around, sector by sector.
ResultantModes unfolded_forces(const ResultantModes& first, const SectorModel& model,
                               const std::vector<HarmonicPart>& parts,
                               const std::vector<std::vector<Index>>& places)
{
  const int count = model.dofs.count;
  const Index n = first.S.cols() / 2, n_points = first.positions.rows();
  const std::int64_t n_numbers = largest_element(model.mesh);
  ResultantModes whole{.name = first.name,
                       .kinds = first.kinds,
                       .units = first.units,
                       .elements = {},
                       .positions = ResultantModes::Rows(count * n_points, 3),
                       .axes = ResultantModes::Rows(count * n_points, 9),
                       .S = MatrixXd::Zero(count * first.S.rows(), n)};
  for (int sector = 0; sector < count; ++sector) {
    const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, count);
    for (const std::int64_t element : first.elements)
      whole.elements.push_back(element + sector * n_numbers);
    whole.positions.middleRows(sector * n_points, n_points) = first.positions * R.transpose();
    for (Index k = 0; k < 3; ++k) {
      whole.axes.block(sector * n_points, 3 * k, n_points, 3) =
          first.axes.middleCols<3>(3 * k) * R.transpose();
    }
    const auto rows = seqN(sector * first.S.rows(), first.S.rows());
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const double phase = 2.0 * std::numbers::pi * parts[p].order * sector / count;
      whole.S(rows, places[p]) = std::cos(phase) * first.S.leftCols(n)(every, places[p]) -
                                 std::sin(phase) * first.S.rightCols(n)(every, places[p]);
    }
  }
  return whole;
}

}  // namespace

std::vector<ResultantModes> sector_forces(const scene::Scene& scene, const SectorModel& model,
                                          const std::vector<HarmonicPart>& parts, Index n,
                                          Index n_masters)
{
  const auto places = places_of(parts, n_masters);
  std::vector<ResultantModes> forces = section_forces(
      scene.resultants, structure_of(scene), {.mesh = model.mesh, .dofs = model.system.dofs},
      rows_of_phases(parts, places, n));
  for (ResultantModes& of_group : forces)
    of_group = unfolded_forces(of_group, model, parts, places);
  return forces;
}

}  // namespace chladni::cases
