#include "mbs_export/measured/measured_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>

#include "common/error.hpp"
#include "mbs_export/measured/record_reader.hpp"
#include "mbs_export/measured/universal_geometry.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;

/// Datasets of other things that do not change what shapes mean: trace lines and the header.
constexpr std::array passed_over{82, 151};

/// One dataset 55.
struct FileShape {
  std::size_t line;
  std::string why_not = {};  ///< what it is where it is no mode; the rest is empty then
  std::string name;
  double f_Hz;
  std::vector<std::int64_t> nodes;
  std::vector<Complex> motion;  ///< three of each node
};

/// What record 6 says of the values.
struct ShapeKind {
  std::string why_not = {};  ///< what it is where it is no mode; the rest is empty then
  bool is_complex_mode, has_complex_values;
  std::size_t n_values;  ///< of each node
};

ShapeKind read_kind(RecordReader& records)
{
  const std::vector<std::int64_t> fields = records.integers("record 6", 6);
  const auto refuse = [&](const std::string& what) { records.fail("record 6: " + what); };
  const std::int64_t analysis = fields[1], characteristic = fields[2], type = fields[4],
                     n = fields[5];
  if (analysis != 2 && analysis != 3) {
    return {.why_not = fmt::format("of analysis type {}, where modes have 2 or 3", analysis),
            .is_complex_mode = false,
            .has_complex_values = false,
            .n_values = 0};
  }
  if (!(characteristic == 2 && n == 3) && !(characteristic == 3 && n == 6)) {
    refuse(
        fmt::format("data characteristic {} with {} values for each node; shapes have 2 with 3 "
                    "translations, or 3 with 6 components",
                    characteristic, n));
  }
  if (type != 2 && type != 5)
    refuse(fmt::format("data type {}; shapes are 2 (real) or 5 (complex)", type));
  return {.is_complex_mode = analysis == 3,
          .has_complex_values = type == 5,
          .n_values = static_cast<std::size_t>(n)};
}

/// Records 7 and 8: the numbers of integers and reals that follow, and these.
double read_frequency(RecordReader& records, const ShapeKind& kind)
{
  const std::vector<std::int64_t> counts = records.integers("record 7", 2);
  if (counts[1] < (kind.is_complex_mode ? 2 : 1) || counts[1] > 6)
    records.fail(fmt::format("record 7 announces {} numbers of a mode", counts[1]));
  const std::vector<double> of_mode =
      records.reals("record 8", static_cast<std::size_t>(counts[1]), 13, 6);
  if (!kind.is_complex_mode) return of_mode[0];
  return std::abs(Complex(of_mode[0], of_mode[1])) / (2.0 * std::numbers::pi);
}

FileShape read_shape(RecordReader& records, const UniversalDataset& dataset)
{
  FileShape shape{.line = dataset.first_line, .name = {}, .f_Hz = 0.0, .nodes = {}, .motion = {}};
  for (int k = 0; k < 5; ++k) {
    const std::string& line = records.line("a line of words");
    if (k == 0) shape.name = line.substr(0, line.find_last_not_of(" \r") + 1);
  }
  const ShapeKind kind = read_kind(records);
  shape.why_not = kind.why_not;
  if (!shape.why_not.empty()) return shape;
  shape.f_Hz = read_frequency(records, kind);
  if (!(shape.f_Hz >= 0.0)) records.fail("record 8: the frequency is negative");
  const std::size_t parts = kind.has_complex_values ? 2 : 1;
  std::set<std::int64_t> seen;
  while (!records.at_end()) {
    shape.nodes.push_back(records.integers("the number of a node", 1)[0]);
    if (!seen.insert(shape.nodes.back()).second)
      records.fail(fmt::format("node {} is there twice", shape.nodes.back()));
    const std::vector<double> values =
        records.reals("values of a node", parts * kind.n_values, 13, 6);
    for (std::size_t c = 0; c < 3; ++c)
      shape.motion.emplace_back(values[parts * c], parts == 2 ? values[2 * c + 1] : 0.0);
  }
  if (shape.nodes.empty()) records.fail("has no nodes");
  return shape;
}

