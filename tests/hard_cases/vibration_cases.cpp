// Natural frequencies of whole models whose difficulty is in the model: drilling rotations, edge
// layers, joints of mid-surfaces, reference nodes without mass.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "hard_case.hpp"
#include "mesh/generators.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/free_motions.hpp"
#include "reduce/supported_solutions.hpp"
#include "tests/mbs_export/bending_beam.hpp"

namespace chladni::hard_cases {
namespace {

using plate::Coupling, plate::CouplingKind, plate::ShellSection, plate::Support;

const plate::Material iron{.young = 9.15915e10, .poisson = 0.3, .density = 6300.0};
std::vector<Support> clamped(const std::string& group)
{
  return {{.group = group, .components = {0, 1, 2, 3, 4, 5}}};
}

/// The disc of 50 / 324 / 20 mm.
mesh::AnnulusOptions disc(double element_size)
{
  return {.inner_radius = 0.025, .outer_radius = 0.162, .element_size = element_size, .rings = {}};
}

ShellSection section(const std::string& group, double thickness)
{
  return {.group = group, .material = iron, .thickness = thickness};
}

/// The lowest `n` natural frequencies, Hz, rigid-body motions first.
std::vector<double> frequencies(const mesh::Mesh& mesh, const std::vector<ShellSection>& sections,
                                const std::vector<Coupling>& couplings,
                                const std::vector<Support>& supports, int n)
{
  const plate::DofMap dofs =
      plate::make_dof_map(mesh, {.couplings = couplings}, mesh::node_owners(mesh, 1), 1);
  const std::vector<int> held = plate::held_dofs(mesh, dofs, supports);
  const int n_rigid = plate::n_free_motions(plate::free_parts(mesh, dofs, held));
  const plate::System system = plate::assemble(mesh, sections, dofs, PETSC_COMM_SELF);
  const reduce::NaturalModes modes = reduce::natural_modes(
      system.K, system.M, reduce::free_dofs(system.K, held), {.n_modes = n, .n_rigid = n_rigid});
  std::vector<double> f_Hz;
  for (const double lambda : modes.lambda)
    f_Hz.push_back(std::sqrt(std::max(lambda, 0.0)) / (2.0 * std::numbers::pi));
  return f_Hz;
}

/// Of the frequency that is nearest to the exact one.
double error_of_nearest(const std::vector<double>& f_Hz, double exact_Hz)
{
  double least = 1.0;
  for (const double f : f_Hz) least = std::min(least, relative_error(f, exact_Hz));
  return least;
}

double clamped_disc_error(const mesh::AnnulusOptions& options, const ShellSection& of,
                          double exact_Hz, int n)
{
  return error_of_nearest(frequencies(mesh::annulus(options), {of}, {}, clamped("inner_edge"), n),
                          exact_Hz);
}

/// A disc of the same bending stiffness and mass per area with another ratio r_a / h.
double thinner_disc_error(double ratio, mesh::AnnulusOptions options, double exact_Hz)
{
  const double h = 0.162 / ratio;
  ShellSection thin = section("disc", h);
  thin.material.young *= std::pow(0.02 / h, 3);
  thin.material.density *= 0.02 / h;
  return clamped_disc_error(options, thin, exact_Hz, 12);
}

/// How many rigid motions are missed or invented of a free plate whose nodes have z, rx and ry.
double miscounted_plane_motions()
{
  const mesh::Mesh mesh = mesh::annulus(disc(0.03));
  const plate::DofMap dofs =
      plate::make_dof_map(mesh, {.components = {2, 3, 4}}, mesh::node_owners(mesh, 1), 1);
  return std::abs(plate::n_free_motions(plate::free_parts(mesh, dofs, {})) - 3.0);
}

/// Largest error of the lowest frequencies of each kind in the plane of the clamped disc: torsion,
/// n = 1, 2, 3 and radial.
double error_in_the_plane()
{
  const auto f = frequencies(mesh::annulus(disc(0.015)), {section("disc", 0.02)}, {},
                             {{.group = "disc", .components = {2, 3, 4}},
                              {.group = "inner_edge", .components = {0, 1, 5}}},
                             10);
  const std::vector<double> exact{1045.85339702, 3315.46219397, 3315.46219397, 5814.00453578,
                                  5814.00453578};
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    worst = std::max(worst, relative_error(f[i], exact[i]));
  return worst;
}

/// How many bending modes of the free disc below 16 kHz are missing or too many. An independent
/// program with other elements counts 52, the three rigid ones among them.
double wrong_bending_modes_of_the_free_disc()
{
  const auto f = frequencies(mesh::annulus(disc(0.015)), {section("disc", 0.02)}, {},
                             {{.group = "disc", .components = {0, 1, 5}}}, 57);
  return std::abs(double(std::ranges::count_if(f, [](double x) { return x < 16000.0; })) - 52.0);
}

/// With a rigid hub that nothing holds and that has no mass.
double free_hub_error()
{
  const auto f = frequencies(mesh::annulus(disc(0.015)), {section("disc", 0.02)},
                             {{.name = "hub", .group = "inner_edge"}}, {}, 14);
  return std::max(error_of_nearest(f, 1364.56071061), error_of_nearest(f, 2746.15535765));
}

/// Largest error with no, two, three and four nodal diameters against elasticity in space.
double bell_error()
{
  const auto f = frequencies(
      mesh::hat_disc({.inner_radius = 0.066,
                      .outer_radius = 0.162,
                      .wall_radius = 0.070,
                      .top_radius = 0.070,
                      .hub_radius = 0.035,
                      .height = 0.046,
                      .foot = 0.010,
                      .element_size = 0.02,
                      .rings = {}}),
      {section("disc", 0.02), section("wall", 0.008), section("flange", 0.008)},
      {{.name = {}, .group = "wall_foot", .kind = CouplingKind::link, .to = "wall_seat"}},
      clamped("hub_edge"), 13);
  double worst = 0.0;
  for (const double exact : {615.4141, 931.2335, 1749.8337, 2886.8318})
    worst = std::max(worst, error_of_nearest(f, exact));
  return worst;
}

petsc::Matrix matrix(const Eigen::MatrixXd& A)
{
  petsc::Matrix result;
  const auto n = static_cast<PetscInt>(A.rows());
  petsc::check(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 6, nullptr, result.put()));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j)
      if (A(i, j) != 0.0) petsc::check(MatSetValue(result, i, j, A(i, j), INSERT_VALUES));
  petsc::check(MatAssemblyBegin(result, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(result, MAT_FINAL_ASSEMBLY));
  return result;
}

/// Of the first elastic frequency of the beam of the method's example, L = EI = rho A = 1.
double error_of_a_long_beam(const std::vector<int>& held, int n_rigid, double exact)
{
  const auto beam = mbs_export::test::bending_beam(300);
  const petsc::Matrix K = matrix(beam.K), M = matrix(beam.M);
  const auto modes = reduce::natural_modes(K, M, reduce::free_dofs(K, held),
                                           {.n_modes = n_rigid + 3, .n_rigid = n_rigid});
  return relative_error(std::sqrt(modes.lambda[n_rigid]), exact);
}

/// Case FV4 of NAFEMS (R0015): a cantilever rod with 10 t and 1 t on arms of 2 m. Its frequencies
/// are published to a thousandth of a hertz.
double error_with_masses_off_the_centre()
{
  constexpr double d = 0.5, I = std::numbers::pi * d * d * d * d / 64.0;
  const mesh::Mesh mesh =
      mesh::beam({.start = {0.0, 0.0, 0.0}, .end = {10.0, 0.0, 0.0}, .elements = 20});
  const plate::DofMap dofs = plate::make_dof_map(mesh, {}, mesh::node_owners(mesh, 1), 1);
  const std::vector<int> held = plate::held_dofs(mesh, dofs, clamped("start"));
  const std::vector<plate::BeamSection> rod{
      {.group = "beam",
       .material = {.young = 2e11, .poisson = 0.3, .density = 8000.0},
       .theory = plate::BeamTheory::bernoulli_euler,
       .area = std::numbers::pi * d * d / 4.0,
       .I_y = I,
       .I_z = I,
       .J = 2.0 * I}};
  const std::vector<plate::PointMass> masses{
      {.at = "end", .mass = 1e4, .offset = {0.0, 2.0, 0.0}},
      {.at = "end", .mass = 1e3, .offset = {0.0, -2.0, 0.0}}};
  const plate::System system = plate::assemble(
      mesh, plate::Structure{.beams = rod, .masses = masses}, dofs, PETSC_COMM_SELF);
  const auto modes =
      reduce::natural_modes(system.K, system.M, reduce::free_dofs(system.K, held), {.n_modes = 6});
  const std::vector<double> published_Hz{1.723, 1.727, 7.413, 9.972, 18.155, 26.957};
  double worst = 0.0;
  for (std::size_t i = 0; i < published_Hz.size(); ++i) {
    worst = std::max(worst, relative_error(std::sqrt(modes.lambda[i]) / (2.0 * std::numbers::pi),
                                           published_Hz[i]));
  }
  return worst;
}

}  // namespace

