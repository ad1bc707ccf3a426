// What does a digit of the sound field cost, in the plane and in space, and how thin may the
// absorbing layer be?
//
// Usage: sound_convergence [--smallest] FILE.json

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mpi.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "sound/air_mesh.hpp"
#include "sound/field.hpp"
#include "tests/references/sound/exact_fields.hpp"
#include "tests/references/sound/thesis_disc.hpp"

namespace {

using namespace chladni::sound;
using testing::Multipole;

double cpu_s()
{
  return double(std::clock()) / CLOCKS_PER_SEC;
}

struct Row {
  std::string table, what;
  int order;
  double element_size;
  int unknowns;
  double mesh_s, solve_s, memory_MiB, error;
};

std::string text_of(const Row& row)
{
  return fmt::format(
      "{{\"table\": \"{}\", \"what\": \"{}\", \"order\": {}, \"element_size_m\": {:.6g}, "
      "\"unknowns\": {}, \"mesh_cpu_s\": {:.4f}, \"solve_cpu_s\": {:.4f}, \"memory_MiB\": {:.0f}, "
      "\"error\": {:.4e}}}",
      row.table, row.what, row.order, row.element_size, row.unknowns, row.mesh_s, row.solve_s,
      row.memory_MiB, row.error);
}

/// A sphere of 0.1 m at ka = 3, which pulsates (l = 0) or oscillates (l = 1).
Row sphere(int l, int order, double size, int dimension)
{
  const AirMeshOptions options{.order = order,
                               .element_size = size,
                               .edge_size = size,
                               .inner_radius = 0.2,
                               .shell_thickness = 0.1,
                               .half_space = dimension == 3 && l == 1};
  const double start = cpu_s();
  const auto mesh =
      std::make_shared<const AirMesh>(dimension == 2 ? mesh_meridian(testing::sphere(0.1), options)
                                                     : mesh_space(testing::sphere(0.1), options));
  const double meshed = cpu_s();
  Exterior exterior(mesh, {.medium = {}, .omega = 30.0 * 343.0, .n = 0},
                    {.alpha = order == 2 ? 5.0 : 10.0});
  const Multipole exact{l, 0};
  const Field field =
      solve(exterior, testing::normal_velocity(exact, exterior.wave(), exterior.surface()));
  const double solved = cpu_s();
  return {.table = dimension == 2 ? "sphere, plane" : "sphere, space",
          .what = l == 0 ? "pulsating" : "oscillating",
          .order = order,
          .element_size = size,
          .unknowns = exterior.n_unknowns(),
          .mesh_s = meshed - start,
          .solve_s = solved - meshed,
          .memory_MiB = exterior.memory_MiB(),
          .error = testing::mean_field_error(*mesh, field.wave, field.p.col(0), exact)};
}

/// The 20 mm disc at the squeal.
struct Disc {
  Row row;
  Field field;
};

AirMeshOptions around_disc(int order, double size, double edge)
{
  return {.order = order,
          .element_size = size,
          .edge_size = edge,
          .inner_radius = 0.22,
          .shell_thickness = 0.1,
          .half_space = true};
}

Disc disc(int order, double size, double edge, int dimension)
{
  const Outline outline = testing::solid_disc(testing::disc_radius, testing::disc_thickness);
  const AirMeshOptions options = around_disc(order, size, edge);
  const double start = cpu_s();
  const auto mesh = std::make_shared<const AirMesh>(dimension == 2 ? mesh_meridian(outline, options)
                                                                   : mesh_space(outline, options));
  const double meshed = cpu_s();
  Exterior exterior(mesh, testing::squeal_wave(), {.alpha = order == 2 ? 5.0 : 10.0});
  BodySurface meridian = exterior.surface();
  Eigen::MatrixXcd v_n;
  if (dimension == 2)
    v_n = testing::disc_velocity(meridian, 1.0);
  else
    v_n = testing::disc_velocity_in_space(meridian);
  Field field = solve(exterior, v_n);
  const double solved = cpu_s();
  return {{.table = dimension == 2 ? "disc, plane" : "disc, space",
           .what = fmt::format("rim {:.3g} mm", 1e3 * edge),
           .order = order,
           .element_size = size,
           .unknowns = exterior.n_unknowns(),
           .mesh_s = meshed - start,
           .solve_s = solved - meshed,
           .memory_MiB = exterior.memory_MiB(),
           .error = 0.0},
          std::move(field)};
}

/// Points around the disc, in the mesh and far from it.
Eigen::MatrixX3d listeners()
{
  Eigen::MatrixX3d x(40, 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Eigen::Index ring = i / 10;
    const double theta = 0.05 + 1.4 * double(i % 10) / 9.0, R = 0.19 + 0.17 * double(ring);
    const double phi = 0.7 * double(i);
    x.row(i) << R * std::sin(theta) * std::cos(phi), R * std::sin(theta) * std::sin(phi),
        R * std::cos(theta);
  }
  return x;
}

/// With cos(3 phi) in the plane.
Eigen::VectorXcd heard(const Field& field)
{
  const Eigen::MatrixX3d x = listeners();
  Eigen::VectorXcd p = pressure_at(field, x).col(0);
  if (field.mesh->dimension() == 2)
    for (Eigen::Index i = 0; i < p.size(); ++i)
      p[i] *= std::cos(3.0 * std::atan2(x(i, 1), x(i, 0)));
  return p;
}

/// How much of a wave the layer sends back, for several strengths and thicknesses.
Row layer(double thickness, double alpha, int m)
{
  const double k = 30.0, wavelength = 2.0 * std::numbers::pi / k;
  const AirMeshOptions options{.order = 6,
                               .element_size = 0.025,
                               .edge_size = 0.025,
                               .inner_radius = 0.15,
                               .shell_thickness = thickness * wavelength,
                               .half_space = false};
  const auto mesh = std::make_shared<const AirMesh>(mesh_meridian(testing::sphere(0.1), options));
  Exterior exterior(mesh, {.medium = {}, .omega = k * 343.0, .n = 0}, {.alpha = alpha, .m = m});
  const Multipole exact{1, 0};
  const Field field =
      solve(exterior, testing::normal_velocity(exact, exterior.wave(), exterior.surface()));
  return {.table = "layer",
          .what = fmt::format("{:.4g} wavelengths, alpha {:.3g}, m {}", thickness, alpha, m),
          .order = 6,
          .element_size = 0.025,
          .unknowns = exterior.n_unknowns(),
          .mesh_s = 0.0,
          .solve_s = 0.0,
          .memory_MiB = exterior.memory_MiB(),
          .error = testing::field_error(*mesh, field.wave, field.p.col(0), exact)};
}

class Report {
 public:
  void add(const Row& row)
  {
    rows_.push_back(text_of(row));
    std::printf("%s\n", rows_.back().c_str());
    std::fflush(stdout);
  }
  void write(const std::string& file) const
  {
    std::ofstream out(file);
    out << "[\n  " << fmt::format("{}", fmt::join(rows_, ",\n  ")) << "\n]\n";
    if (!out) throw chladni::Error(file + ": cannot be written");
  }