/// What a file holds.
struct Contents {
  UniversalGeometry geometry;
  std::vector<FileShape> shapes;
  std::map<std::string, int> left_out;  ///< what it is, and how often
};

Contents contents_of(const std::filesystem::path& path)
{
  Contents contents;
  for (const UniversalDataset& dataset : read_universal_datasets(path)) {
    RecordReader records(path, dataset);
    if (dataset.number == 55 && dataset.binary) {
      ++contents.left_out["dataset 55 in binary, of which only ASCII is read"];
    } else if (dataset.number == 55) {
      FileShape shape = read_shape(records, dataset);
      if (shape.why_not.empty())
        contents.shapes.push_back(std::move(shape));
      else
        ++contents.left_out["dataset 55 " + shape.why_not];
    } else if (std::ranges::find(passed_over, dataset.number) == passed_over.end() &&
               (dataset.binary || !contents.geometry.take(records, dataset))) {
      ++contents.left_out[fmt::format("dataset {}", dataset.number)];
    }
  }
  return contents;
}

std::string list_left_out(const Contents& contents)
{
  std::string text;
  for (const auto& [what, n] : contents.left_out)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, what);
  return text;
}

/// The node of the first shape, in metres and in the axes of the model.
MeasuredNode node_of(const std::filesystem::path& path, const UniversalGeometry& geometry,
                     std::int64_t number, double metres)
{
  const auto found = geometry.nodes().find(number);
  if (found == geometry.nodes().end()) {
    throw Error(fmt::format("{}: a shape has node {}, and no dataset 15 or 2411 says where that is",
                            path.string(), number));
  }
  const UniversalNode& node = found->second;
  if (!geometry.is_in_global_axes(node)) {
    throw Error(
        fmt::format("{}: node {} has a coordinate system of its own ({}, {}); write nodes "
                    "and shapes in the global one",
                    path.string(), number, node.defined_in, node.displaced_in));
  }
  return {number, metres * node.position};
}

}  // namespace

MeasuredModes read_measured_modes(const std::filesystem::path& path, std::optional<double> metres)
{
  const Contents contents = contents_of(path);
  const std::string left_out = list_left_out(contents);
  if (contents.shapes.empty()) {
    throw Error(fmt::format("{}: has no mode shapes (dataset 55){}{}", path.string(),
                            left_out.empty() ? "" : "; it has ", left_out));
  }
  const std::optional<double> unit =
      contents.geometry.units() ? std::optional(contents.geometry.units()->metres) : metres;
  if (!unit) {
    throw Error(fmt::format("{}: does not say its unit of length (dataset 164); give --length-unit",
                            path.string()));
  }
  const std::vector<std::int64_t>& nodes = contents.shapes.front().nodes;
  MeasuredModes modes{
      .nodes = {},
      .f_Hz = Eigen::VectorXd(std::ssize(contents.shapes)),
      .names = {},
      .shapes = Eigen::MatrixXcd(3 * std::ssize(nodes), std::ssize(contents.shapes))};
  if (!left_out.empty())
    modes.notes.push_back(fmt::format("{}: left out: {}", path.string(), left_out));
  for (const std::int64_t number : nodes)
    modes.nodes.push_back(node_of(path, contents.geometry, number, *unit));
  for (Index k = 0; k < modes.f_Hz.size(); ++k) {
    const FileShape& shape = contents.shapes[static_cast<std::size_t>(k)];
    if (shape.nodes != nodes) {
      throw Error(fmt::format("{}:{}: dataset 55: mode {} has other nodes than the first one",
                              path.string(), shape.line, k + 1));
    }
    modes.f_Hz[k] = shape.f_Hz;
    modes.names.push_back(shape.name);
    modes.shapes.col(k) =
        Eigen::Map<const Eigen::VectorXcd>(shape.motion.data(), 3 * std::ssize(nodes));
  }
  return modes;
}

}  // namespace chladni::mbs_export
