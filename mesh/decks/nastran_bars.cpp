// Sections of bars by their shapes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/decks/nastran.hpp"

namespace chladni::mesh {
namespace {

using std::numbers::pi;

/// A dimension that must be a length.
double dimension(const Card& card, std::size_t i)
{
  const double value = card.real(8 + i, fmt::format("DIM{}", i));
  if (!(value > 0.0)) card.refuse(fmt::format("DIM{} is no length", i));
  return value;
}

DeclaredBeam circle(double outer, double inner, double shear_factor)
{
  const double I = 0.25 * pi * (std::pow(outer, 4) - std::pow(inner, 4));
  return {.area = pi * (outer * outer - inner * inner),
          .I_y = I,
          .I_z = I,
          .J = 2.0 * I,
          .shear_factor_y = shear_factor,
          .shear_factor_z = shear_factor};
}

/// @param width   along the element's z axis
/// @param height  along its y axis, which is a scene's z
/// Source of J: Young and Budynas, Roark's Formulas for Stress and Strain, 7th ed., table 10.1.
DeclaredBeam rectangle(double width, double height)
{
  const double a = 0.5 * std::max(width, height), b = 0.5 * std::min(width, height);
  const double slimness = b / a;
  const double J =
      a * std::pow(b, 3) * (16.0 / 3.0 - 3.36 * slimness * (1.0 - std::pow(slimness, 4) / 12.0));
  return {.area = width * height,
          .I_y = width * std::pow(height, 3) / 12.0,
          .I_z = height * std::pow(width, 3) / 12.0,
          .J = J,
          .shear_factor_y = 5.0 / 6.0,
          .shear_factor_z = 5.0 / 6.0};
}

}  // namespace

DeclaredBeam bar_of_shape(const Card& card)
{
  card.expect_blank(5, 8, "this field of PBARL is blank");
  const std::string shape(card.field(4));
  const std::size_t n = shape == "ROD" ? 1 : 2;
  if (shape != "ROD" && shape != "TUBE" && shape != "BAR") {
    card.refuse(
        fmt::format("the shape \"{}\" is not known; there are ROD, TUBE and BAR, for others "
                    "take PBAR",
                    shape));
  }
  if (card.real_or(9 + n, "NSM", 0.0) != 0.0)
    card.refuse("mass that is not of the material (NSM) has no counterpart in a scene");
  card.expect_no_more_than(9 + n);
  if (shape == "ROD") return circle(dimension(card, 1), 0.0, 0.9);
  if (shape == "BAR") return rectangle(dimension(card, 1), dimension(card, 2));
  const double inner = card.real(10, "DIM2"), outer = dimension(card, 1);
  if (!(inner >= 0.0 && inner < outer)) card.refuse("DIM2, the inner radius, is not below DIM1");
  return circle(outer, inner, 0.5);
}

}  // namespace chladni::mesh
