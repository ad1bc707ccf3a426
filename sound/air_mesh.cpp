#include "sound/air_mesh.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "common/confinement/helper_process.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "sound/air_of_gmsh.hpp"

namespace chladni::sound {

using Eigen::MatrixXd, Eigen::RowVectorXd;

namespace {

/// Of positions, relative to the outer radius.
constexpr double face_placement = 1e-7;

/// Places in an element of the corners of each face; see reference_faces.
std::vector<std::vector<int>> corners_of_faces(const LagrangeBasis& basis)
{
  const int dimension = basis.dimension();
  std::vector<std::vector<int>> faces(static_cast<std::size_t>(dimension + 1));
  for (int i = 0; i < basis.nodes().rows(); ++i) {
    const auto xi = basis.nodes().row(i).array();
    if (!((xi.abs() < face_placement) || ((xi - 1.0).abs() < face_placement)).all()) continue;
    for (int k = 0; k < dimension; ++k)
      if (xi[k] < face_placement) faces[std::size_t(k)].push_back(i);
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

/// Finds the boundary faces and nodes of a mesh: on the outer sphere, on the axis or in the plane
/// of symmetry; all other free faces belong to the body.
/// @param sheet_radius  radius of a thin disc in the plane of symmetry, m; it belongs to the body
AirMesh with_boundary(AirMesh mesh, double sheet_radius)
{
  const double limit = face_placement * mesh.outer_radius;
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

void check_radius(const Outline& outline, const AirMeshOptions& options, const Ball& ball)
{
  if (options.inner_radius > ball.radius) return;
  throw Error(fmt::format(
      "sound: the absorbing shell begins at {:.6g} m, inside the body of radius {:.6g} m; let it "
      "begin at {:.4g} m or more",
      options.inner_radius, ball.radius, ball.radius + 2.0 * smallest_length(outline)));
}

/// Of a mesher that gave no answer.
std::string explain(const confinement::Outcome& outcome)
{
  return outcome.end == confinement::End::killed_by_signal
             ? fmt::format(
                   "sound: Gmsh crashed on the mesh of the air ({}); take another size of "
                   "its elements",
                   strsignal(outcome.code))
             : "sound: there is not enough memory to mesh the air; take larger elements";
}

AirOfGmsh ask_mesher(const AirQuestion& air)
{
  constexpr double unlimited = 1e8;  // s
  Packer question;
  question(std::string("air"));
  pack(question, air);
  AirOfGmsh made{};
  confinement::ask(
      {.program = confinement::helper(confinement::mesher),
       .question = question.bytes(),
       .most_seconds = unlimited,
       .most_bytes = std::size_t(sysconf(_SC_PHYS_PAGES)) * std::size_t(sysconf(_SC_PAGESIZE))},
      explain, [&](Unpacker& answer) { made = unpack_air(answer); });
  return made;
}

AirMesh mesh_air(const Outline& outline, const AirMeshOptions& options, int dimension)
{
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Ball ball = enclosing_ball(outline);
  check_radius(outline, options, ball);
  const AirOfGmsh air = ask_mesher({outline, options, dimension, ball.z});
  const int n = air.nodes_per_element;
  const Rows reference = Eigen::Map<const Rows>(air.reference.data(), n, dimension);
  const auto n_nodes = std::ssize(air.positions) / dimension;
  AirMesh mesh{
      .basis = LagrangeBasis(reference, air.order),
      .positions = Eigen::Map<const Rows>(air.positions.data(), n_nodes, dimension),
      .elements = Eigen::Map<const Nodes>(air.elements.data(), std::ssize(air.elements) / n, n),
      .body = {},
      .outer = {},
      .symmetry = {},
      .axis = {},
      .centre = ball.z,
      .inner_radius = options.inner_radius,
      .outer_radius = options.inner_radius + options.shell_thickness,
      .largest_edge = 0.0,
      .half_space = options.half_space};
  return with_boundary(std::move(mesh), outline.sheet_radius);
}

}  // namespace

AirMesh mesh_meridian(const Outline& outline, const AirMeshOptions& options)
{
  return mesh_air(outline, options, 2);
}

AirMesh mesh_space(const Outline& outline, const AirMeshOptions& options)
{
  return mesh_air(outline, options, 3);
}

Locator::Locator(std::shared_ptr<const AirMesh> mesh)
    : mesh_(std::move(mesh)), low_(mesh_->n_elements(), mesh_->dimension()), high_(low_)
{
  for (int e = 0; e < mesh_->n_elements(); ++e) {
    const MatrixXd x = mesh_->positions(mesh_->elements.row(e), every);
    const RowVectorXd size = x.colwise().maxCoeff() - x.colwise().minCoeff();
    low_.row(e) = x.colwise().minCoeff() - 0.05 * size;  // curved edges bulge
    high_.row(e) = x.colwise().maxCoeff() + 0.05 * size;
  }
}

std::optional<RowVectorXd> Locator::reference_place(int element, const RowVectorXd& x) const
{
  const int dimension = mesh_->dimension();
  const MatrixXd X = mesh_->positions(mesh_->elements.row(element), every);
  RowVectorXd xi = RowVectorXd::Constant(dimension, 1.0 / (dimension + 1));
  for (int step = 0; step < 20; ++step) {
    const RowVectorXd rest = x - mesh_->basis.values(xi) * X;
    MatrixXd J(dimension, dimension);
    for (int d = 0; d < dimension; ++d) J.row(d) = mesh_->basis.derivatives(xi, d) * X;
    const RowVectorXd move = rest * J.inverse();
    xi += move;
    if (!(xi.cwiseAbs().maxCoeff() < 3.0)) return std::nullopt;
    if (move.norm() < 1e-12) break;
  }
  constexpr double slack = 1e-8;
  if (xi.minCoeff() < -slack || xi.sum() > 1.0 + slack) return std::nullopt;
  return xi;
}

Eigen::RowVectorXcd Locator::value(const Eigen::Vector3d& x, const Eigen::MatrixXcd& p) const
{
  const bool mirrored = mesh_->half_space && x[2] < 0.0;
  const double z = mirrored ? -x[2] : x[2];
  RowVectorXd at(mesh_->dimension());
  if (mesh_->dimension() == 2)
    at << x.head<2>().norm(), z;
  else
    at << x[0], x[1], z;
  for (int e = 0; e < mesh_->n_elements(); ++e) {
    if ((at.array() < low_.row(e).array()).any() || (at.array() > high_.row(e).array()).any())
      continue;
    const auto xi = reference_place(e, at);
    if (!xi) continue;
    const MatrixXd N = mesh_->basis.values(*xi);
    return (mirrored ? -1.0 : 1.0) * (N * p(mesh_->elements.row(e), every));
  }
  throw Error(
      fmt::format("the point ({:.6g}, {:.6g}, {:.6g}) m is inside the body", x[0], x[1], x[2]));
}

}  // namespace chladni::sound
