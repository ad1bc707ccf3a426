#include "mbs_export/measured/measured_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/measured/universal_file.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::Vector3d;

namespace {

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

namespace {

/// All nodes of the body whose displacements it knows: [n x 3] and [3 n x n_modes].
struct KnownNodes {
  MatrixXd positions, motion;
};

KnownNodes known_nodes(const ModalBody& body)
{
  const Index n_drawn = body.picture.positions.rows(),
              n = n_drawn + std::ssize(body.attachment_nodes);
  KnownNodes known{.positions = MatrixXd(n, 3), .motion = MatrixXd(3 * n, body.n_modes())};
  known.positions.topRows(n_drawn) = body.picture.positions;
  if (n_drawn > 0) known.motion.topRows(3 * n_drawn) = body.picture.transformation;
  for (Index i = n_drawn; i < n; ++i) {
    const Index node = i - n_drawn;
    known.positions.row(i) =
        body.attachment_nodes[static_cast<std::size_t>(node)].position.transpose();
    known.motion.middleRows(3 * i, 3) = body.attachment_modes.middleRows(6 * node, 3);
  }
  return known;
}

/// The nearest known node of each measured one.
std::vector<Index> nearest_nodes(const KnownNodes& known, const MeasuredModes& measured)
{
  std::vector<Index> nearest;
  for (const MeasuredNode& node : measured.nodes) {
    Index at = 0;
    (known.positions.rowwise() - node.position.transpose()).rowwise().squaredNorm().minCoeff(&at);
    nearest.push_back(at);
  }
  return nearest;
}

std::vector<MatchedNode> matched_nodes(const KnownNodes& known, const std::vector<Index>& nearest,
                                       const MeasuredModes& measured, double distance)
{
  std::vector<MatchedNode> matched;
  std::map<Index, std::int64_t> taken;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const MeasuredNode& node = measured.nodes[i];
    const Vector3d place = known.positions.row(nearest[i]).transpose();
    const double gap = (place - node.position).norm();
    if (gap > distance) {
      throw Error(fmt::format(
          "measured node {} at ({:.6g}, {:.6g}, {:.6g}) m is {:.3g} m from the nearest node of the "
          "body, and --distance allows {:.3g} m; is its unit of length right, and are the axes "
          "those of the model?",
          node.number, node.position[0], node.position[1], node.position[2], gap, distance));
    }
    const auto [other, is_new] = taken.emplace(nearest[i], node.number);
    if (!is_new) {
      throw Error(
          fmt::format("measured nodes {} and {} are nearest to the same node of the body; "
                      "keep more nodes (reduce.pictures = \"all\")",
                      other->second, node.number));
    }
    matched.push_back({.number = node.number, .position = place, .distance = gap});
  }
  return matched;
}

/// Rows of the measured shapes that are not zero in all of them.
std::vector<Index> measured_rows(const MatrixXcd& shapes)
{
  std::vector<Index> rows;
  for (Index row = 0; row < shapes.rows(); ++row)
    if (shapes.row(row).cwiseAbs().maxCoeff() > 0.0) rows.push_back(row);
  return rows;
}

/// Natural modes among those of the body.
std::vector<Index> natural_modes(const ModalBody& body)
{
  std::vector<Index> modes;
  for (Index i = 0; i < body.n_modes(); ++i)
    if (body.kinds[static_cast<std::size_t>(i)] != ModeKind::interface) modes.push_back(i);
  return modes;
}

MatrixXd assurance(const MatrixXcd& Psi, const MatrixXd& Phi)
{
  const Eigen::VectorXd psi = Psi.colwise().squaredNorm(), phi = Phi.colwise().squaredNorm();
  const MatrixXd products = (Psi.adjoint() * Phi.cast<std::complex<double>>()).cwiseAbs2();
  return psi.cwiseInverse().asDiagonal() * products * phi.cwiseInverse().asDiagonal();
}

void require_motion(const Eigen::VectorXd& squared_norms, const char* what)
{
  for (Index i = 0; i < squared_norms.size(); ++i)
    if (!(squared_norms[i] > 0.0))
      throw Error(fmt::format("{} {} is zero at all measured nodes", what, i + 1));
}

}  // namespace

ModalAssurance modal_assurance(const ModalBody& body, const MeasuredModes& measured,
                               double distance)
{
  const KnownNodes known = known_nodes(body);
  if (known.positions.rows() == 0) throw Error("the body has no nodes to compare shapes at");
  const std::vector<Index> nearest = nearest_nodes(known, measured);
  ModalAssurance found{.nodes = matched_nodes(known, nearest, measured, distance),
                       .n_components = 0,
                       .modes = {},
                       .body_Hz = {},
                       .measured_Hz = measured.f_Hz,
                       .mac = {}};
  const std::vector<Index> rows = measured_rows(measured.shapes), modes = natural_modes(body);
  if (modes.empty()) throw Error("the body has no natural modes to compare with");
  MatrixXd Phi(std::ssize(rows), std::ssize(modes));
  for (Index i = 0; i < Phi.rows(); ++i) {
    const Index row = rows[static_cast<std::size_t>(i)];
    Phi.row(i) = known.motion(3 * nearest[static_cast<std::size_t>(row / 3)] + row % 3, modes);
  }
  const MatrixXcd Psi = measured.shapes(rows, every);
  require_motion(Psi.colwise().squaredNorm().transpose(), "measured shape");
  found.n_components = Phi.rows();
  found.body_Hz = body.omega(modes) / (2.0 * std::numbers::pi);
  for (const Index mode : modes) found.modes.push_back(static_cast<int>(mode) + 1);
  // A mode that does not move there resembles nothing.
  const Eigen::VectorXd at_rest = (Phi.colwise().squaredNorm().array() == 0.0).cast<double>();
  MatrixXd scaled = Phi;
  for (Index j = 0; j < scaled.cols(); ++j)
    if (at_rest[j] > 0.0) scaled.col(j).setOnes();
  found.mac = assurance(Psi, scaled) * (1.0 - at_rest.array()).matrix().asDiagonal();
  return found;
}

}  // namespace chladni::mbs_export
