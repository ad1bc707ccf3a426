#include "mbs_export/responses/response_csv.hpp"

#include <fmt/format.h>

#include <iterator>
#include <numbers>

namespace chladni::mbs_export {
namespace {

/// A field of CSV: quotes are doubled.
std::string quoted(const std::string& text)
{
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

/// A computed or measured response.
struct ResponseColumn {
  std::string name, unit;
  Eigen::VectorXcd H;
};

std::vector<ResponseColumn> response_columns(const FrequencyResponses& responses)
{
  std::vector<ResponseColumn> columns;
  for (std::size_t l = 0; l < responses.loads.size(); ++l) {
    for (std::size_t o = 0; o < responses.outputs.size(); ++o) {
      const auto output = static_cast<Eigen::Index>(o);
      const std::string pair =
          fmt::format("{} / {}", responses.outputs[o].name, responses.loads[l].name);
      const std::string unit =
          unit_of(responses.quantity, responses.outputs[o], responses.loads[l]);
      columns.push_back({pair, unit, responses.H[l].col(output)});
      for (const MeasuredResponse& one : responses.measured.functions)
        if (one.load == l && one.output == output)
          columns.push_back({fmt::format("{} measured (line {})", pair, one.line), unit, one.H});
    }
  }
  return columns;
}

}  // namespace

std::string csv_of(const FrequencyResponses& responses)
{
  const std::vector<ResponseColumn> columns = response_columns(responses);
  std::string text = quoted("frequency, Hz");
  for (const ResponseColumn& column : columns)
    for (const char* part : {"re", "im"})
      text += ',' + quoted(fmt::format("{} {}, {}", column.name, part, column.unit));
  text += "\n";
  const auto end = std::back_inserter(text);
  for (Eigen::Index f = 0; f < responses.Omega.size(); ++f) {
    fmt::format_to(end, "{}", responses.Omega[f] / (2.0 * std::numbers::pi));
    for (const ResponseColumn& column : columns)
      fmt::format_to(end, ",{},{}", column.H[f].real(), column.H[f].imag());
    text += "\n";
  }
  return text;
}

}  // namespace chladni::mbs_export
