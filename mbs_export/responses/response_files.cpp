#include "mbs_export/responses/response_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "common/error.hpp"
#include "mbs_export/files/body_files.hpp"
#include "mbs_export/responses/frequency_responses.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

namespace {

constexpr std::int64_t response_file_version = 1;

void write_points(files::Writer& file, const std::string& group,
                  const std::vector<ResponsePoint>& points)
{
  std::vector<std::string> names;
  std::vector<std::int64_t> components, nodes;
  MatrixXd positions(std::ssize(points), 3);
  for (const ResponsePoint& point : points) {
    positions.row(std::ssize(names)) = point.position.transpose();
    names.push_back(file_parts::link_name(point.name));
    components.push_back(point.component);
    nodes.push_back(point.node);
  }
  file.write(group + "/names", names);
  file.write(group + "/components", std::span<const std::int64_t>(components), "1");
  file.write(group + "/node_numbers", std::span<const std::int64_t>(nodes), "1");
  file.write(group + "/positions", positions, "m");
}

std::vector<ResponsePoint> read_points(const files::Reader& file, const std::string& group)
{
  const std::vector<std::string> names = file.texts(group + "/names");
  const Index n = std::ssize(names);
  if (n == 0) file.fail(group + "/names", "names nothing");
  const std::vector<int> components = file_parts::read_indices(file, group + "/components", 6, n);
  const std::vector<std::int64_t> nodes = file.integers(group + "/node_numbers", n);
  const MatrixXd positions = file.matrix(group + "/positions", {n, 3});
  std::vector<ResponsePoint> points;
  std::set<std::string> seen;
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!seen.insert(names[at]).second)
      file.fail(group + "/names", "names '" + names[at] + "' twice");
    points.push_back({names[at], components[at], nodes[at], positions.row(i).transpose()});
  }
  return points;
}

/// The units of all outputs for one load, each once: "m/N, rad/N".
std::string units_of(const FrequencyResponses& responses, const ResponsePoint& load)
{
  std::string units;
  std::set<std::string> seen;
  for (const ResponsePoint& output : responses.outputs) {
    const std::string unit = unit_of(responses.quantity, output, load);
    if (seen.insert(unit).second) units += fmt::format("{}{}", units.empty() ? "" : ", ", unit);
  }
  return units;
}

void write_complex(files::Writer& file, const std::string& name, const MatrixXcd& values,
                   const std::string& unit)
{
  file.write(name + "_re", MatrixXd(values.real()), unit);
  file.write(name + "_im", MatrixXd(values.imag()), unit);
}

MatrixXcd read_complex(const files::Reader& file, const std::string& name, files::Shape shape)
{
  MatrixXcd values(shape.rows, shape.cols);
  values.real() = file.matrix(name + "_re", shape);
  values.imag() = file.matrix(name + "_im", shape);
  return values;
}

std::string force_group(const SectionForceResponses& one)
{
  return "section_forces/" + file_parts::link_name(one.points.name) + "/";
}

void write_section_forces(files::Writer& file, const FrequencyResponses& responses)
{
  std::vector<std::string> names;
  for (const SectionForceResponses& one : responses.section_forces) {
    const std::string group = force_group(one);
    names.push_back(one.points.name);
    file.write(group + "kinds", one.points.kinds);
    file.write(group + "units", one.points.units);
    file.write(group + "elements", std::span<const std::int64_t>(one.points.elements), "1");
    file.write(group + "positions", MatrixXd(one.points.positions), "m");
    file.write(group + "axes", MatrixXd(one.points.axes), "1");
    for (std::size_t l = 0; l < responses.loads.size(); ++l) {
      const ResponsePoint& load = responses.loads[l];
      write_complex(file, group + "responses/" + load.name + "/r", one.r[l],
                    fmt::format("units of the kinds per {}", load.component < 3 ? "N" : "N m"));
    }
  }
  if (!names.empty()) file.write("section_force_names", names);
}

