#include "sound/exterior.hpp"

#include <fmt/format.h>
#include <metis.h>
#include <mpi.h>
#include <Eigen/LU>

#include <cmath>
#include <numbers>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "sound/helmholtz_element.hpp"

namespace chladni::sound {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

using Complex = std::complex<double>;
constexpr Complex imaginary_unit{0.0, 1.0};

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
    stretched.row(i) -= imaginary_unit * (layer.alpha * std::pow(xi, layer.m + 1) / (k * R)) * x;
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
  const MatrixXcd load = imaginary_unit * (wave_.omega * wave_.medium.density) *
                         (surface_.trace.transpose().cast<Complex>() *
                          (surface_.weight.cast<Complex>().asDiagonal() * v_n));
  MatrixXcd p = MatrixXcd::Zero(mesh_->n_nodes(), v_n.cols());
  p(free_, every) = factor_->solve(load(free_, every));
  return p;
}

namespace {

using Sparse = ComplexFactor::Sparse;

/// [n] place of each row in an order of elimination by nested dissection, from 1.
std::vector<int> nested_dissection(const Sparse& lower)
{
  const auto n = static_cast<std::size_t>(lower.rows());
  std::vector<idx_t> starts(n + 1, 0), neighbours;
  for (int j = 0; j < lower.outerSize(); ++j) {
    for (Sparse::InnerIterator a(lower, j); a; ++a) {
      if (a.row() == a.col()) continue;
      ++starts[std::size_t(a.row()) + 1];
      ++starts[std::size_t(a.col()) + 1];
    }
  }
  for (std::size_t i = 0; i < n; ++i) starts[i + 1] += starts[i];
  neighbours.resize(std::size_t(starts[n]));
  std::vector<idx_t> next(starts.begin(), starts.end() - 1);
  for (int j = 0; j < lower.outerSize(); ++j) {
    for (Sparse::InnerIterator a(lower, j); a; ++a) {
      if (a.row() == a.col()) continue;
      neighbours[std::size_t(next[std::size_t(a.row())]++)] = static_cast<idx_t>(a.col());
      neighbours[std::size_t(next[std::size_t(a.col())]++)] = static_cast<idx_t>(a.row());
    }
  }
  auto size = static_cast<idx_t>(n);
  std::vector<idx_t> order(n), place(n);
  if (METIS_NodeND(&size, starts.data(), neighbours.data(), nullptr, nullptr, order.data(),
                   place.data()) != METIS_OK)
    throw Error(fmt::format("METIS cannot order a matrix of {} rows", n));
  std::vector<int> places;
  for (const idx_t i : place) places.push_back(static_cast<int>(i) + 1);
  return places;
}

ZMUMPS_COMPLEX* entries(std::complex<double>* values)
{
  return reinterpret_cast<ZMUMPS_COMPLEX*>(values);  // both are two doubles
}

}  // namespace

ComplexFactor::ComplexFactor(const Sparse& lower) : order_(nested_dissection(lower))
{
  for (int j = 0; j < lower.outerSize(); ++j) {
    for (Sparse::InnerIterator a(lower, j); a; ++a) {
      rows_.push_back(static_cast<int>(a.row()) + 1);
      columns_.push_back(static_cast<int>(a.col()) + 1);
      values_.push_back(a.value());
    }
  }
  mumps_.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(MPI_COMM_SELF));
  mumps_.par = 1;
  mumps_.sym = 2;  // symmetric, indefinite
  call(-1, "start");
  mumps_.icntl[3] = 0;    // silent
  mumps_.icntl[6] = 1;    // ordering: ours
  mumps_.icntl[13] = 50;  // percent of working space for pivots that come late
  mumps_.n = static_cast<MUMPS_INT>(lower.rows());
  mumps_.nnz = static_cast<MUMPS_INT8>(values_.size());
  mumps_.irn = rows_.data();
  mumps_.jcn = columns_.data();
  mumps_.a = entries(values_.data());
  mumps_.perm_in = order_.data();
  call(1, "analysis");
  call(2, "factorisation");
}

ComplexFactor::~ComplexFactor()
{
  mumps_.job = -2;
  zmumps_c(&mumps_);
}

void ComplexFactor::call(int job, const char* what)
{
  mumps_.job = job;
  zmumps_c(&mumps_);
  if (mumps_.infog[0] >= 0) return;
  throw Error(
      fmt::format("MUMPS: the {} of {} complex equations failed with INFOG(1) = {}, "
                  "INFOG(2) = {}",
                  what, mumps_.n, mumps_.infog[0], mumps_.infog[1]));
}

Eigen::MatrixXcd ComplexFactor::solve(Eigen::MatrixXcd right_hand_sides)
{
  mumps_.nrhs = static_cast<MUMPS_INT>(right_hand_sides.cols());
  mumps_.lrhs = static_cast<MUMPS_INT>(right_hand_sides.rows());
  mumps_.rhs = entries(right_hand_sides.data());
  call(3, "solution");
  return right_hand_sides;
}

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