 private:
  std::vector<std::string> rows_;
};

void spheres(Report& report, bool smallest)
{
  for (const int l : {0, 1}) {
    for (const int order : {2, 4, 6})
      for (const double size : {0.1, 0.05, 0.025, 0.0125})
        if (!smallest || size > 0.04) report.add(sphere(l, order, size, 2));
    for (const double size : {0.06, 0.04, 0.025})
      if (!smallest || size > 0.05) report.add(sphere(l, 2, size, 3));
  }
}

void discs(Report& report, bool smallest)
{
  const Disc exact = disc(smallest ? 4 : 8, smallest ? 0.05 : 0.025, smallest ? 1e-3 : 1e-7, 2);
  const Eigen::VectorXcd p = heard(exact.field);
  const auto add = [&](Disc found) {
    found.row.error = (heard(found.field) - p).norm() / p.norm();
    report.add(found.row);
  };
  for (const int order : {2, 4, 6})
    for (const double edge : {4e-3, 1e-3, 2.5e-4, 2e-5})
      if (!smallest || edge > 2e-3) add(disc(order, 0.3 * order / 24.0, edge, 2));
  struct Size {
    double element, edge;
  };
  for (const auto& [element, edge] : {Size{0.06, 0.03}, Size{0.045, 0.02}, Size{0.034, 0.012},
                                      Size{0.03, 0.008}, Size{0.024, 0.005}})
    if (!smallest || element > 0.05) add(disc(2, element, edge, 3));
}

void layers(Report& report, bool smallest)
{
  for (const int m : {0, 1, 2})
    for (const double thickness : {0.0625, 0.125, 0.25, 0.5, 1.0})
      for (const double alpha : {1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0})
        if (!smallest || (alpha == 5.0 && thickness == 0.25))
          report.add(layer(thickness, alpha, m));
}

}  // namespace

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.size() > 2) {
    std::fprintf(stderr, "usage: sound_convergence [--smallest] FILE.json\n");
    return 2;
  }
  const bool smallest = words.size() == 2;
  Report report;
  spheres(report, smallest);
  discs(report, smallest);
  layers(report, smallest);
  report.write(words.back());
  MPI_Finalize();
  return 0;
}
