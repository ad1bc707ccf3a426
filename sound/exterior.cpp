#include "sound/exterior.hpp"

#include <cmath>

#include "common/eigen_every.hpp"
#include "sound/element_matrix.hpp"

namespace chladni::sound {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;
using Complex = std::complex<double>;
constexpr Complex i_unit{0.0, 1.0};

/// Nodes whose pressure is not zero by the end of the layer, by antisymmetry or, for n > 0, on the
/// axis.
std::vector<int> free_nodes(const AirMesh& mesh, int n)
{
  std::vector<char> held(std::size_t(mesh.n_nodes()));
  for (const int i : mesh.outer) held[std::size_t(i)] = 1;
  for (const int i : mesh.symmetry) held[std::size_t(i)] = 1;
  if (n > 0)
    for (const int i : mesh.axis) held[std::size_t(i)] = 1;
  std::vector<int> free;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (!held[std::size_t(i)]) free.push_back(i);
  return free;
}

/// The lower triangle over the free nodes.
ComplexFactor::Sparse assemble(const AirMesh& mesh, const Wave& wave, const AbsorbingLayer& layer,
                               const std::vector<int>& free)
{
  std::vector<int> row(std::size_t(mesh.n_nodes()), -1);
  for (std::size_t i = 0; i < free.size(); ++i) row[std::size_t(free[i])] = static_cast<int>(i);
  const MatrixXcd stretched = stretched_positions(mesh, wave.k(), layer);
  const ElementIntegral integral(mesh.basis, wave.k(), wave.n);
  std::vector<Eigen::Triplet<Complex>> entries;
  const Index n = mesh.elements.cols();
  entries.reserve(std::size_t(mesh.n_elements()) * std::size_t(n * (n + 1) / 2));
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const auto nodes = mesh.elements.row(e);
    const MatrixXcd s = stretched(nodes, every);
    const MatrixXd x = mesh.positions(nodes, every);
    const MatrixXcd K =
        s.imag().isZero(0.0) ? MatrixXcd(integral(x).cast<Complex>()) : integral(x, s);
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j) {
        const int r = row[std::size_t(nodes[i])], c = row[std::size_t(nodes[j])];
        if (c >= 0 && r >= c) entries.emplace_back(r, c, K(i, j));
      }
    }
  }
  const auto size = static_cast<Index>(free.size());
  ComplexFactor::Sparse A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

}  // namespace

MatrixXcd stretched_positions(const AirMesh& mesh, double k, const AbsorbingLayer& layer)
{
  MatrixXcd stretched = mesh.positions.cast<Complex>();
  const Index last = mesh.dimension() - 1;
  const double d = mesh.outer_radius - mesh.inner_radius;
  for (Index i = 0; i < stretched.rows(); ++i) {
    Eigen::RowVectorXd x = mesh.positions.row(i);
    x[last] -= mesh.centre;
    const double R = x.norm(), xi = (R - mesh.inner_radius) / d;
    if (xi < 1e-9) continue;
    stretched.row(i) -= i_unit * (layer.alpha * std::pow(xi, layer.m + 1) / (k * R)) * x;
  }
  return stretched;
}

Exterior::Exterior(std::shared_ptr<const AirMesh> mesh, const Wave& wave,
                   const AbsorbingLayer& layer)
    : mesh_(std::move(mesh)),
      wave_(wave),
      surface_(body_surface(*mesh_)),
      free_(free_nodes(*mesh_, mesh_->dimension() == 2 ? wave.n : 0)),
      factor_(std::make_unique<ComplexFactor>(assemble(*mesh_, wave, layer, free_)))
{}

MatrixXcd Exterior::pressure(const MatrixXcd& v_n)
{
  // integral of grad p . grad q - k^2 p q = i omega rho (integral of q v_n over the body)
  const MatrixXcd load = i_unit * (wave_.omega * wave_.medium.density) *
                         (surface_.trace.transpose().cast<Complex>() *
                          (surface_.weight.cast<Complex>().asDiagonal() * v_n));
  MatrixXcd p = MatrixXcd::Zero(mesh_->n_nodes(), v_n.cols());
  p(free_, every) = factor_->solve(load(free_, every));
  return p;
}

}  // namespace chladni::sound