std::vector<HardCase> vibration_cases()
{
  const std::string frequency = "relative error of the frequency";
  const std::string frequencies = "relative error of the frequencies";
  return {
      {"elements", "bending modes of a free disc below 16 kHz",
       "reduced integration and free drilling leave modes that do not exist",
       "modes that are missing or too many", 0.0, wrong_bending_modes_of_the_free_disc},
      {"elements", "disc in its plane, clamped inside",
       "the drilling rotation is held where the plane turns: 1 % with a stiff tie of the two",
       frequencies, 1e-4, error_in_the_plane},
      {"elements", "eight nodal diameters, 9.4 kHz",
       "Bessel functions of the exact value leave double precision unless scaled", frequency, 1e-5,
       [] { return clamped_disc_error(disc(0.015), section("disc", 0.02), 9424.859490537, 40); }},
      {"elements", "thick disc, triangles of order 2",
       "tied shear alone is softer than a thick plate by 3e-4", frequency, 1e-4,
       [] {
         mesh::AnnulusOptions options = disc(0.01);
         options.element_order = 2;
         options.pattern = mesh::Pattern::triangles;
         return clamped_disc_error(options, section("disc", 0.02), 1672.090697922, 10);
       }},
      {"elements", "edge layer of a disc, h/r_a = 1/50, one row of elements as wide as h",
       "a uniform mesh misses the layer by 1e-3", frequency, 3e-5,
       [] {
         mesh::AnnulusOptions options = disc(0.03);
         options.edge_row = 0.162 / 50;
         return thinner_disc_error(50, options, 1744.260759688);
       }},
      {"elements", "h/r_a = 1e-4 on Gmsh's mesh",
       "elements of any shape with curved edges: S8R is off by 8 %", frequency, 1e-4,
       [] { return thinner_disc_error(1e4, disc(0.02), 1749.730718956); }},
      {"elements", "free plate of which each node has z, rx, ry",
       "three rigid motions among six: none is found by its frequency",
       "rigid motions that are missing or too many", 0.0, miscounted_plane_motions},
      {"couplings", "disc about a rigid hub that is free and has no mass", "M is singular",
       frequencies, 1e-5, free_hub_error},
      {"couplings", "wall of a hat that ends below the mid-surface of its ring",
       "mid-surfaces that are simply joined: 13 % too low", frequencies, 0.005, bell_error},
      {"couplings", "cantilever with 10 t and 1 t beside its tip",
       "two frequencies 0.2 % apart, bending coupled to torsion", frequencies, 1e-3,
       error_with_masses_off_the_centre},
      // Elimination by nested dissection leaves 3e-7, from one end to the other 1e-8.
      {"reduction", "slender free beam of 300 elements",
       "cond(K) of 1e10 and more; dense solvers of K x = lambda M x leave 4 digits", frequency,
       1e-6, [] { return error_of_a_long_beam({}, 2, 22.3732854528785649); }},
      {"reduction", "the same, clamped", "the same", frequency, 1e-6,
       [] {
         return error_of_a_long_beam({0, 1}, 0, 3.51601526850387769813);
       }},
  };
}

}  // namespace chladni::hard_cases
