#include "cases/describe_reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "report/json.hpp"

namespace chladni::cases {
namespace {

/// "101 (100 asked; 1 more of the same frequency)": what a disc has twice is not parted.
std::string number_of_modes(const ReduceSummary& summary)
{
  const int n_more = summary.n_modes - summary.n_modes_asked;
  if (summary.n_modes_asked == 0 || n_more == 0) return fmt::format("{}", summary.n_modes);
  return fmt::format("{} ({} asked; {} more of the same frequency)", summary.n_modes,
                     summary.n_modes_asked, n_more);
}

/// Of the frequencies: the estimate, or what rounding may do where that is more.
double largest_error(const mbs_export::Certificate& certificate)
{
  const double estimate = mbs_export::estimated_errors(certificate).maxCoeff();
  if (certificate.rounding.size() == 0) return estimate;
  return std::max(estimate, 0.5 * certificate.rounding.maxCoeff());
}

}  // namespace

report::TextTable reduction_table(const ReduceSummary& summary)
{
  report::TextTable table{.header = {"reduction", "value"}, .rows = {}};
  table.rows.push_back({"nodes of the mesh", fmt::format("{}", summary.n_nodes)});
  table.rows.push_back({"DOFs", fmt::format("{}", summary.n_dofs)});
  table.rows.push_back({"masters", fmt::format("{}", summary.n_masters)});
  table.rows.push_back({"method", std::string(reduce::name_of(summary.choice.method))});
  table.rows.push_back({"modes", number_of_modes(summary)});
  const mbs_export::Certificate& certificate = summary.reduced.certificate;
  if (const Eigen::Index n = certificate.eta2.size(); n > 0) {
    table.rows.push_back({fmt::format("estimated error of the frequencies up to {:.0f} Hz",
                                      certificate.frequencies[n - 1] / (2.0 * std::numbers::pi)),
                          fmt::format("{:.1e}", largest_error(certificate))});
  }
  if (certificate.mesh_errors.size() > 0) {
    table.rows.push_back({"estimated error of these by the mesh",
                          fmt::format("{:.1e}", certificate.mesh_errors.maxCoeff())});
  }
  if (const mbs_export::ModeCount& count = certificate.range; count.up_to > 0.0) {
    table.rows.push_back(
        {fmt::format("modes up to {:.0f} Hz", count.up_to / (2.0 * std::numbers::pi)),
         fmt::format("{} of {}{}", count.found, count.expected,
                     count.missing() > 0 ? ": take more modes" : "")});
  }
  table.rows.push_back(
      {"CPU of the factorisation, s", fmt::format("{:.3f}", summary.factorization.cpu_s)});
  return table;
}

std::string described_reduction(const ReduceSummary& summary)
{
  const std::string table = report::format_table(reduction_table(summary));
  if (summary.choice.reason.empty()) return table;
  return fmt::format("{}{} was chosen since\n  {}\n", table, reduce::name_of(summary.choice.method),
                     summary.choice.reason);
}

std::vector<report::Json::Member> reduction_json(const ReduceSummary& summary)
{
  return {{"n_dofs", summary.n_dofs},
          {"n_nodes", summary.n_nodes},
          {"n_masters", summary.n_masters},
          {"method", std::string(reduce::name_of(summary.choice.method))},
          {"why_this_method", summary.choice.reason},
          {"n_modes", summary.n_modes},
          {"certified_frequencies_Hz",
           report::frequencies_json(summary.reduced.certificate.frequencies)},
          {"eta2", report::numbers_json(summary.reduced.certificate.eta2)},
          {"estimated_errors",
           report::numbers_json(mbs_export::estimated_errors(summary.reduced.certificate))},
          {"rounding", report::numbers_json(summary.reduced.certificate.rounding)},
          {"bounds", report::numbers_json(summary.reduced.certificate.bounds)},
          {"modes_expected", summary.reduced.certificate.range.expected},
          {"modes_found", summary.reduced.certificate.range.found},
          {"condition_K_ss", summary.reduced.certificate.condition},
          {"factor_wall_s", summary.factorization.wall_s},
          {"factor_cpu_s", summary.factorization.cpu_s},
          {"modes_residual", summary.modes_residual},
          {"factor_operations", summary.factor.operations},
          {"factor_entries", summary.factor.entries},
          {"factor_operations_of_rank", summary.factor.operations_of_rank},
          {"factor_entries_of_rank", summary.factor.entries_of_rank}};
}

}  // namespace chladni::cases
