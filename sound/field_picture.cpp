#include "sound/field_picture.hpp"
#include "common/eigen_every.hpp"

#include <cmath>
#include <map>
#include <numbers>

namespace chladni::sound {
namespace {

using Eigen::Index, Eigen::Vector3d;
using std::numbers::pi;

constexpr int n_angles = 48;

/// Whether all corners of an element, which Gmsh lists first, are before the absorbing shell.
bool is_inner(const AirMesh& mesh, int element)
{
  for (Index i = 0; i <= mesh.dimension(); ++i) {
    Eigen::RowVectorXd x = mesh.positions.row(mesh.elements(element, i));
    x[mesh.dimension() - 1] -= mesh.centre;
    if (x.norm() > mesh.inner_radius * (1.0 + 1e-9)) return false;
  }
  return true;
}

/// Corners of the small triangles as places in an element whose nodes form a lattice; every third
/// line of it at order 6, every second at order 4.
std::vector<std::array<int, 3>> small_triangles(const LagrangeBasis& basis)
{
  const int p = basis.order(), step = p % 3 == 0 ? 3 : p % 2 == 0 ? 2 : 1, m = p / step;
  std::map<std::pair<int, int>, int> place;
  for (Index i = 0; i < basis.nodes().rows(); ++i) {
    place[{static_cast<int>(std::lround(p * basis.nodes()(i, 0))),
           static_cast<int>(std::lround(p * basis.nodes()(i, 1)))}] = static_cast<int>(i);
  }
  const auto at = [&](int i, int j) { return place.at({step * i, step * j}); };
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i + j < m; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + j + 2 <= m) triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return triangles;
}

/// Gives each node that is used a row of its own.
class Rows {
 public:
  int row(int node)
  {
    const auto [it, is_new] = row_.emplace(node, static_cast<int>(nodes.size()));
    if (is_new) nodes.push_back(node);
    return it->second;
  }
  std::vector<int> nodes;

 private:
  std::map<int, int> row_;
};

FieldPicture revolved(const Tone& tone)
{
  const Triangles plane = inner_triangles(*tone.fields[0].mesh);
  const Index n = plane.nodes.rows(), n_cells = plane.corners.rows();
  FieldPicture picture{Eigen::MatrixX3d(n * n_angles, 3), {}, Eigen::VectorXcd(n * n_angles)};
  for (int a = 0; a < n_angles; ++a) {
    const double phi = 2.0 * pi * a / n_angles;
    for (Index i = 0; i < n; ++i) {
      const double r = plane.nodes(i, 0);
      picture.points.row(a * n + i) << r * std::cos(phi), r * std::sin(phi), plane.nodes(i, 1);
      std::complex<double> p = 0.0;
      for (const Field& field : tone.fields) {
        const auto amplitude = field.p.row(plane.index[std::size_t(i)]);
        p += amplitude[0] * std::cos(field.wave.n * phi) +
             amplitude[1] * std::sin(field.wave.n * phi);
      }
      picture.pressure[a * n + i] = p;
    }
    const int next = (a + 1) % n_angles;
    for (Index c = 0; c < n_cells; ++c) {
      std::vector<int> wedge;
      for (const int slice : {a, next})
        for (Index k = 0; k < 3; ++k)
          wedge.push_back(static_cast<int>(slice * n + plane.corners(c, k)));
      picture.cells.push_back(std::move(wedge));
    }
  }
  return picture;
}

FieldPicture tetrahedra(const Field& field)
{
  const AirMesh& mesh = *field.mesh;
  FieldPicture picture;
  Rows rows;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!is_inner(mesh, e)) continue;
    std::vector<int> cell;
    for (Index k = 0; k < 4; ++k) cell.push_back(rows.row(mesh.elements(e, k)));
    picture.cells.push_back(std::move(cell));
  }
  picture.points = mesh.positions(rows.nodes, every);
  picture.pressure = field.p.col(0)(rows.nodes);
  return picture;
}

/// With the opposite field below z = 0.
FieldPicture mirrored(const FieldPicture& upper)
{
  const Index n = upper.points.rows();
  FieldPicture both{Eigen::MatrixX3d(2 * n, 3), upper.cells, Eigen::VectorXcd(2 * n)};
  both.points << upper.points, upper.points * Vector3d(1.0, 1.0, -1.0).asDiagonal();
  both.pressure << upper.pressure, -upper.pressure;
  for (std::vector<int> cell : upper.cells) {
    for (int& corner : cell) corner += static_cast<int>(n);
    both.cells.push_back(std::move(cell));
  }
  return both;
}

}  // namespace

Triangles inner_triangles(const AirMesh& mesh)
{
  const auto small = small_triangles(mesh.basis);
  Rows rows;
  std::vector<int> corners;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!is_inner(mesh, e)) continue;
    for (const auto& triangle : small)
      for (const int place : triangle) corners.push_back(rows.row(mesh.elements(e, place)));
  }
  Triangles triangles{
      mesh.positions(rows.nodes, every), rows.nodes, {static_cast<Index>(corners.size()) / 3, 3}};
  std::ranges::copy(corners, triangles.corners.data());
  return triangles;
}

FieldPicture field_picture(const Tone& tone)
{
  const Field& first = tone.fields[0];
  FieldPicture picture = first.mesh->dimension() == 3 ? tetrahedra(first) : revolved(tone);
  return first.mesh->half_space ? mirrored(picture) : picture;
}

}  // namespace chladni::sound
