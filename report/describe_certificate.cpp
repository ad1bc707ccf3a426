#include "report/describe_certificate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "report/output.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr Index most_lines = 20;

void add_count(TextTable& table, const char* what, const mbs_export::ModeCount& count)
{
  if (count.up_to == 0.0) return;
  table.rows.push_back(
      {fmt::format("{} below {:.6g} Hz", what, count.up_to / two_pi),
       fmt::format("{} expected, {} found, {} missing{}", count.expected, count.found,
                   count.missing(), count.missing() > 0 ? ": take more modes" : "")});
}

/// Where rounding may change a frequency by more than what the basis lacks, by how much at most.
std::optional<double> limit_by_rounding(const mbs_export::Certificate& certificate)
{
  constexpr double noticeable = 1e-6;
  double limit = 0.0;
  for (Index i = 0; i < certificate.rounding.size(); ++i) {
    const double of_frequency = 0.5 * certificate.rounding[i];
    if (of_frequency > certificate.estimates[i]) limit = std::max(limit, of_frequency);
  }
  return limit > noticeable ? std::optional(limit) : std::nullopt;
}

std::string completeness_unchecked(const mbs_export::Certificate& certificate)
{
  const std::string share = certificate.count_share > 0.0
                                ? fmt::format(", for about {:.0f} % of the reduction's time",
                                              100.0 * certificate.count_share)
                                : std::string();
  return fmt::format("not checked: [reduce] sylvester = true counts the modes{}", share);
}

TextTable quality_table(const mbs_export::Certificate& certificate)
{
  TextTable table{.header = {"certificate", "value"}, .rows = {}};
  table.rows.push_back({"support", certificate.fixed.empty()
                                       ? std::string("none")
                                       : fmt::format("{}", fmt::join(certificate.fixed, ", "))});
  table.rows.push_back(
      {"largest estimated error of a frequency",
       fmt::format("{:.2e}", mbs_export::estimated_errors(certificate).maxCoeff())});
  if (certificate.mesh_errors.size() > 0) {
    table.rows.push_back({"largest estimated error of one by the mesh",
                          fmt::format("{:.2e}", certificate.mesh_errors.maxCoeff())});
  }
  if (const auto limit = limit_by_rounding(certificate))
    table.rows.push_back({"limited by rounding to about", fmt::format("{:.0e}", *limit)});
  table.rows.push_back(
      {"zero-energy modes of the free body", fmt::format("{}", certificate.n_rigid)});
  if (certificate.n_rigid > 0) {
    table.rows.push_back({"their energy over the first elastic omega^2",
                          fmt::format("{:.1e}", certificate.rigid_residual)});
  }
  if (certificate.condition > 0.0)
    table.rows.push_back({"condition of K_ss", fmt::format("{:.1e}", certificate.condition)});
  if (const auto& responses = certificate.responses) {
    table.rows.push_back({fmt::format("bound of the error of responses at {} up to {:.0f} Hz",
                                      fmt::join(responses->loads, ", "), responses->up_to / two_pi),
                          fmt::format("{:.1e}", responses->error)});
  }
  add_count(table, "fixed-interface modes", certificate.fixed_interface);
  add_count(table, "modes", certificate.range);
  if (certificate.complete.up_to != certificate.range.up_to)
    add_count(table, "modes", certificate.complete);
  if (certificate.range.up_to == 0.0)
    table.rows.push_back({"completeness", completeness_unchecked(certificate)});
  return table;
}

TextTable mode_table(const mbs_export::Certificate& certificate)
{
  TextTable table{.header = {"mode", "frequency, Hz", "estimated error"}, .rows = {}};
  const bool has_bounds = certificate.bounds.size() > 0;
  if (has_bounds) table.header.emplace_back("bound");
  const Eigen::VectorXd& of_mesh = certificate.mesh_errors;
  if (of_mesh.size() > 0) table.header.emplace_back("error of the mesh");
  const Eigen::VectorXd errors = mbs_export::estimated_errors(certificate);
  for (Index i = 0; i < std::min(most_lines, errors.size()); ++i) {
    table.rows.push_back({fmt::format("{}", i + 1),
                          fmt::format("{:.4f}", certificate.frequencies[i] / two_pi),
                          fmt::format("{:.2e}", errors[i])});
    if (has_bounds) {
      table.rows.back().push_back(
          i < certificate.bounds.size() ? fmt::format("{:.2e}", 0.5 * certificate.bounds[i]) : "");
    }
    if (of_mesh.size() > 0)
      table.rows.back().push_back(i < of_mesh.size() ? fmt::format("{:.2e}", of_mesh[i]) : "");
  }
  return table;
}

}  // namespace

std::string describe_certificate(const mbs_export::Certificate& certificate)
{
  const Index n = certificate.eta2.size();
  if (n == 0) return "";
  return fmt::format(
      "{}\n{}{}", format_table(quality_table(certificate)), format_table(mode_table(certificate)),
      n > most_lines ? fmt::format("... {} more in the file\n", n - most_lines) : std::string());
}

}  // namespace chladni::report
