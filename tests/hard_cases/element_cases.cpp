// Thin, warped, skew and distorted shells, on grids that are coarse for them.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "hard_case.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mesh/mesh_repair.hpp"
#include "mesh/quality.hpp"
#include "plate/elements/shell_element.hpp"
#include "tests/plate/elements/patch.hpp"
#include "tests/plate/elements/sample_elements.hpp"
#include "tests/plate/obstacle_course.hpp"
#include "tests/plate/square_plate.hpp"

namespace chladni::hard_cases {
namespace {

using namespace plate::testing;
using mesh::Shape;

const std::string deflection = "relative error of the deflection";

Grid squares(int order, int n, double distortion = 0.0)
{
  return {
      .shape = Shape::quadrilateral, .order = order, .n_u = n, .n_v = n, .distortion = distortion};
}

Grid triangles(int order, int n, double distortion = 0.0)
{
  return {.shape = Shape::triangle, .order = order, .n_u = n, .n_v = n, .distortion = distortion};
}

Grid strip(Shape shape, int order, int n_u, int n_v)
{
  return {.shape = shape, .order = order, .n_u = n_u, .n_v = n_v};
}

/// A long strip of a warped, curved surface, thin for its shorter side.
plate::ShellNodes slender_element(int order, double aspect)
{
  const Eigen::MatrixX2d P = lattice(Shape::quadrilateral, order);
  plate::ShellNodes nodes{.x = plate::NodeVectors(P.rows(), 3),
                          .D = plate::NodeVectors(P.rows(), 3)};
  for (Eigen::Index k = 0; k < P.rows(); ++k) {
    const double r = P(k, 0), s = P(k, 1) / aspect;
    nodes.x.row(k) << r + 0.2 * r * s, s, 0.2 * r * r + 0.1 * r * s;
    nodes.D.row(k) = 0.1 / aspect * Eigen::RowVector3d(-0.4 * r, -0.1 * r, 1.0).normalized();
  }
  return nodes;
}

/// Largest of the first six eigenvalues of K over its largest, of a slender warped element.
double rigid_modes_of_a_slender_element(int order, double aspect)
{
  const Eigen::MatrixXd K =
      plate::shell_matrices(Shape::quadrilateral, order, slender_element(order, aspect), steel_like)
          .K;
  const Eigen::VectorXd lambda =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::EigenvaluesOnly).eigenvalues();
  return lambda.head(6).cwiseAbs().maxCoeff() / lambda.maxCoeff();
}

/// Relative change of K when the model is turned, thickness 1e-4 of the element.
double change_by_turning_a_thin_element()
{
  plate::ShellNodes nodes = curved_element(Shape::quadrilateral, 3);
  nodes.D *= 1e-3;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, 1.0, -0.7).normalized()).toRotationMatrix();
  const Eigen::Index n = 2 * nodes.x.rows();
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) T.block<3, 3>(3 * i, 3 * i) = R;
  const auto stiffness = [](const plate::ShellNodes& at) {
    return plate::shell_matrices(Shape::quadrilateral, 3, at, steel_like).K;
  };
  const Eigen::MatrixXd here = stiffness(nodes), there = stiffness(rotated(nodes, R));
  return (T * here * T.transpose() - there).norm() / here.norm();
}

/// Over the patches of all shapes and orders.
double worst_patch(const Field& exact)
{
  double worst = 0.0;
  for (const auto& [shape, order] : patch_elements())
    worst = std::max(worst, patch_error(make_patch(shape, order), exact));
  return worst;
}

/// How many zero eigenvalues a free patch of any shape and order has beside its six rigid motions.
double needless_zero_modes()
{
  double most = 0.0;
  for (const auto& [shape, order] : patch_elements()) {
    const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                       make_patch(shape, order).K, Eigen::EigenvaluesOnly)
                                       .eigenvalues();
    const auto n_zero = (lambda.array().abs() < 1e-12 * lambda.maxCoeff()).count();
    most = std::max(most, std::abs(double(n_zero) - 6.0));
  }
  return most;
}

