#include "squeal/results/sensitivity_file.hpp"

#include <fmt/format.h>

#include "mbs_export/files/file_parts.hpp"

namespace chladni::squeal {
namespace {

using files::Reader;
using files::Writer;
using mbs_export::file_parts::read_count;

std::string subset_group(std::size_t i)
{
  return fmt::format("mode_sensitivity/subsets/{}/", i + 1);
}

std::string mode_group(std::size_t i)
{
  return fmt::format("mode_sensitivity/modes/{}/", i + 1);
}

void write_if(Writer& file, const std::string& name, const std::optional<double>& x,
              const std::string& unit)
{
  if (x) file.write(name, *x, unit);
}

std::optional<double> read_if(const Reader& file, const std::string& name)
{
  return file.contains(name) ? std::optional(file.real(name)) : std::nullopt;
}

}  // namespace

void write_sensitivity(Writer& file, const ModeSensitivity& sensitivity)
{
  file.write("mode_sensitivity/critical_speed", sensitivity.critical_speed, "rad/s");
  file.write("mode_sensitivity/critical_frequency", sensitivity.critical_frequency_Hz, "Hz");
  for (std::size_t i = 0; i < sensitivity.subsets.size(); ++i) {
    const ModeSubset& subset = sensitivity.subsets[i];
    const std::string group = subset_group(i);
    file.write(group + "n_modes", std::int64_t{subset.n_modes}, "1");
    file.write(group + "highest_frequency", subset.highest_Hz, "Hz");
    file.write(group + "growth", subset.growth, "1/s");
    if (!subset.stability.empty()) file.write(group + "stability", subset.stability);
    write_if(file, group + "critical_speed", subset.critical_speed, "rad/s");
    write_if(file, group + "critical_frequency", subset.critical_frequency_Hz, "Hz");
  }
  for (std::size_t i = 0; i < sensitivity.influences.size(); ++i) {
    const ModeInfluence& mode = sensitivity.influences[i];
    const std::string group = mode_group(i);
    file.write(group + "nodal_diameters", std::int64_t{mode.nodal_diameters}, "1");
    file.write(group + "frequency", mode.frequency_Hz, "Hz");
    file.write(group + "participation", mode.participation, "1");
    write_if(file, group + "growth_without", mode.growth_without, "1/s");
    write_if(file, group + "critical_speed_without", mode.critical_speed_without, "rad/s");
  }
}

ModeSensitivity read_sensitivity(const Reader& file)
{
  ModeSensitivity sensitivity{
      .critical_speed = file.real("mode_sensitivity/critical_speed"),
      .critical_frequency_Hz = file.real("mode_sensitivity/critical_frequency"),
      .subsets = {},
      .influences = {}};
  for (std::size_t i = 0; file.contains(subset_group(i) + "n_modes"); ++i) {
    const std::string group = subset_group(i);
    sensitivity.subsets.push_back(
        {.n_modes = read_count(file, group + "n_modes"),
         .highest_Hz = file.real(group + "highest_frequency"),
         .critical_speed = read_if(file, group + "critical_speed"),
         .critical_frequency_Hz = read_if(file, group + "critical_frequency"),
         .growth = file.real(group + "growth"),
         .stability =
             file.contains(group + "stability") ? file.text(group + "stability") : std::string()});
  }
  for (std::size_t i = 0; file.contains(mode_group(i) + "frequency"); ++i) {
    const std::string group = mode_group(i);
    sensitivity.influences.push_back(
        {.nodal_diameters = read_count(file, group + "nodal_diameters"),
         .frequency_Hz = file.real(group + "frequency"),
         .participation = file.real(group + "participation"),
         .growth_without = read_if(file, group + "growth_without"),
         .critical_speed_without = read_if(file, group + "critical_speed_without")});
  }
  return sensitivity;
}

}  // namespace chladni::squeal