SectionForceResponses read_section_force(const files::Reader& file, const std::string& name,
                                         const FrequencyResponses& responses)
{
  SectionForceResponses one;
  one.points.name = name;
  const std::string group = force_group(one);
  one.points.kinds = file.texts(group + "kinds");
  one.points.units = file.texts(group + "units");
  if (one.points.kinds.empty() || one.points.kinds.size() != one.points.units.size())
    file.fail(group + "units", "expected a unit for each kind");
  one.points.positions = file.matrix(group + "positions", {files::any, 3});
  const Index n_points = one.points.positions.rows();
  one.points.elements = file.integers(group + "elements", n_points);
  one.points.axes = file.matrix(group + "axes", {n_points, 9});
  const files::Shape shape{responses.Omega.size(), n_points * std::ssize(one.points.kinds)};
  for (const ResponsePoint& load : responses.loads)
    one.r.push_back(read_complex(file, group + "responses/" + load.name + "/r", shape));
  return one;
}

void write_measured(files::Writer& file, const FrequencyResponses& responses)
{
  const MeasuredResponses& measured = responses.measured;
  if (measured.functions.empty()) return;
  const Index n = std::ssize(measured.functions);
  std::vector<std::string> names;
  std::vector<std::int64_t> lines, loads, outputs;
  MatrixXcd H(responses.Omega.size(), n);
  Eigen::VectorXd assurance(n);
  for (Index i = 0; i < n; ++i) {
    const MeasuredResponse& one = measured.functions[static_cast<std::size_t>(i)];
    names.push_back(one.name);
    lines.push_back(one.line);
    loads.push_back(static_cast<std::int64_t>(one.load));
    outputs.push_back(one.output);
    H.col(i) = one.H;
    assurance[i] = response_assurance(one.H, responses.H[one.load].col(one.output));
  }
  file.write("measured/file", measured.file);
  file.write("measured/names", names);
  file.write("measured/lines", std::span<const std::int64_t>(lines), "1");
  file.write("measured/loads", std::span<const std::int64_t>(loads), "1");
  file.write("measured/outputs", std::span<const std::int64_t>(outputs), "1");
  write_complex(file, "measured/H", H, "as of the computed response");
  file.write("measured/assurance", assurance, "1");
}

MeasuredResponses read_measured(const files::Reader& file, const FrequencyResponses& responses)
{
  MeasuredResponses measured{.file = file.text("measured/file")};
  const std::vector<std::string> names = file.texts("measured/names");
  const Index n = std::ssize(names);
  const std::vector<std::int64_t> lines = file.integers("measured/lines", n);
  const std::vector<int> loads = file_parts::read_indices(file, "measured/loads",
                                                          std::ssize(responses.loads), n),
                         outputs = file_parts::read_indices(file, "measured/outputs",
                                                            std::ssize(responses.outputs), n);
  const MatrixXcd H = read_complex(file, "measured/H", {responses.Omega.size(), n});
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!(H.col(i).cwiseAbs().maxCoeff() > 0.0)) file.fail("measured/H_re", "has a zero response");
    measured.functions.push_back({.name = names[at],
                                  .line = lines[at],
                                  .load = static_cast<std::size_t>(loads[at]),
                                  .output = outputs[at],
                                  .H = H.col(i)});
  }
  return measured;
}

/// The value of an enumeration whose name a dataset holds.
template <class Value, std::size_t n>
Value read_word(const files::Reader& file, const std::string& name,
                const std::array<Value, n>& values)
{
  const std::string word = file.text(name);
  for (const Value value : values)
    if (name_of(value) == word) return value;
  file.fail(name, "has '" + word + "', which is none of its words");
}

}  // namespace

void write_responses(const std::filesystem::path& path, const FrequencyResponses& responses)
{
  files::Writer file(path.string());
  file.attribute("/", "format", response_format);
  file.attribute("/", "version", response_file_version);
  file.attribute("/", "title", responses.title);
  file.write("model", name_of(responses.model));
  file.write("quantity", name_of(responses.quantity));
  file.write("damping", responses.damping);
  file.write("loss_factor", responses.loss_factor, "1");
  file.write("frequencies", responses.Omega, "rad/s");
  write_points(file, "loads", responses.loads);
  write_points(file, "outputs", responses.outputs);
  for (std::size_t l = 0; l < responses.loads.size(); ++l) {
    const ResponsePoint& load = responses.loads[l];
    write_complex(file, "responses/" + load.name + "/H", responses.H[l], units_of(responses, load));
  }
  write_section_forces(file, responses);
  write_measured(file, responses);
  file_parts::write_provenance(file, responses.provenance);
  file.commit();
}