/// Triangles around a node in a square of side 2 m.
mesh::Mesh fan(const std::array<double, 3>& middle)
{
  mesh::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0},
                    {1, 2, 0}, {0, 2, 0}, {0, 1, 0}, middle};
  mesh::ElementBlock block{.shape = Shape::triangle,
                           .order = 1,
                           .nodes_per_element = 3,
                           .numbers = {},
                           .nodes = {},
                           .group = std::vector<int>(8, 0)};
  for (int i = 0; i < 8; ++i) {
    block.numbers.push_back(i + 1);
    block.nodes.insert(block.nodes.end(), {i, (i + 1) % 8, 8});
  }
  for (int i = 0; i < mesh.n_nodes(); ++i) mesh.node_numbers.push_back(i + 1);
  mesh.groups.push_back({.name = "plate", .dimension = 2, .nodes = {}});
  mesh.blocks.push_back(block);
  return mesh;
}

/// Elements of a plate, each in two groups, that are more than it has.
double elements_counted_twice()
{
  mesh::Mesh mesh = plate::testing::rectangle({.a = 2.0, .b = 1.0, .n_x = 4, .n_y = 3, .order = 2});
  mesh.groups.push_back({.name = "all", .dimension = 2, .nodes = {}});
  mesh::ElementBlock& block = mesh.blocks.front();
  const int n = block.n_elements();
  const std::vector<int> nodes = block.nodes;
  block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
  for (int i = 0; i < n; ++i) {
    block.numbers.push_back(n + 1 + i);
    block.group.push_back(int(mesh.groups.size()) - 1);
  }
  mesh::merge_doubled_elements(mesh, {});
  return std::abs(double(mesh.blocks.front().n_elements() - n));
}

/// Relative error of the mass of a prism of twelve sides, radius 1 m, with four elements a side.
double mass_of_a_prism(int order)
{
  constexpr double t = 0.02;
  constexpr int n = 12;
  std::vector<Surface> sides;
  for (int i = 0; i < n; ++i) {
    const auto corner = [=](int k) {
      const double angle = 2.0 * std::numbers::pi * k / n;
      return Eigen::Vector3d(std::cos(angle), 0.0, std::sin(angle));
    };
    sides.emplace_back([=](double u, double v) {
      return Eigen::Vector3d((1.0 - u) * corner(i) + u * corner(i + 1) +
                             v * Eigen::Vector3d::UnitY());
    });
  }
  const ShellModel model = shell_model(sides, squares(order, 4), steel_like, t);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(model.n_dofs());
  for (Eigen::Index i = 0; i < r.size(); i += 6) r[i] = 1.0;
  const double area = 2.0 * n * std::sin(std::numbers::pi / n);
  return relative_error(r.dot(model.M * r), steel_like.density * t * area);
}

}  // namespace

double relative_error(double value, double exact)
{
  return std::abs(value / exact - 1.0);
}

