#include "obstacle_course.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace chladni::plate::testing {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double one_degree = std::numbers::pi / 180.0;

// Components held on a plane of symmetry with this normal.
const std::vector<int> symmetric_x{0, 4, 5}, symmetric_y{1, 3, 5}, symmetric_z{2, 3, 4};
const std::vector<int> all_six{0, 1, 2, 3, 4, 5};

bool everywhere(const Vector2d& /*uv*/)
{
  return true;
}

/// A cylinder about y: u along `angle` from the top, v along y up to `length`.
Surface cylinder(double radius, double angle, double length)
{
  return [=](double u, double v) {
    return Vector3d(radius * std::sin(angle * u), length * v, radius * std::cos(angle * u));
  };
}

Vector3d direction(double azimuth, double elevation)
{
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

VectorXd point_load(const ShellModel& model, int node, const Vector3d& force)
{
  VectorXd load = VectorXd::Zero(model.n_dofs());
  load.segment<3>(6 * node) = force;
  return load;
}

const Material hemisphere_material{.young = 6.825e7, .poisson = 0.3, .density = 1.0};

/// Unit forces outward at x = R and inward at y = R; nodes on the planes of symmetry are found by
/// position, since the three surfaces of the full hemisphere share u and v.
double hemisphere(const ShellModel& model)
{
  std::vector<Eigen::Index> free;
  int pulled = -1, pushed = -1;
  for (int node = 0; node < model.mesh.n_nodes(); ++node) {
    const Vector3d x = model.position(node);
    const bool on_x = std::abs(x[0]) < 1e-9, on_y = std::abs(x[1]) < 1e-9;
    if (on_y && std::abs(x[2]) < 1e-9) pulled = node;
    if (on_x && std::abs(x[2]) < 1e-9) pushed = node;
    for (int c = 0; c < 6; ++c) {
      const bool held = (on_x && (c == 0 || c == 4 || c == 5)) ||
                        (on_y && (c == 1 || c == 3 || c == 5)) || (node == pulled && c == 2);
      if (!held) free.push_back(6 * node + c);
    }
  }
  const VectorXd load =
      point_load(model, pulled, Vector3d::UnitX()) - point_load(model, pushed, Vector3d::UnitY());
  return solve(model, free, load)[6 * pulled];
}

}  // namespace

double scordelis_lo_roof(const Grid& grid)
{
  const ShellModel model = shell_model({cylinder(25.0, 40.0 * one_degree, 25.0)}, grid,
                                       {.young = 4.32e8, .poisson = 0.0, .density = 1.0}, 0.25);
  const auto free = free_dofs(
      model, {{on(0, 0.0), symmetric_x}, {on(1, 0.0), symmetric_y}, {on(1, 1.0), {0, 2}}});
  const VectorXd u = solve(model, free, area_load(model, {0.0, 0.0, -90.0}));
  return -u[6 * node_at(model, {1.0, 0.0}) + 2];
}

double pinched_cylinder(const Grid& grid)
{
  const ShellModel model = shell_model({cylinder(300.0, 90.0 * one_degree, 300.0)}, grid,
                                       {.young = 3e6, .poisson = 0.3, .density = 1.0}, 3.0);
  const auto free = free_dofs(model, {{on(0, 0.0), symmetric_x},
                                      {on(0, 1.0), symmetric_z},
                                      {on(1, 0.0), symmetric_y},
                                      {on(1, 1.0), {0, 2}}});
  const int top = node_at(model, {0.0, 0.0});
  return -solve(model, free, point_load(model, top, {0.0, 0.0, -0.25}))[6 * top + 2];
}

double hemisphere_with_hole(const Grid& grid)
{
  const Surface surface = [](double u, double v) {
    return Vector3d(10.0 * direction(90.0 * one_degree * u, 72.0 * one_degree * v));
  };
  return hemisphere(shell_model({surface}, grid, hemisphere_material, 0.04));
}

double full_hemisphere(const Grid& grid)
{
  // The octant's three corners, middles of sides and centre make three quadrilaterals.
  const std::array<Vector3d, 3> corner{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  std::vector<Surface> surfaces;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d a = corner[i];
    const Vector3d ab = (a + corner[(i + 1) % 3]).normalized();
    const Vector3d ca = (a + corner[(i + 2) % 3]).normalized();
    const Vector3d centre = Vector3d::Ones().normalized();
    surfaces.emplace_back([=](double u, double v) {
      return Vector3d(10.0 *
                      ((1 - u) * (1 - v) * a + u * (1 - v) * ab + u * v * centre + (1 - u) * v * ca)
                          .normalized());
    });
  }
  return hemisphere(shell_model(surfaces, grid, hemisphere_material, 0.04));
}

