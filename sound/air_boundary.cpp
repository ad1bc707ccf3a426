#include "sound/air_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace chladni::sound {
namespace {

/// Of positions, relative to the outer radius.
constexpr double placement = 1e-7;

/// Places in an element of the corners of each face; see reference_faces.
std::vector<std::vector<int>> corners_of_faces(const LagrangeBasis& basis)
{
  const int dimension = basis.dimension();
  std::vector<std::vector<int>> faces(static_cast<std::size_t>(dimension + 1));
  for (int i = 0; i < basis.nodes().rows(); ++i) {
    const auto xi = basis.nodes().row(i).array();
    if (!((xi.abs() < placement) || ((xi - 1.0).abs() < placement)).all()) continue;
    for (int k = 0; k < dimension; ++k)
      if (xi[k] < placement) faces[std::size_t(k)].push_back(i);
    if (xi.sum() > 0.5) faces.back().push_back(i);
  }
  return faces;
}

/// Faces that belong to one element only.
std::vector<ElementFace> free_faces(const AirMesh& mesh)
{
  const auto corners = corners_of_faces(mesh.basis);
  std::map<std::vector<int>, std::pair<int, ElementFace>> faces;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    for (int f = 0; f < static_cast<int>(corners.size()); ++f) {
      std::vector<int> key;
      for (const int corner : corners[std::size_t(f)]) key.push_back(mesh.elements(e, corner));
      std::ranges::sort(key);
      auto& [count, face] = faces[key];
      ++count;
      face = {e, f};
    }
  }
  std::vector<ElementFace> free;
  for (const auto& [key, counted] : faces)
    if (counted.first == 1) free.push_back(counted.second);
  return free;
}

double longest_edge(const AirMesh& mesh)
{
  double longest = 0.0;
  for (int e = 0; e < mesh.n_elements(); ++e)
    for (int i = 0; i <= mesh.dimension(); ++i)  // Gmsh lists the corners first
      for (int j = 0; j < i; ++j) {
        longest = std::max(longest, (mesh.positions.row(mesh.elements(e, i)) -
                                     mesh.positions.row(mesh.elements(e, j)))
                                        .norm());
      }
  return longest;
}

}  // namespace

AirMesh with_boundary(AirMesh mesh, double sheet_radius)
{
  const double limit = placement * mesh.outer_radius;
  const int last = mesh.dimension() - 1;
  std::vector<char> outer(std::size_t(mesh.n_nodes())), symmetry(outer), axis(outer);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    Eigen::VectorXd x = mesh.positions.row(i).transpose();
    axis[std::size_t(i)] = last == 1 && std::abs(x[0]) < limit;
    const bool on_sheet = x.head(last).norm() < sheet_radius - limit;
    symmetry[std::size_t(i)] = mesh.half_space && std::abs(x[last]) < limit && !on_sheet;
    x[last] -= mesh.centre;
    outer[std::size_t(i)] = x.norm() > mesh.outer_radius - limit;
    if (axis[std::size_t(i)]) mesh.axis.push_back(i);
    if (symmetry[std::size_t(i)]) mesh.symmetry.push_back(i);
    if (outer[std::size_t(i)]) mesh.outer.push_back(i);
  }
  const auto corners = corners_of_faces(mesh.basis);
  for (const ElementFace& face : free_faces(mesh)) {
    const auto lies_in = [&](const std::vector<char>& set) {
      return std::ranges::all_of(corners[std::size_t(face.face)], [&](int corner) {
        return set[std::size_t(mesh.elements(face.element, corner))] != 0;
      });
    };
    if (!lies_in(outer) && !lies_in(symmetry) && !lies_in(axis)) mesh.body.push_back(face);
  }
  mesh.largest_edge = longest_edge(mesh);
  return mesh;
}

}  // namespace chladni::sound
