#include "squeal/results/sensitivity_results.hpp"

#include <fmt/format.h>

#include "mbs_export/files/body_files.hpp"

namespace chladni::squeal {

using Eigen::Index;
using files::Reader, files::Writer;
using mbs_export::file_parts::read_count;

namespace {

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

namespace {}  // namespace

void write_gradients(files::Writer& file, const Gradients& gradients)
{
  write_if(file, "gradients/critical_speed", gradients.critical_speed, "rad/s");
  write_if(file, "gradients/critical_frequency", gradients.critical_frequency_Hz, "Hz");
  write_if(file, "gradients/speed", gradients.speed, "rad/s");
  const auto n = std::ssize(gradients.rows), m = std::ssize(gradients.motions);
  std::vector<std::string> keys, units;
  Eigen::VectorXd values(n), critical(n), growth(m), f_Hz(m);
  Eigen::MatrixXd by_value(n, m);
  for (Index i = 0; i < n; ++i) {
    const GradientRow& row = gradients.rows[static_cast<std::size_t>(i)];
    keys.push_back(row.key);
    units.push_back(row.unit);
    values[i] = row.value;
    critical[i] = row.critical_speed.value_or(0.0);
    by_value.row(i) = row.growth;
  }
  for (Index j = 0; j < m; ++j) {
    growth[j] = gradients.motions[static_cast<std::size_t>(j)].growth;
    f_Hz[j] = gradients.motions[static_cast<std::size_t>(j)].frequency_Hz;
  }
  file.write("gradients/keys", keys);
  file.write("gradients/units", units);
  file.write("gradients/values", values, "that of each row");
  if (gradients.critical_speed)
    file.write("gradients/critical_speed_by_value", critical, "rad/s over that of each row");
  if (m == 0) return;
  file.write("gradients/growth", growth, "1/s");
  file.write("gradients/frequency", f_Hz, "Hz");
  file.write("gradients/growth_by_value", by_value, "1/s over that of each row");
}

Gradients read_gradients(const files::Reader& file)
{
  Gradients gradients{.critical_speed = read_if(file, "gradients/critical_speed"),
                      .critical_frequency_Hz = read_if(file, "gradients/critical_frequency"),
                      .speed = read_if(file, "gradients/speed"),
                      .motions = {},
                      .rows = {}};
  const std::vector<std::string> keys = file.texts("gradients/keys"),
                                 units = file.texts("gradients/units");
  const auto n = std::ssize(keys);
  if (std::ssize(units) != n) file.fail("gradients/units", "are not as many as the keys");
  const Eigen::VectorXd values = file.vector("gradients/values", n);
  Eigen::VectorXd critical, growth, f_Hz;
  Eigen::MatrixXd by_value(n, 0);
  if (gradients.critical_speed) critical = file.vector("gradients/critical_speed_by_value", n);
  if (file.contains("gradients/growth")) {
    growth = file.vector("gradients/growth");
    f_Hz = file.vector("gradients/frequency", growth.size());
    by_value = file.matrix("gradients/growth_by_value", {n, growth.size()});
  }
  for (Index j = 0; j < growth.size(); ++j) gradients.motions.push_back({growth[j], f_Hz[j]});
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    gradients.rows.push_back(
        {.key = keys[at],
         .unit = units[at],
         .value = values[i],
         .critical_speed = critical.size() > 0 ? std::optional(critical[i]) : std::nullopt,
         .growth = by_value.row(i)});
  }
  return gradients;
}

}  // namespace chladni::squeal