TwistedBeam twisted_beam(const Grid& grid, double thickness, double force)
{
  const Surface surface = [](double u, double v) {
    const double angle = 90.0 * one_degree * u;
    return Vector3d(12.0 * u, 1.1 * (v - 0.5) * std::cos(angle), 1.1 * (v - 0.5) * std::sin(angle));
  };
  const ShellModel model =
      shell_model({surface}, grid, {.young = 29e6, .poisson = 0.22, .density = 1.0}, thickness);
  const auto free = free_dofs(model, {{on(0, 0.0), all_six}});
  const auto displacement = [&](int component) {
    const Vector3d f = force * Vector3d::Unit(component);
    const VectorXd load = edge_load(model, grid, on(0, 1.0), f);
    return load.dot(solve(model, free, load)) / force;
  };
  return {.in_plane = displacement(2), .out_of_plane = displacement(1)};
}

double raasch_hook(const Grid& grid)
{
  constexpr double turn = 60.0 * one_degree;
  const Vector2d centre_1(0.0, 14.0);
  const Vector2d joint = centre_1 + 14.0 * Vector2d(std::sin(turn), -std::cos(turn));
  const Vector2d centre_2 = joint + 46.0 * Vector2d(std::sin(turn), -std::cos(turn));
  const Surface surface = [=](double u, double v) {
    // 4 of 14 parts of the grid lie on the small arc, of 10 degrees of the large one each more.
    const double first = 2.0 / 7.0;
    Vector2d x;
    if (u <= first) {
      const double angle = turn * u / first;
      x = centre_1 + 14.0 * Vector2d(std::sin(angle), -std::cos(angle));
    } else {
      const double angle = turn - 150.0 * one_degree * (u - first) / (1.0 - first);
      x = centre_2 + 46.0 * Vector2d(-std::sin(angle), std::cos(angle));
    }
    return Vector3d(x[0], x[1], 20.0 * v);
  };
  const ShellModel model =
      shell_model({surface}, grid, {.young = 3300.0, .poisson = 0.35, .density = 1.0}, 2.0);
  const auto free = free_dofs(model, {{on(0, 0.0), all_six}});
  const VectorXd load = edge_load(model, grid, on(0, 1.0), Vector3d::UnitZ());
  return load.dot(solve(model, free, load));
}

double morley_rhombus(const Grid& grid)
{
  const Surface surface = [](double u, double v) {
    return Vector3d(u + v * std::cos(30.0 * one_degree), v * std::sin(30.0 * one_degree), 0.0);
  };
  const Material material{.young = 1.0, .poisson = 0.3, .density = 1.0};
  const ShellModel model = shell_model({surface}, grid, material, 0.01);
  const auto free = free_dofs(model, {{everywhere, {0, 1, 5}}, {on_boundary, {2}}});
  const VectorXd u = solve(model, free, area_load(model, Vector3d::UnitZ()));
  const double D = 1e-6 / (12.0 * (1.0 - 0.09));
  return D * u[6 * node_at(model, {0.5, 0.5}) + 2];
}

double clamped_hypar(const Grid& grid, double thickness)
{
  const Surface surface = [](double u, double v) {
    const double x = u - 0.5, y = v - 0.5;
    return Vector3d(x, y, x * x - y * y);
  };
  const ShellModel model =
      shell_model({surface}, grid, {.young = 2e11, .poisson = 0.3, .density = 1.0}, thickness);
  const auto free = free_dofs(model, {{on(0, 0.0), all_six}});
  const VectorXd u =
      solve(model, free, area_load(model, {0.0, 0.0, -3.6e8 * std::pow(thickness, 3)}));
  return -u[6 * node_at(model, {1.0, 0.5}) + 2];
}

double thin_annulus(int order)
{
  const double h = 0.162e-4;
  const Material material{
      .young = 12.0 * 67100.0 * 0.91 / (h * h * h), .poisson = 0.3, .density = 126.0 / h};
  const Surface annulus = [](double u, double v) {
    const double angle = 2.0 * std::numbers::pi * u;
    const double r = 0.025 + 0.137 * v;
    return Vector3d(r * std::cos(angle), r * std::sin(angle), 0.0);
  };
  const ShellModel plate = shell_model(
      {annulus},
      {.shape = mesh::Shape::quadrilateral, .order = order, .n_u = 54 / order, .n_v = 30 / order},
      material, h);
  return frequencies(plate,
                     free_dofs(plate, {{[](const Eigen::Vector2d&) { return true; }, {0, 1, 5}},
                                       {on(1, 0.0), {2, 3, 4}}}),
                     6)[5];
}

}  // namespace chladni::plate::testing
