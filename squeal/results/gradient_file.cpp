#include "squeal/results/gradient_file.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index;

void write_if(files::Writer& file, const std::string& name, const std::optional<double>& x,
              const std::string& unit)
{
  if (x) file.write(name, *x, unit);
}

std::optional<double> read_if(const files::Reader& file, const std::string& name)
{
  return file.contains(name) ? std::optional(file.real(name)) : std::nullopt;
}

}  // namespace

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
