// How many unknowns and how much time does each element need for the flexural frequencies of an
// annular plate, thick and thin, on polar grids and on the meshes that Gmsh makes?
// Prints JSON lines: one run each, with frequencies and nodal diameters; report.py compares them
// with the exact values.
// usage: element_convergence [--smallest]

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <string_view>

#include "bending_modes.hpp"
#include "common/petsc.hpp"
#include "mesh/generators.hpp"
#include "polar_grid.hpp"

namespace chladni::benchmarks {
namespace {

// Steinbrecher 2015, table 5.1: D and the mass per area stay the same for every thickness.
constexpr double r_i = 0.025, r_a = 0.162, D = 67100.0, nu = 0.3, mass_per_area = 126.0;

plate::ShellSection section(double ratio)
{
  const double h = r_a / ratio;
  return {.group = "disc",
          .material = {.young = 12.0 * D * (1.0 - nu * nu) / (h * h * h),
                       .poisson = nu,
                       .density = mass_per_area / h},
          .thickness = h};
}

struct Element {
  const char* name;
  int order;
  Formulation formulation;
};

constexpr Element elements[] = {{"order 1", 1, Formulation::family},
                                {"order 2", 2, Formulation::family},
                                {"order 3", 3, Formulation::family},
                                {"S8R", 2, Formulation::serendipity}};

/// Width of the edge rows: that of the layer in which the twisting moment of a shear-flexible plate
/// falls to zero, if the elements are wider and the layer is worth more than 1e-5 of a frequency.
double edge_row(double ratio, int n_r)
{
  const double h = r_a / ratio;
  return h < (r_a - r_i) / n_r && ratio < 5000.0 ? h : 0.0;
}

mesh::Mesh make_mesh(const char* kind, double ratio, int order, int n_r)
{
  const double row = edge_row(ratio, n_r);
  if (kind[0] == 's') return polar_grid({r_i, r_a, order, row > 0.0 ? n_r + 2 : n_r, row});
  mesh::AnnulusOptions options{.inner_radius = r_i,
                               .outer_radius = r_a,
                               .element_size = (r_a - r_i) / n_r,
                               .element_order = order,
                               .rings = {}};
  if (row > 0.0) options.edge_row = row;
  return mesh::annulus(options);
}

double share_of_triangles(const mesh::Mesh& mesh)
{
  int n = 0, n_triangles = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    n += block.n_elements();
    if (block.shape == mesh::Shape::triangle) n_triangles += block.n_elements();
  }
  return double(n_triangles) / n;
}

void run(double ratio, const char* kind, const Element& element, int n_r)
{
  constexpr int n_modes = 34;
  const mesh::Mesh mesh = make_mesh(kind, ratio, element.order, n_r);
  const BendingModes modes = bending_modes(mesh, element.formulation, section(ratio), n_modes);
  fmt::print(
      "{{\"ratio\": {:g}, \"mesh\": \"{}\", \"element\": \"{}\", \"n_r\": {}, \"triangles\": "
      "{:.3f}, \"n_dofs\": {}, \"assembly_s\": {:.4f}, \"modes_s\": {:.4f}, \"n\": [{}], "
      "\"f_Hz\": [{:.12g}]}}\n",
      ratio, kind, element.name, n_r, share_of_triangles(mesh), modes.n_dofs, modes.assembly_s,
      modes.modes_s, fmt::join(modes.n_diameters, ", "),
      fmt::join(modes.f_Hz.data(), modes.f_Hz.data() + modes.f_Hz.size(), ", "));
  std::fflush(stdout);
}

void sweep(bool smallest)
{
  for (const double ratio : {8.1, 100.0, 1000.0, 10000.0}) {
    for (const char* kind : {"structured", "unstructured"}) {
      for (const Element& element : elements) {
        // Intervals of nodes across the plate; more of them where the report looks for a limit.
        for (const int intervals : {6, 9, 12, 15, 18, 24, 30, 36, 48, 60}) {
          const bool fine = intervals > 36 && (ratio > 8.1 || element.order == 3);
          if (smallest && intervals > 18) continue;
          if (fine || intervals % element.order != 0) continue;
          run(ratio, kind, element, intervals / element.order);
        }
      }
    }
  }
}

}  // namespace
}  // namespace chladni::benchmarks

int main(int argc, char** argv)
{
  if (SlepcInitialize(&argc, &argv, nullptr, nullptr) != 0) return 1;
  int code = 0;
  try {
    chladni::benchmarks::sweep(argc > 1 && std::string_view(argv[1]) == "--smallest");
  } catch (const std::exception& e) {
    fmt::print(stderr, "element_convergence: {}\n", e.what());
    code = 1;
  }
  SlepcFinalize();
  return code;
}
