#include "cases/refined_errors.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "mesh/element_parts.hpp"
#include "plate/sections/profile.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// Of the finer model, from the differences to a finer and to a coarser one: they go on as a
/// geometric series, or as a slow one that is cut.
VectorXd extrapolated(const VectorXd& to_finer, const VectorXd& to_coarser)
{
  constexpr double slowest = 0.5;
  VectorXd errors = to_finer;
  for (Index i = 0; i < errors.size(); ++i)
    if (to_coarser[i] > 0.0) errors[i] /= 1.0 - std::min(to_finer[i] / to_coarser[i], slowest);
  return errors;
}

VectorXd relative_distance(const VectorXd& omega, const VectorXd& other)
{
  return (other - omega).cwiseAbs().cwiseQuotient(omega);
}

/// The least thickness of the shells at each node: free edges have a layer of that width, where the
/// twisting moment of a thin plate becomes its shear force.
std::vector<double> thicknesses(const scene::Scene& scene, const mesh::Mesh& mesh)
{
  std::vector<double> least(mesh.positions.size(), std::numeric_limits<double>::infinity());
  for (const plate::ShellSection& section : scene.sections)
    for (const int node : mesh::find_group(mesh, section.group).nodes) {
      const auto n = static_cast<std::size_t>(node);
      least[n] = std::min(least[n], plate::value_at(section.thickness, mesh.positions[n]));
    }
  return least;
}

/// Where an element is, and how large.
ErrorShare place_of(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                    const mesh::LatticeCell& corners)
{
  const std::span<const int> nodes = block.element_nodes(element);
  std::array<Eigen::Vector3d, 4> at;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const int node = nodes[static_cast<std::size_t>(corners[i])];
    at[i] =
        Eigen::Map<const Eigen::Vector3d>(mesh.positions[static_cast<std::size_t>(node)].data());
  }
  const bool is_triangle = corners[2] == corners[3];
  const Eigen::Vector3d sum = at[0] + at[1] + at[2] + at[3];
  const Eigen::Vector3d middle = is_triangle ? Eigen::Vector3d((sum - at[3]) / 3.0) : sum / 4.0;
  const double area = 0.5 * (at[2] - at[0]).cross(at[3] - at[1]).norm();
  return {
      .x = {middle[0], middle[1], middle[2]},
      .area = area,
      .size = std::sqrt(is_triangle ? 2.0 * area : area),  // two triangles are one quadrilateral
      .share = 0.0};
}

/// Of each mode the frequency that is further from that of the model.
VectorXd further(const VectorXd& omega, const VectorXd& one, const VectorXd& other)
{
  return ((one - omega).cwiseAbs().array() < (other - omega).cwiseAbs().array()).select(other, one);
}

}  // namespace

void find_by_halves(const scene::Scene& scene, const mesh::Mesh& mesh, const ModesOn& modes,
                    MeshErrors& found)
{
  constexpr double left = 0.25;
  const int order = mesh.blocks.front().order;
  RefinedModes finer = modes(plate::refined(mesh, {.parts = 2, .order = order}), Asked::where);
  found.finer = std::move(finer.omega);
  found.shape_errors = finer.shapes / (1.0 - left);
  const MatrixXd lacking = std::move(finer.lacking);
  const std::vector<double> rows = thicknesses(scene, mesh);
  if (plate::has_wide_edges(mesh, rows)) {
    plate::RefinedMesh cut = plate::refined(mesh, {.parts = 2, .order = order, .edge_rows = rows});
    if (plate::keeps_points(mesh, cut.mesh))
      found.finer = further(found.omega, found.finer, modes(std::move(cut), Asked::nothing).omega);
  }
  found.errors = relative_distance(found.omega, found.finer) / (1.0 - left);
  found.shares = error_shares(mesh, lacking, found.errors);
}

void find_by_orders(const mesh::Mesh& mesh, const ModesOn& modes, MeshErrors& found)
{
  const int order = mesh.blocks.front().order;
  RefinedModes finer = modes(plate::refined(mesh, {.parts = 1, .order = order + 1}), Asked::where);
  found.finer = std::move(finer.omega);
  found.shape_errors = std::move(finer.shapes);
  found.errors = relative_distance(found.omega, found.finer);
  if (order > 1) {
    plate::RefinedMesh coarser = plate::refined(mesh, {.parts = 1, .order = order - 1});
    if (plate::keeps_points(mesh, coarser.mesh)) {
      found.errors = extrapolated(
          found.errors,
          relative_distance(found.omega, modes(std::move(coarser), Asked::nothing).omega));
    }
  }
  found.shares = error_shares(mesh, finer.lacking, found.errors);
}

std::vector<ErrorShare> error_shares(const mesh::Mesh& mesh, const MatrixXd& lacking,
                                     const VectorXd& errors)
{
  std::vector<ErrorShare> shares;
  if (lacking.size() == 0 || errors.maxCoeff() <= 0.0) return shares;
  // What the energies of a mode count.
  const VectorXd sums = lacking.colwise().sum().transpose().cwiseMax(1e-300);
  const VectorXd weights = errors.cwiseQuotient(sums) / errors.maxCoeff();
  constexpr double much = 0.1;  // of the largest error
  Index row = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    const Index first = row;
    row += block.n_elements();
    if (block.shape == mesh::Shape::line) {
      const VectorXd of_lines =
          lacking.middleRows(first, block.n_elements()).colwise().sum().transpose();
      if (of_lines.cwiseProduct(weights).maxCoeff() > much) return {};
      continue;
    }
    const mesh::LatticeCell corners = mesh::lattice_cells(block, block.order).front();
    for (int e = 0; e < block.n_elements(); ++e) {
      shares.push_back(place_of(mesh, block, e, corners));
      shares.back().share = lacking.row(first + e).transpose().cwiseProduct(weights).maxCoeff();
    }
  }
  return shares;
}

std::vector<Index> by_shapes(MatrixXd shares)
{
  std::vector<Index> mode_of(static_cast<std::size_t>(shares.rows()), 0);
  for (Index k = 0; k < shares.rows(); ++k) {
    Index shape = 0, mode = 0;
    shares.maxCoeff(&shape, &mode);
    mode_of[static_cast<std::size_t>(shape)] = mode;
    shares.row(shape).setConstant(-1.0);
    shares.col(mode).setConstant(-1.0);
  }
  return mode_of;
}

MatrixXd differences(const MatrixXd& one, const MatrixXd& other)
{
  constexpr double still = 1e-3;  // of the largest component, and of what other modes do
  MatrixXd relative = MatrixXd::Zero(6, one.cols());
  for (Index c = 0; c < 6; ++c) {
    const auto of_kind = one.middleRows<3>(c < 3 ? 0 : 3);
    const double most = of_kind.maxCoeff();
    for (Index j = 0; j < one.cols(); ++j)
      if (one(c, j) > still * std::max(most, of_kind.col(j).maxCoeff()))
        relative(c, j) = std::abs(other(c, j) / one(c, j) - 1.0);
  }
  return relative;
}

}  // namespace chladni::cases