FrequencyResponses read_responses(const std::filesystem::path& path)
{
  return read_responses(files::Reader(path.string()));
}

FrequencyResponses read_responses(const files::Reader& file)
{
  using enum ResponseModel;
  using enum ResponseQuantity;
  file.expect_format(response_format, response_file_version);
  FrequencyResponses responses{
      .title = file.text_attribute("/", "title"),
      .model = read_word(file, "model", std::array{body, reduced, fe}),
      .quantity = read_word(file, "quantity", std::array{receptance, mobility, accelerance}),
      .Omega = file.vector("frequencies"),
      .loss_factor = file.real("loss_factor"),
      .damping = file.text("damping"),
      .loads = read_points(file, "loads"),
      .outputs = read_points(file, "outputs"),
      .H = {},
      .section_forces = {},
      .provenance = file_parts::read_provenance(file)};
  const Eigen::VectorXd& Omega = responses.Omega;
  if (Omega.size() < 2 || Omega[0] < 0.0 ||
      std::ranges::adjacent_find(Omega, std::ranges::greater_equal{}) != Omega.end())
    file.fail("frequencies", "expected two or more frequencies of zero or more that ascend");
  for (const ResponsePoint& load : responses.loads) {
    responses.H.push_back(read_complex(file, "responses/" + load.name + "/H",
                                       {Omega.size(), std::ssize(responses.outputs)}));
  }
  if (file.contains("section_force_names"))
    for (const std::string& name : file.texts("section_force_names"))
      responses.section_forces.push_back(read_section_force(file, name, responses));
  if (file.contains("measured/names")) responses.measured = read_measured(file, responses);
  return responses;
}

