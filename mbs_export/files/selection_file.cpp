#include "mbs_export/files/selection_file.hpp"

#include <limits>
#include <string>
#include <vector>

#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::VectorXd;

void write_steps(files::Writer& file, const std::string& group,
                 const std::vector<SelectionStep>& steps)
{
  std::vector<std::string> added;
  std::vector<int> n_modes, n_interface;
  VectorXd error(Index(steps.size()));
  for (const SelectionStep& step : steps) {
    error[Index(added.size())] = step.error;
    added.push_back(step.added);
    n_modes.push_back(step.n_modes);
    n_interface.push_back(step.n_interface);
  }
  file.write(group + "added", added);
  file.write(group + "modes", std::span<const int>(n_modes), "1");
  file.write(group + "interface_modes", std::span<const int>(n_interface), "1");
  file.write(group + "error", error, "1");
}

std::vector<SelectionStep> read_steps(const files::Reader& file, const std::string& group)
{
  const std::vector<std::string> added = file.texts(group + "added");
  const Index n = Index(added.size());
  constexpr Index limit = std::numeric_limits<int>::max();
  const std::vector<int> n_modes = file_parts::read_indices(file, group + "modes", limit, n);
  const std::vector<int> n_interface =
      file_parts::read_indices(file, group + "interface_modes", limit, n);
  const VectorXd error = file.vector(group + "error", n);
  std::vector<SelectionStep> steps;
  for (std::size_t i = 0; i < added.size(); ++i)
    steps.push_back({added[i], n_modes[i], n_interface[i], error[Index(i)]});
  return steps;
}

}  // namespace

void write_selection(files::Writer& file, const SelectionTable& table)
{
  file.write("selection/tolerance", table.error, "1");
  if (table.of_reduction) file.write("selection/error_of_reduction", *table.of_reduction, "1");
  file.write("selection/highest_frequency", table.Omega_max, "rad/s");
  file.write("selection/loads", table.loads);
  write_steps(file, "selection/modes_only/", table.modes_only);
  write_steps(file, "selection/with_interface_modes/", table.with_interface_modes);
}

std::optional<SelectionTable> read_selection(const files::Reader& file)
{
  if (!file.contains("selection")) return std::nullopt;
  std::optional<double> of_reduction;
  if (file.contains("selection/error_of_reduction"))
    of_reduction = file.real("selection/error_of_reduction");
  return SelectionTable{
      .error = file.real("selection/tolerance"),
      .of_reduction = of_reduction,
      .Omega_max = file.real("selection/highest_frequency"),
      .loads = file.texts("selection/loads"),
      .modes_only = read_steps(file, "selection/modes_only/"),
      .with_interface_modes = read_steps(file, "selection/with_interface_modes/")};
}

}  // namespace chladni::mbs_export
