#include "sound/air_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "common/error.hpp"

namespace chladni::sound {

using std::numbers::pi;

namespace {

/// Wavelengths per element: 24 nodes per wavelength at order 6 leave 1e-5 of the field, 14 at order
/// 2 about 1e-2.
double elements_per_wavelength(int order)
{
  return order == 2 ? 7.0 : 24.0 / order;
}

void check_size(const AirMeshOptions& mesh, double wavelength)
{
  const double nodes = mesh.order * wavelength / mesh.element_size;
  if (nodes >= least_nodes_per_wavelength * (1.0 - 1e-9)) return;
  throw Error(fmt::format(
      "sound: elements of order {} and {:.4g} m have {:.2g} nodes per wavelength ({:.4g} m), which "
      "is too coarse; take element_size = {:.3g} m or less, or leave it out",
      mesh.order, mesh.element_size, nodes, wavelength,
      mesh.order * wavelength / least_nodes_per_wavelength));
}

/// Measured: an eighth of the wavelength keeps the reflection below 1e-3; where that is much larger
/// than the body, its near field decays within twice the radius.
void check_layer(const AirMeshOptions& mesh, double wavelength)
{
  const double least = std::min(wavelength / 8.0, 2.0 * mesh.inner_radius);
  if (mesh.shell_thickness >= least * (1.0 - 1e-9)) return;
  throw Error(
      fmt::format("sound: an absorbing layer of {:.4g} m reflects the waves of {:.4g} m; "
                  "take layer_thickness = {:.3g} m or more, or leave it out",
                  mesh.shell_thickness, wavelength, least * 1.005));
}

void check_inner_radius(const AirMeshOptions& mesh, const Ball& body)
{
  if (mesh.inner_radius > 1.001 * body.radius) return;
  throw Error(
      fmt::format("sound: the absorbing layer begins at inner_radius = {:.6g} m, but the body "
                  "reaches {:.6g} m; take {:.3g} m or more, or leave it out",
                  mesh.inner_radius, body.radius, 1.1 * body.radius));
}

bool is_meridian(const Outline& outline, Method method)
{
  if (method == Method::automatic) return outline.axisymmetric();
  if (method == Method::fourier && !outline.axisymmetric()) {
    throw Error(
        "sound: method = \"fourier\" needs an axisymmetric outline, but this one has holes; take "
        "\"tetrahedra\" or \"auto\"");
  }
  return method == Method::fourier;
}

}  // namespace

AirPlan plan_air(const Outline& outline, const AirOptions& options, double omega, bool half_space)
{
  const double wavelength = 2.0 * pi * options.medium.speed_of_sound / omega;
  const Ball body = enclosing_ball(outline);
  const bool meridian = is_meridian(outline, options.method);
  const int order = options.order.value_or(meridian ? 6 : 2);
  const double size = options.element_size.value_or(
      std::min(wavelength / elements_per_wavelength(order), 0.4 * body.radius));
  // The pressure has singular gradients at edges; in the plane a fine mesh there costs nothing. In
  // space they make most of the error: a fortieth of the body's radius leaves 1e-2 of the field.
  const double edge = meridian ? 1e-3 * smallest_length(outline)
                               : std::min(0.4 * smallest_length(outline), body.radius / 40.0);
  AirPlan plan{.meridian = meridian,
               .mesh = {.order = order,
                        .element_size = size,
                        .edge_size = std::min(size, options.edge_size.value_or(edge)),
                        .inner_radius = options.inner_radius.value_or(
                            std::max(1.3 * body.radius, body.radius + 0.1 * wavelength)),
                        .shell_thickness = 0.0,
                        .half_space = half_space},
               .layer = {}};
  if (!options.inner_radius)
    plan.mesh.inner_radius = std::min(plan.mesh.inner_radius, 1.5 * body.radius);
  const double shell = std::min(0.5 * wavelength, 3.0 * plan.mesh.inner_radius);
  plan.mesh.shell_thickness = options.layer_thickness.value_or(shell);
  // A thin layer, or coarse elements in it, cannot carry a steep decay.
  const bool gentle = order < 4 || plan.mesh.shell_thickness < 0.25 * wavelength;
  plan.layer.alpha = options.layer_strength.value_or(gentle ? 5.0 : 10.0);
  check_inner_radius(plan.mesh, body);
  check_size(plan.mesh, wavelength);
  check_layer(plan.mesh, wavelength);
  return plan;
}

AirPlan coarsened(AirPlan plan)
{
  // In space the error falls with the size at edges to the power of about 1.2, that of smooth
  // fields with the third power of the size: each factor takes the error to two or three times
  // itself.
  constexpr double of_edges = 2.5, of_size = 1.5;
  plan.mesh.element_size *= of_size;
  plan.mesh.edge_size = std::min(plan.mesh.element_size, of_edges * plan.mesh.edge_size);
  return plan;
}

AirMesh air_around(const Outline& outline, const AirPlan& plan)
{
  return plan.meridian ? mesh_meridian(outline, plan.mesh) : mesh_space(outline, plan.mesh);
}

}  // namespace chladni::sound