namespace {

/// A field of CSV: quotes are doubled.
std::string quoted_cell(const std::string& text)
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
  std::string text = quoted_cell("frequency, Hz");
  for (const ResponseColumn& column : columns)
    for (const char* part : {"re", "im"})
      text += ',' + quoted_cell(fmt::format("{} {}, {}", column.name, part, column.unit));
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

namespace {

using std::numbers::pi;

/// Specific data types of dataset 58.
constexpr int displacement = 8, velocity = 11, acceleration = 12, excitation_force = 13,
              frequency = 18;

std::string dataset(int number, const std::string& records)
{
  return fmt::format("{:6d}\n{:6d}\n{}{:6d}\n", -1, number, records, -1);
}

std::string units()
{
  constexpr double celsius = 273.15;
  return dataset(164, fmt::format("{:10d}{:<20}{:10d}\n{:25.16E}{:25.16E}{:25.16E}\n{:25.16E}\n", 1,
                                  "SI: m, N", 2, 1.0, 1.0, 1.0, celsius));
}

std::string node_dataset(const FrequencyResponses& responses)
{
  std::map<std::int64_t, Eigen::Vector3d> nodes;
  for (const auto* const points : {&responses.loads, &responses.outputs})
    for (const ResponsePoint& point : *points) nodes.emplace(point.node, point.position);
  std::string records;
  for (const auto& [number, x] : nodes) {
    records += fmt::format("{:10d}{:10d}{:10d}{:10d}\n{:25.16E}{:25.16E}{:25.16E}\n", number, 0, 0,
                           1, x[0], x[1], x[2]);
  }
  return dataset(2411, records);
}

int type_of(ResponseQuantity quantity)
{
  if (quantity == ResponseQuantity::receptance) return displacement;
  return quantity == ResponseQuantity::mobility ? velocity : acceleration;
}

/// What stands along an axis: its data type and two texts.
std::string axis(int type, const std::string& label, const std::string& unit)
{
  return fmt::format("{:10d}{:5d}{:5d}{:5d} {:<20} {:<20}\n", type, 0, 0, 0, label, unit);
}

std::string unit_of_motion(ResponseQuantity quantity, const ResponsePoint& output)
{
  const std::string motion = output.component < 3 ? "m" : "rad";
  if (quantity == ResponseQuantity::receptance) return motion;
  return motion + (quantity == ResponseQuantity::mobility ? "/s" : "/s^2");
}

/// Five lines of words, DOFs, the frequencies and the axes.
std::string function_header(const FrequencyResponses& responses, const ResponsePoint& output,
                            const ResponsePoint& load, bool is_even)
{
  const Eigen::VectorXd f_Hz = responses.Omega / (2.0 * pi);
  std::string text = fmt::format(
      "{:.80}\n{:.80}\nNONE\n{:.80}\n{:.80}\n", output.name + " / " + load.name,
      responses.title.empty() ? "NONE" : responses.title,
      fmt::format("{} of the {} model", name_of(responses.quantity), name_of(responses.model)),
      fmt::format("damping {}, loss factor {:.6g}", responses.damping, responses.loss_factor));
  text +=
      fmt::format("{:5d}{:10d}{:5d}{:10d} {:<10}{:10d}{:4d} {:<10}{:10d}{:4d}\n", 4, 0, 0, 0,
                  "NONE", output.node, output.component + 1, "NONE", load.node, load.component + 1);
  text +=
      fmt::format("{:10d}{:10d}{:10d}{:13.5E}{:13.5E}{:13.5E}\n", 6, f_Hz.size(), is_even ? 1 : 0,
                  is_even ? f_Hz[0] : 0.0, is_even ? f_Hz[1] - f_Hz[0] : 0.0, 0.0);
  text += axis(frequency, "Frequency", "Hz");
  text += axis(type_of(responses.quantity), name_of(responses.quantity),
               unit_of_motion(responses.quantity, output));
  text += axis(excitation_force, load.component < 3 ? "Force" : "Moment",
               load.component < 3 ? "N" : "N m");
  return text + axis(0, "NONE", "NONE");
}

/// Whether the frequencies add from one to the next.
bool is_evenly_spaced(const Eigen::VectorXd& Omega)
{
  const Index n = Omega.size();
  const Eigen::VectorXd even = Eigen::VectorXd::LinSpaced(n, Omega[0], Omega[n - 1]);
  return (Omega - even).cwiseAbs().maxCoeff() < 1e-9 * Omega[n - 1];
}

/// Two complex numbers in a line, or a frequency and one.
std::string values(const FrequencyResponses& responses, const Eigen::VectorXcd& H, bool is_even)
{
  std::string text;
  const auto end = std::back_inserter(text);
  for (Index f = 0; f < H.size(); ++f) {
    if (!is_even) fmt::format_to(end, "{:13.5E}", responses.Omega[f] / (2.0 * pi));
    fmt::format_to(end, "{:20.11E}{:20.11E}", H[f].real(), H[f].imag());
    if (!is_even || f % 2 == 1 || f + 1 == H.size()) text += '\n';
  }
  return text;
}

}  // namespace

std::string universal_file_of(const FrequencyResponses& responses)
{
  for (const ResponsePoint& load : responses.loads) {
    if (load.node > 0) continue;
    throw Error(
        fmt::format("the load {} is shared by several nodes, and a universal file names one for "
                    "each function; load the nearest of them (response.loads.near) or a coupling",
                    load.name));
  }
  const bool is_even = is_evenly_spaced(responses.Omega);
  std::string text = units() + node_dataset(responses);
  for (std::size_t l = 0; l < responses.loads.size(); ++l) {
    for (std::size_t o = 0; o < responses.outputs.size(); ++o) {
      text += dataset(
          58, function_header(responses, responses.outputs[o], responses.loads[l], is_even) +
                  values(responses, responses.H[l].col(Index(o)), is_even));
    }
  }
  return text;
}

}  // namespace chladni::mbs_export
