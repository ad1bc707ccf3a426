#include "report/fe/sound_vtu.hpp"

#include <numbers>

#include "report/fe/vtu.hpp"
#include "sound/field_picture.hpp"
#include "sound/levels.hpp"

namespace chladni::report {
namespace {

constexpr int vtk_tetrahedron = 10;
constexpr int vtk_wedge = 13;

}  // namespace

std::string sound_vtu(const std::vector<sound::Tone>& tones)
{
  VtuGrid grid;
  if (tones.empty()) return vtu_text(grid);
  const sound::FieldPicture picture = sound::field_picture(tones.front());
  grid.points = picture.points;
  for (const std::vector<int>& cell : picture.cells) {
    grid.connectivity.insert(grid.connectivity.end(), cell.begin(), cell.end());
    grid.offsets.push_back(static_cast<int>(grid.connectivity.size()));
    grid.types.push_back(cell.size() == 6 ? vtk_wedge : vtk_tetrahedron);
  }
  Eigen::VectorXd level(picture.pressure.size());
  for (Eigen::Index i = 0; i < level.size(); ++i)
    level[i] = sound::level_dB(std::abs(picture.pressure[i]) / std::numbers::sqrt2);
  grid.of_points = {{.name = "pressure_re", .values = picture.pressure.real()},
                    {.name = "pressure_im", .values = picture.pressure.imag()},
                    {.name = "amplitude", .values = picture.pressure.cwiseAbs()},
                    {.name = "level_dB", .values = level}};
  return vtu_text(grid);
}

}  // namespace chladni::report
