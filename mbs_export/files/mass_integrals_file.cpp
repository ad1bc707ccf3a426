#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export::file_parts {
namespace {

using Eigen::Index;

const std::string group = "mass_integrals/";

std::string product_name(std::size_t i)
{
  const std::string axes = "xyz";
  const auto [k, l] = product_axes[i];
  return group + "displacement_" + axes[static_cast<std::size_t>(k)] +
         axes[static_cast<std::size_t>(l)];
}

}  // namespace

void write_mass_integrals(files::Writer& file, const std::optional<MassIntegrals>& integrals)
{
  if (!integrals) return;
  file.write(group + "mass", integrals->mass, "kg");
  file.write(group + "first_moment", integrals->first, "kg m");
  file.write(group + "second_moment", integrals->second, "kg m^2");
  file.write(group + "displacement", integrals->displacement, "kg m per unit of each coordinate");
  file.write(group + "position_displacement", integrals->position_displacement,
             "kg m^2 per unit of each coordinate");
  for (std::size_t i = 0; i < product_axes.size(); ++i)
    file.write(product_name(i), integrals->products[i], "kg m^2 per units of the two coordinates");
}

std::optional<MassIntegrals> read_mass_integrals(const files::Reader& file, Index n)
{
  if (!file.contains("mass_integrals")) return std::nullopt;
  MassIntegrals integrals{
      .mass = file.real(group + "mass"),
      .first = file.vector(group + "first_moment", 3),
      .second = file.matrix(group + "second_moment", {3, 3}),
      .displacement = file.matrix(group + "displacement", {3, n}),
      .position_displacement = file.matrix(group + "position_displacement", {9, n}),
      .products = {}};
  for (std::size_t i = 0; i < product_axes.size(); ++i)
    integrals.products[i] = file.matrix(product_name(i), {n, n});
  return integrals;
}

}  // namespace chladni::mbs_export::file_parts
