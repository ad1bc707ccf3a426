#include "cli/describe_certificate.hpp"

#include <fmt/format.h>

#include <numbers>

#include "cli/output.hpp"

namespace chladni::cli {
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

TextTable quality_table(const mbs_export::Certificate& certificate)
{
  TextTable table{.header = {"certificate", "value"}, .rows = {}};
  table.rows.push_back({"support", certificate.fixed.empty()
                                       ? std::string("none")
                                       : fmt::format("{}", fmt::join(certificate.fixed, ", "))});
  table.rows.push_back({"largest eta^2", fmt::format("{:.2e}", certificate.eta2.maxCoeff())});
  table.rows.push_back(
      {"zero-energy modes of the free body", fmt::format("{}", certificate.n_rigid)});
  if (certificate.n_rigid > 0) {
    table.rows.push_back({"their energy over the first elastic omega^2",
                          fmt::format("{:.1e}", certificate.rigid_residual)});
  }
  if (certificate.condition > 0.0) {
    table.rows.push_back({"condition of K_ss", fmt::format("{:.1e}", certificate.condition)});
  }
  add_count(table, "fixed-interface modes", certificate.fixed_interface);
  add_count(table, "modes", certificate.range);
  if (certificate.complete.up_to != certificate.range.up_to) {
    add_count(table, "modes", certificate.complete);
  }
  return table;
}

TextTable mode_table(const mbs_export::Certificate& certificate)
{
  TextTable table{.header = {"mode", "frequency, Hz", "eta^2"}, .rows = {}};
  const bool has_bounds = certificate.bounds.size() > 0;
  if (has_bounds) table.header.emplace_back("bound");
  for (Index i = 0; i < std::min(most_lines, certificate.eta2.size()); ++i) {
    table.rows.push_back({fmt::format("{}", i + 1),
                          fmt::format("{:.4f}", certificate.frequencies[i] / two_pi),
                          fmt::format("{:.2e}", certificate.eta2[i])});
    if (!has_bounds) continue;
    table.rows.back().push_back(
        i < certificate.bounds.size() ? fmt::format("{:.2e}", certificate.bounds[i]) : "");
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

}  // namespace chladni::cli
