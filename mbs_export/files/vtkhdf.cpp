// The layout is that of https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html.
#include "mbs_export/files/vtkhdf.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

namespace chladni::mbs_export {
namespace {

using Eigen::Index;

/// Cells as VTK lists them, without repeated corners.
struct Cells {
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> offsets = {0};
  std::vector<std::uint8_t> types;
};

Cells vtk_cells(const Picture& picture)
{
  constexpr std::array<std::uint8_t, 5> types{0, 1, 3, 5, 9};  // vertex, line, triangle, quadrangle
  Cells cells;
  for (const std::array<int, 4>& corners : picture.cells) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (k == 0 || corners[k] != corners[k - 1]) cells.connectivity.push_back(corners[k]);
    const auto end = static_cast<std::int64_t>(cells.connectivity.size());
    cells.types.push_back(types[static_cast<std::size_t>(end - cells.offsets.back())]);
    cells.offsets.push_back(end);
  }
  return cells;
}

std::string mode_name(const ModalBody& body, Index j)
{
  return fmt::format("mode {:02d}, {:.6g} Hz", j + 1, body.omega[j] / (2.0 * std::numbers::pi));
}

}  // namespace

void write_vtkhdf(files::Writer& file, const ModalBody& body)
{
  const Index n = body.picture.positions.rows();
  if (n == 0) return;
  const auto count = [&](const std::string& name, std::size_t x) {
    const std::array values{static_cast<std::int64_t>(x)};
    file.write("VTKHDF/NumberOf" + name, std::span<const std::int64_t>(values), "1");
  };
  const Cells cells = vtk_cells(body.picture);
  file.group("VTKHDF/PointData");
  file.attribute("VTKHDF", "Version", std::array<std::int64_t, 2>{1, 0});
  file.attribute("VTKHDF", "Type", "UnstructuredGrid");
  count("Points", static_cast<std::size_t>(n));
  count("Cells", cells.types.size());
  count("ConnectivityIds", cells.connectivity.size());
  file.write("VTKHDF/Connectivity", std::span<const std::int64_t>(cells.connectivity), "1");
  file.write("VTKHDF/Offsets", std::span<const std::int64_t>(cells.offsets), "1");
  file.write("VTKHDF/Types", std::span<const std::uint8_t>(cells.types), "1");
  file.link("VTKHDF/Points", "/picture/positions");
  for (Index j = 0; j < body.n_modes(); ++j) {
    file.view_column("VTKHDF/PointData/" + mode_name(body, j),
                     {"/picture/displacements", 3 * n, body.n_modes(), j});
  }
}

}  // namespace chladni::mbs_export