std::vector<HardCase> element_cases()
{
  const std::string area = "elements";
  return {
      {area, "triangles turned over in a flat fan", "each is a good element by itself",
       "words missing in the refusal", 0.0,
       [] {
         return words_missing(
             [] {
               mesh::check_usable(fan({2.3, 2.1, 0.0}), "fan");
             },
             {"fan", "2 and 3"});
       }},
      {area, "each element in two groups", "a file has a line for each group",
       "elements counted twice", 0.0, elements_counted_twice},
      {area, "prism of twelve sides, order 3", "the thickness is measured along common normals",
       "relative error of the mass", 1e-12, [] { return mass_of_a_prism(3); }},
      {area, "hemisphere with a hole, R/t = 250, order 1, distorted",
       "bending without stretching: membrane locking of warped elements", deflection, 0.03,
       [] { return relative_error(hemisphere_with_hole(squares(1, 16, 0.3)), 0.0935); }},
      {area, "hemisphere with a hole, triangles of order 2, distorted",
       "membrane locking of curved triangles", deflection, 0.03,
       [] { return relative_error(hemisphere_with_hole(triangles(2, 8, 0.3)), 0.0935); }},
      {area, "full hemisphere, R/t = 250, order 3, distorted",
       "three patches meet in warped elements", deflection, 0.012,
       [] { return relative_error(full_hemisphere(squares(3, 5, 0.3)), 0.0924); }},
      {area, "pinched cylinder, R/t = 100, order 2, distorted",
       "inextensional bending beside strong stretching under a point load", deflection, 0.02,
       [] { return relative_error(pinched_cylinder(squares(2, 16, 0.3)), 1.8248e-5); }},
      {area, "Scordelis-Lo roof, order 2, distorted", "membrane and bending of one size",
       deflection, 0.006,
       [] { return relative_error(scordelis_lo_roof(squares(2, 8, 0.3)), 0.3024); }},
      {area, "twisted beam, t/b = 0.003, order 1", "elements warped by 6 degrees each", deflection,
       0.02,
       [] {
         return relative_error(
             twisted_beam(strip(Shape::quadrilateral, 1, 32, 4), 0.0032, 1e-6).in_plane, 0.005256);
       }},
      {area, "twisted beam, t/b = 0.003, triangles of order 2",
       "the weak spot of curved triangles, 0.84 without Regge strains", deflection, 0.012,
       [] {
         return relative_error(
             twisted_beam(strip(Shape::triangle, 2, 16, 2), 0.0032, 1e-6).in_plane, 0.005256);
       }},
      {area, "twisted beam, t/b = 0.003, triangles of order 3", "the same at the highest order",
       deflection, 0.012,
       [] {
         return relative_error(
             twisted_beam(strip(Shape::triangle, 3, 10, 1), 0.0032, 1e-6).in_plane, 0.005256);
       }},
      {area, "Raasch's hook, order 2", "curved beam, bending coupled to torsion through shear",
       deflection, 0.02,
       [] { return relative_error(raasch_hook(strip(Shape::quadrilateral, 2, 14, 8)), 5.02); }},
      {area, "Morley's rhombus of 30 degrees, order 3", "moments singular at the blunt corners",
       deflection, 0.05, [] { return relative_error(morley_rhombus(squares(3, 15)), 0.42482e-3); }},
      {area, "clamped hyperbolic paraboloid, t/L = 1e-4, order 2",
       "bending dominated, negative curvature: locks by any parasitic stretching", deflection, 0.05,
       [] { return relative_error(clamped_hypar(squares(2, 16), 1e-4), 2.3856e-4); }},
      {area, "the same, triangles of order 2", "triangles lock where quadrilaterals do not",
       deflection, 0.2,
       [] { return relative_error(clamped_hypar(triangles(2, 16), 1e-4), 2.3856e-4); }},
      {area, "warped element of aspect ratio 1000, order 3", "sides differ by three digits",
       "rigid-body eigenvalue over the largest", 1e-13,
       [] { return rigid_modes_of_a_slender_element(3, 1e3); }},
      {area, "thin warped element, turned",
       "bending is 1e-6 of stretching: round-off of a rotation", "relative change of K", 1e-12,
       change_by_turning_a_thin_element},
      {area, "distorted patches of all shapes and orders, stretched",
       "assumed membrane strains need their mean corrected", "relative error inside", 1e-10,
       [] { return worst_patch(constant_membrane_strain); }},
      {area, "the same, bent and twisted", "S8R fails it by 0.24", "relative error inside", 1e-10,
       [] { return worst_patch(constant_curvature); }},
      {area, "the same, free", "reduced integration and free drilling leave hourglass modes",
       "zero modes beside the rigid ones, or missing", 0.0, needless_zero_modes},
      {area, "annulus, h/r_a = 1e-4, order 3, 30 DOFs along the radius",
       "shear locking is a factor of 10 to 100 here", "relative error of the frequency", 1e-4,
       [] { return relative_error(thin_annulus(3), thin_annulus_Hz); }},
  };
}

}  // namespace chladni::hard_cases
