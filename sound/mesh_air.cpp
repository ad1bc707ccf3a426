#include "sound/mesh_air.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstring>

#include "common/error.hpp"
#include "confinement/helper.hpp"
#include "sound/air_boundary.hpp"
#include "sound/air_of_gmsh.hpp"

namespace chladni::sound {
namespace {

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

}  // namespace chladni::sound
