#include "sound/body_surface.hpp"
#include "common/eigen_every.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace chladni::sound {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

BodySurface body_surface(const AirMesh& mesh)
{
  const int dimension = mesh.dimension();
  const auto faces = reference_faces(dimension, 2 * mesh.basis.order() + 2);
  const Index per_face = faces[0].quadrature.weights.size();
  const Index n = static_cast<Index>(mesh.body.size()) * per_face;
  BodySurface surface{MatrixXd(n, dimension), MatrixXd(n, dimension), VectorXd(n), {}};
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<MatrixXd> values;
  std::vector<std::vector<MatrixXd>> slopes;
  for (const ReferenceFace& face : faces) {
    values.push_back(mesh.basis.values(face.quadrature.points));
    slopes.emplace_back();
    for (int d = 0; d < dimension; ++d)
      slopes.back().push_back(mesh.basis.derivatives(face.quadrature.points, d));
  }
  Index at = 0;
  for (const auto& [element, f] : mesh.body) {
    const auto nodes = mesh.elements.row(element);
    const MatrixXd X = mesh.positions(nodes, every);
    const auto side = static_cast<std::size_t>(f);
    for (Index q = 0; q < per_face; ++q, ++at) {
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> J(dimension, dimension);
      for (int d = 0; d < dimension; ++d) J.row(d) = slopes[side][std::size_t(d)].row(q) * X;
      // Nanson: the vectorial area is |det J| J^-1 times that of the reference cell, out of the
      // air.
      const VectorXd area = std::abs(J.determinant()) * (J.inverse() * faces[side].normal);
      surface.x.row(at) = values[side].row(q) * X;
      surface.normal.row(at) = -area.normalized().transpose();
      surface.weight[at] = faces[side].quadrature.weights[q] * area.norm() *
                           (dimension == 2 ? surface.x(at, 0) : 1.0);
      for (Index i = 0; i < nodes.size(); ++i)
        if (std::abs(values[side](q, i)) > 1e-13)
          entries.emplace_back(int(at), nodes[i], values[side](q, i));
    }
  }
  surface.trace.resize(n, mesh.n_nodes());
  surface.trace.setFromTriplets(entries.begin(), entries.end());
  return surface;
}

double surface_measure(const AirMesh& mesh, int n)
{
  const double halves = mesh.half_space ? 2.0 : 1.0;
  if (mesh.dimension() == 3) return halves;
  return halves * (n == 0 ? 2.0 : 1.0) * std::numbers::pi;
}

}  // namespace chladni::sound
