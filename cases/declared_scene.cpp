#include "cases/declared_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace chladni::cases {
namespace {

constexpr std::array component_names{"x", "y", "z", "rx", "ry", "rz"};

/// A TOML string; quotes and control characters cannot end it.
std::string quoted(const std::string& text)
{
  std::string written = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      written += fmt::format("\\{}", c);
    else if (code < 0x20 || code == 0x7F)
      written += fmt::format("\\u{:04x}", code);
    else
      written += c;
  }
  return written + "\"";
}

/// The shortest digits that are the number again, as TOML wants them.
std::string number(double x)
{
  const std::string digits = fmt::format("{}", x);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

std::string material(const mesh::DeclaredMaterial& material)
{
  return fmt::format("\n[material.{}]\nyoung = {}\npoisson = {}\ndensity = {}\n",
                     quoted(material.name), number(material.young), number(material.poisson),
                     number(material.density));
}

std::string list(const auto& numbers)
{
  std::string text;
  for (const double x : numbers) text += (text.empty() ? "" : ", ") + number(x);
  return "[" + text + "]";
}

std::string thickness(const mesh::DeclaredShell& shell)
{
  if (!shell.table) return number(shell.thickness);
  if (shell.table->at.size() == 1) return number(shell.table->values.front());
  return fmt::format("{{ over = \"{}\", at = {}, values = {} }}", shell.table->over,
                     list(shell.table->at), list(shell.table->values));
}

std::string shell(const mesh::DeclaredShell& shell)
{
  std::string text =
      fmt::format("\n[[section]]\ngroup = {}\ntype = \"shell\"\nmaterial = {}\nthickness = {}\n",
                  quoted(shell.group), quoted(shell.material), thickness(shell));
  if (shell.offset != 0.0) text += fmt::format("offset = {}\n", number(shell.offset));
  return text;
}

std::string beam(const mesh::DeclaredBeam& beam)
{
  std::string text = fmt::format(
      "\n[[section]]\ngroup = {}\ntype = \"beam\"\nmaterial = {}\narea = {}\nI_y = {}\nI_z = {}\n"
      "J = {}\n",
      quoted(beam.group), quoted(beam.material), number(beam.area), number(beam.I_y),
      number(beam.I_z), number(beam.J));
  if (beam.shear_factor_y && beam.shear_factor_z) {
    text += fmt::format("shear_factor_y = {}\nshear_factor_z = {}\n", number(*beam.shear_factor_y),
                        number(*beam.shear_factor_z));
  } else {
    text += "theory = \"bernoulli-euler\"\n";
  }
  if (beam.orientation) {
    const auto& v = *beam.orientation;
    text += fmt::format("orientation = [{}, {}, {}]\n", number(v[0]), number(v[1]), number(v[2]));
  }
  return text;
}

std::string solid(const mesh::DeclaredSolid& solid)
{
  return fmt::format("\n[[section]]\ngroup = {}\ntype = \"solid\"\nmaterial = {}\n",
                     quoted(solid.group), quoted(solid.material));
}

std::string support(const mesh::DeclaredSupport& support)
{
  std::string dofs;
  for (const int component : support.components) {
    dofs +=
        fmt::format("{}\"{}\"", dofs.empty() ? "" : ", ", component_names[std::size_t(component)]);
  }
  return fmt::format("\n[[support]]\ngroup = {}\ndofs = [{}]\n", quoted(support.group), dofs);
}

template <std::size_t n>
bool is_zero(const std::array<double, n>& numbers)
{
  return std::ranges::all_of(numbers, [](double x) { return x == 0.0; });
}

std::string coupling(const mesh::DeclaredCoupling& coupling)
{
  const bool averages = coupling.kind == mesh::CouplingOfDeck::averaging;
  std::string text =
      fmt::format("\n[[coupling]]\ntype = \"{}\"\n", averages ? "averaging" : "rigid");
  if (!coupling.name.empty()) text += fmt::format("name = {}\n", quoted(coupling.name));
  text += fmt::format("group = {}\n", quoted(coupling.group));
  if (!coupling.to.empty()) text += fmt::format("to = {}\n", quoted(coupling.to));
  if (coupling.at) text += fmt::format("at = {}\n", list(*coupling.at));
  return text;
}

std::string mass(const mesh::DeclaredMass& mass)
{
  std::string text =
      fmt::format("\n[[mass]]\nat = {}\nmass = {}\n", quoted(mass.at), number(mass.mass));
  if (!is_zero(mass.inertia)) text += fmt::format("inertia = {}\n", list(mass.inertia));
  if (!is_zero(mass.offset)) text += fmt::format("offset = {}\n", list(mass.offset));
  return text;
}

std::string spring(const mesh::DeclaredSpring& spring)
{
  std::string text = fmt::format("\n[[spring]]\nat = {}\n", quoted(spring.at));
  if (spring.to) text += fmt::format("to = {}\n", quoted(*spring.to));
  std::string stiffness;
  for (std::size_t c = 0; c < 6; ++c) {
    if (spring.stiffness[c] != 0.0) {
      stiffness += fmt::format("{}{} = {}", stiffness.empty() ? "" : ", ", component_names[c],
                               number(spring.stiffness[c]));
    }
  }
  return text + fmt::format("stiffness = {{ {} }}\n", stiffness);
}

std::string each(const auto& declared, auto&& written)
{
  std::string text;
  for (const auto& one : declared) text += written(one);
  return text;
}

}  // namespace

std::string declared_scene(const mesh::Declarations& declared, const DeckScene& scene)
{
  std::string text =
      "# What the deck says besides its mesh; interface and reduction are yours to add.\n";
  for (const std::string& note : declared.notes) text += "# " + note + "\n";
  text += fmt::format("name = {}\n\n[mesh]\nfile = {}\nlength_unit = {}\n", quoted(scene.name),
                      quoted(scene.file), quoted(scene.length_unit));
  text += each(declared.materials, material) + each(declared.shells, shell) +
          each(declared.beams, beam) + each(declared.solids, solid) +
          each(declared.couplings, coupling) + each(declared.supports, support) +
          each(declared.masses, mass) + each(declared.springs, spring);
  return text + "\n[modes]\ncount = 10\n";
}

}  // namespace chladni::cases
