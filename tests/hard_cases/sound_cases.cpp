// Sound where it nearly cancels, nearly stays at the body, or comes from an edge.
#include <cmath>
#include <numbers>

#include "hard_case.hpp"
#include "sound/air_plan.hpp"
#include "sound/field.hpp"
#include "tests/references/sound/exact_fields.hpp"
#include "tests/references/sound/thesis_disc.hpp"

namespace chladni::hard_cases {
namespace {

using namespace sound;
using sound::testing::Multipole;

constexpr double disc_radius = sound::testing::disc_radius;

Outline disc_of_20_mm()
{
  return sound::testing::solid_disc(disc_radius, sound::testing::disc_thickness);
}

Exterior around(const Outline& outline, const AirMeshOptions& options, const Wave& wave,
                const AbsorbingLayer& layer = {})
{
  return Exterior(std::make_shared<const AirMesh>(mesh_meridian(outline, options)), wave, layer);
}

constexpr AirMeshOptions around_disc{.order = 6,
                                     .element_size = 0.05,
                                     .edge_size = 1e-5,
                                     .inner_radius = 0.22,
                                     .shell_thickness = 0.1,
                                     .half_space = true};

Field squealing_disc()
{
  Exterior exterior = around(disc_of_20_mm(), around_disc, sound::testing::squeal_wave());
  return solve(exterior, sound::testing::disc_velocity(exterior.surface(), 1.0));
}

/// Pressure at points where it is zero, over that half a metre before the disc.
double pressure_where_it_cancels()
{
  Eigen::MatrixX3d x(4, 3);
  x << 0.5, 0.0, 0.5, 0.18, 0.0, 0.0, 0.9, 0.3, 0.0, 0.0, 0.0, 0.15;
  const Eigen::VectorXd p = pressure_at(squealing_disc(), x).cwiseAbs();
  return p.tail(3).maxCoeff() / p(0);
}

/// Radiated power at the surface against the far field.
double imbalance_of_power()
{
  const Field field = squealing_disc();
  return relative_error(complex_power(field)(0, 0).real(), far_power(field)[0]);
}

/// Resistance of the rigid, infinitely thin disc at ka = 0.1; spectral solution.
double error_of_a_tiny_resistance()
{
  const double a = 0.1, ka = 0.1, lambda = 2.0 * std::numbers::pi * a / ka;
  const Outline disc{.quadrilaterals = {}, .balls = {}, .holes = {}, .sheet_radius = a};
  const Medium air;
  Exterior exterior = around(disc,
                             {.order = 6,
                              .element_size = 0.05,
                              .edge_size = 1e-6,
                              .inner_radius = 0.15,
                              .shell_thickness = std::min(0.5 * lambda, 0.5),
                              .half_space = true},
                             {air, ka / a * air.speed_of_sound, 0}, {.alpha = 5.0});
  const Field field = solve(exterior, Eigen::MatrixXcd::Ones(exterior.surface().n_points(), 1));
  const double R = 2.0 * complex_power(field)(0, 0).real() /
                   (air.density * air.speed_of_sound * std::numbers::pi * a * a);
  return relative_error(R, 6.023462276590747e-06);
}

/// A multipole whose pole is inside the body.
double error_of_a_multipole(const Outline& outline, const Multipole& exact, double ka)
{
  AirMeshOptions options = around_disc;
  options.element_size = options.edge_size = 0.02;
  options.half_space = false;
  const Medium air;
  Exterior exterior =
      around(outline, options, {air, ka / disc_radius * air.speed_of_sound, exact.n});
  const Field field =
      solve(exterior, sound::testing::normal_velocity(exact, exterior.wave(), exterior.surface()));
  return sound::testing::mean_field_error(exterior.mesh(), field.wave, field.p.col(0), exact);
}

/// An oscillating sphere at ka = 3 in a layer that damps waves by exp(-12) on each way.
double error_within_a_strong_layer()
{
  AirMeshOptions options{.order = 6,
                         .element_size = 0.025,
                         .edge_size = 0.025,
                         .inner_radius = 0.2,
                         .shell_thickness = 0.1,
                         .half_space = false};
  const Multipole exact{1, 0};
  Exterior exterior =
      around(sound::testing::sphere(0.1), options, {Medium{}, 30.0 * 343.0, 0}, {.alpha = 12.0});
  const Field field =
      solve(exterior, sound::testing::normal_velocity(exact, exterior.wave(), exterior.surface()));
  return sound::testing::mean_field_error(exterior.mesh(), field.wave, field.p.col(0), exact);
}

AirOptions air_options(double size)
{
  AirOptions options;
  options.element_size = size;
  return options;
}

}  // namespace

std::vector<HardCase> sound_cases()
{
  const double omega = sound::testing::squeal_wave().omega;
  return {
      {"sound", "squealing disc in its plane and on its axis",
       "the faces of 100 Pa cancel each other", "pressure over that before the disc", 1e-10,
       pressure_where_it_cancels},
      {"sound", "power of the squealing disc, near and far",
       "pressure is singular at the edges of the rim", "relative difference", 1e-6,
       imbalance_of_power},
      {"sound", "rigid disc without thickness at ka = 0.1",
       "it radiates 7e-5 of what it moves to and fro, and the layer is a 25th of the wavelength",
       "relative error of the resistance", 1e-3, error_of_a_tiny_resistance},
      {"sound", "twelve nodal diameters at ka = 2", "the field falls by R^-13: it hardly radiates",
       "relative error of the field, mean square", 1e-4,
       [] {
         return error_of_a_multipole(sound::testing::sphere(disc_radius), {12, 12}, 2.0);
       }},
      {"sound", "field of a pole 20 mm below the face of a drum",
       "steep on the faces, smooth far away", "relative error of the field, mean square", 1e-4,
       [] {
         return error_of_a_multipole(sound::testing::solid_disc(disc_radius, 0.2), {4, 3}, 3.0);
       }},
      {"sound", "absorbing layer of exp(-12)",
       "coordinates turn so far into the complex plane that the Jacobian changes its sign",
       "relative error of the field, mean square", 1e-4, error_within_a_strong_layer},
      {"sound", "elements of two thirds of a wavelength", "would show waves that do not exist",
       "words missing in the refusal", 0.0,
       [omega] {
         AirOptions options = air_options(0.135);
         options.order = 2;
         return words_missing([&] { plan_air(disc_of_20_mm(), options, omega, true); },
                              {"element_size"});
       }},
      {"sound", "absorbing layer of a twentieth of the wavelength", "cannot absorb: reflects",
       "words missing in the refusal", 0.0,
       [omega] {
         AirOptions options;
         options.layer_thickness = 0.01;
         return words_missing([&] { plan_air(disc_of_20_mm(), options, omega, true); },
                              {"layer_thickness"});
       }},
      {"sound", "microphone inside the disc", "the integral over the surface is zero there",
       "words missing in the refusal", 0.0, [] {
         const Field field = squealing_disc();
         return words_missing([&] { pressure_at(field, Eigen::RowVector3d(0.1, 0.0, 0.0)); },
                              {"inside"});
       }}};
}

}  // namespace chladni::hard_cases
