#include "report/fe/mesh_quality.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "report/output.hpp"

namespace chladni::report {
namespace {

/// One measure with the inner edges of its histogram's bins; the outer ones are open.
struct Measure {
  const char* key;
  const char* name;
  double mesh::ElementQuality::*value;
  std::vector<double> edges;
};

const std::vector<Measure>& measures()
{
  using Q = mesh::ElementQuality;
  static const std::vector<Measure> all{
      {"scaled_jacobian", "scaled Jacobian", &Q::scaled_jacobian, {0.0, 0.2, 0.4, 0.6, 0.8, 0.9}},
      {"aspect_ratio", "aspect ratio", &Q::aspect_ratio, {1.5, 2.0, 3.0, 5.0, 10.0, 20.0}},
      {"warp_deg", "warp, degrees", &Q::warp, {1.0, 2.0, 5.0, 10.0, 20.0, 40.0}},
      {"skew", "skew", &Q::skew, {0.1, 0.25, 0.5, 0.75, 0.9, 0.95}}};
  return all;
}

struct Statistics {
  double least, mean, greatest;
  std::vector<int> counts;  ///< of the bins
};

Statistics statistics(const std::vector<mesh::ElementQuality>& elements, const Measure& measure)
{
  std::vector<double> values;
  for (const mesh::ElementQuality& e : elements) values.push_back(e.*measure.value);
  const auto [least, greatest] = std::ranges::minmax(values);
  Statistics s{.least = least,
               .mean = std::accumulate(values.begin(), values.end(), 0.0) /
                       static_cast<double>(values.size()),
               .greatest = greatest,
               .counts = std::vector<int>(measure.edges.size() + 1, 0)};
  for (const double x : values) {
    const auto bin = std::ranges::upper_bound(measure.edges, x);
    ++s.counts[bin - measure.edges.begin()];
  }
  return s;
}

/// "< 0", "0 to 0.2", ..., ">= 0.9"
std::string bin_name(const std::vector<double>& edges, std::size_t bin)
{
  if (bin == 0) return fmt::format("< {}", edges.front());
  if (bin == edges.size()) return fmt::format(">= {}", edges.back());
  return fmt::format("{} to {}", edges[bin - 1], edges[bin]);
}

std::string histogram(const Measure& measure, const Statistics& s)
{
  constexpr int width = 40;
  const int most = std::ranges::max(s.counts);
  std::string text = fmt::format("\n{}\n", measure.name);
  for (std::size_t bin = 0; bin < s.counts.size(); ++bin) {
    const auto n = static_cast<std::size_t>(std::int64_t(width) * s.counts[bin] / most);
    const std::string bar(s.counts[bin] > 0 ? std::max<std::size_t>(n, 1) : 0, '#');
    text += fmt::format("  {:>12} {:>8}  {}\n", bin_name(measure.edges, bin), s.counts[bin], bar);
  }
  return text;
}

}  // namespace

std::string quality_text(const std::vector<mesh::ElementQuality>& elements)
{
  if (elements.empty()) return "no surface elements, whose shapes would matter\n";
  TextTable table{.header = {"shape of the elements", "min", "mean", "max"}, .rows = {}};
  std::string histograms;
  for (const Measure& measure : measures()) {
    const Statistics s = statistics(elements, measure);
    table.rows.push_back({measure.name, fmt::format("{:.4f}", s.least),
                          fmt::format("{:.4f}", s.mean), fmt::format("{:.4f}", s.greatest)});
    histograms += histogram(measure, s);
  }
  std::vector<std::int64_t> numbers = mesh::unusable(elements);
  std::string text = format_table(table) + histograms;
  text += fmt::format("\nelements that cannot work: {}", numbers.size());
  if (numbers.empty()) return text + "\n";
  const bool more = numbers.size() > 10;
  numbers.resize(std::min<std::size_t>(numbers.size(), 10));
  return text + fmt::format(": {}{}\n", fmt::join(numbers, ", "), more ? ", ..." : "");
}

std::vector<Json::Member> quality_json(const std::vector<mesh::ElementQuality>& elements)
{
  std::vector<Json::Member> of_measures;
  for (const Measure& measure : measures()) {
    if (elements.empty()) break;  // lines alone
    const Statistics s = statistics(elements, measure);
    of_measures.emplace_back(
        measure.key,
        Json::object({{"min", s.least},
                      {"mean", s.mean},
                      {"max", s.greatest},
                      {"bin_edges", Json::array({measure.edges.begin(), measure.edges.end()})},
                      {"counts", Json::array({s.counts.begin(), s.counts.end()})}}));
  }
  const std::vector<std::int64_t> numbers = mesh::unusable(elements);
  return {{"quality", Json::object(of_measures)},
          {"unusable_elements", Json::array({numbers.begin(), numbers.end()})}};
}

}  // namespace chladni::report
