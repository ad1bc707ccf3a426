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

}  // namespace

std::string csv_of(const FrequencyResponses& responses)
{
  std::string text = quoted("frequency, Hz");
  for (const ResponsePoint& load : responses.loads) {
    for (const ResponsePoint& output : responses.outputs) {
      const std::string unit = unit_of(responses.quantity, output, load);
      for (const char* part : {"re", "im"}) {
        text += ',';
        text += quoted(fmt::format("{} / {} {}, {}", output.name, load.name, part, unit));
      }
    }
  }
  text += "\n";
  const auto end = std::back_inserter(text);
  for (Eigen::Index f = 0; f < responses.Omega.size(); ++f) {
    fmt::format_to(end, "{}", responses.Omega[f] / (2.0 * std::numbers::pi));
    for (const Eigen::MatrixXcd& H : responses.H)
      for (Eigen::Index j = 0; j < H.cols(); ++j)
        fmt::format_to(end, ",{},{}", H(f, j).real(), H(f, j).imag());
    text += "\n";
  }
  return text;
}

}  // namespace chladni::mbs_export
