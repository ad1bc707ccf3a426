#include "mesh/nodal_matrices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <tuple>
#include <unordered_map>

#include "common/error.hpp"
#include "common/files/input_file.hpp"
#include "mesh/decks/deck_text.hpp"
#include "mesh/gmsh_text.hpp"

/// Matrices as other programs write them: lines "row column value" of CalculiX, with a table of
/// "node.component" for the rows; "node, DOF, node, DOF, value" of Abaqus; Matrix Market, with such
/// a table. What a line is, its fields tell. Then rigid motions are tried: K R = 0 row by row
/// finds supports, constraints, local systems and wrong tables; R^T M R is the mass of a body.

namespace chladni::mesh {

namespace {

constexpr const char* components_of_files = "a node has the DOFs 1 to 3, or 1 to 6";

std::string short_name(const std::string& file)
{
  return std::filesystem::path(file).filename().string();
}

std::string text_of_matrix(const std::string& file)
{
  files::regular_file_size(file);
  return read_all(file);
}

/// A line of a file as fields that blanks, commas and the dot of "12.1" part.
struct CutFields {
  static constexpr std::size_t most = 6;  // one more than a line of any kind has
  std::array<std::string_view, most> field;
  std::size_t n = 0;

  CutFields(std::string_view line, std::string_view separators)
  {
    for (std::size_t at = line.find_first_not_of(separators); at < line.size() && n < most;) {
      const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
      field[n++] = line.substr(at, end - at);
      at = std::min(line.find_first_not_of(separators, end), line.size());
    }
  }
};

constexpr std::string_view parting = " ,\t\r", parting_labels = " ,.;:\t\r";

/// A file and a line of it, for messages.
struct FilePlace {
  const std::string& file;
  int line;

  [[noreturn]] void refuse(const std::string& why) const
  {
    throw Error(fmt::format("{}, line {}: {}", file, line, why));
  }
};

template <typename Number>
Number number_of(std::string_view text, const FilePlace& place)
{
  Number value{};
  const char* const end = text.data() + text.size();
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end) place.refuse(fmt::format("\"{}\" is no number", text));
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(value)) place.refuse(fmt::format("{} is not finite", text));
  return value;
}

/// An entry as a file has it.
struct RawEntry {
  int row, column;  ///< 6 * node + component
  double value;
  int line;
};

/// What the first line of a Matrix Market file says is admissible.
void check_banner(std::string_view line, const FilePlace& place)
{
  const std::string banner = capitals(std::string(line));
  const bool is_known = banner.find(" MATRIX ") != std::string::npos &&
                        banner.find(" COORDINATE ") != std::string::npos &&
                        (banner.find(" REAL ") != std::string::npos ||
                         banner.find(" INTEGER ") != std::string::npos) &&
                        banner.find("SKEW") == std::string::npos;
  if (!is_known) {
    place.refuse(
        "only \"%%MatrixMarket matrix coordinate real symmetric\", or general with equal "
        "triangles, can be read");
  }
}

/// Reads matrices for the nodes of a mesh.
class MatrixReader {
 public:
  MatrixReader(const Mesh& mesh, const std::optional<std::string>& table) : mesh_(mesh)
  {
    for (int i = 0; i < mesh.n_nodes(); ++i) index_.emplace(mesh.node_numbers[std::size_t(i)], i);
    if (table) read_table(*table);
  }

  std::vector<RawEntry> read(const std::string& file) const;

 private:
  void read_table(const std::string& file);
  int dof(std::string_view node, std::string_view component, const FilePlace& place) const;
  int dof_of_row(std::string_view row, const FilePlace& place) const;
  RawEntry entry(const CutFields& line, const FilePlace& place) const;

  const Mesh& mesh_;
  std::unordered_map<std::int64_t, int> index_;
  std::string table_;      ///< its name; empty: none
  std::vector<int> dofs_;  ///< of its rows
};

int MatrixReader::dof(std::string_view node, std::string_view component,
                      const FilePlace& place) const
{
  const auto number = number_of<std::int64_t>(node, place);
  const auto c = number_of<int>(component, place);
  if (number < 1) {
    place.refuse(
        fmt::format("node {} is an internal one, of an element or a constraint; take what makes it "
                    "(hybrid elements, connectors, Lagrange multipliers) out of the model",
                    number));
  }
  if (c < 1 || c > 6)
    place.refuse(fmt::format("DOF {} of node {}: {}", c, number, components_of_files));
  const auto found = index_.find(number);
  if (found == index_.end()) {
    place.refuse(
        fmt::format("the mesh file has no node {}; take the mesh of the same model", number));
  }
  return 6 * found->second + c - 1;
}

void MatrixReader::read_table(const std::string& file)
{
  table_ = short_name(file);
  const std::string text = text_of_matrix(file);
  std::unordered_map<int, int> lines;
  for_each_line(text, 0, [&](std::string_view line, int number) {
    const CutFields fields(line, parting_labels);
    const bool is_head = number == 1 && fields.n > 0 &&
                         std::isalpha(static_cast<unsigned char>(fields.field[0][0])) != 0;
    if (fields.n == 0 || is_head || fields.field[0].starts_with('#')) return true;
    const FilePlace place{table_, number};
    if (fields.n != 2) place.refuse("must be the node and the component of a row, like 12.1");
    dofs_.push_back(dof(fields.field[0], fields.field[1], place));
    const auto [before, is_new] = lines.emplace(dofs_.back(), number);
    if (!is_new)
      place.refuse(fmt::format("line {} has the same node and component", before->second));
    return true;
  });
  if (dofs_.empty()) throw Error(fmt::format("{} has no rows", table_));
}

int MatrixReader::dof_of_row(std::string_view row, const FilePlace& place) const
{
  const auto number = number_of<std::int64_t>(row, place);
  if (table_.empty()) {
    place.refuse(
        "rows have numbers, so that `dofs` in mesh.matrices must name the table of their nodes and "
        "components");
  }
  if (number < 1 || number > std::ssize(dofs_))
    place.refuse(fmt::format("row {} is none of the {} rows of {}", number, dofs_.size(), table_));
  return dofs_[std::size_t(number - 1)];
}

RawEntry MatrixReader::entry(const CutFields& line, const FilePlace& place) const
{
  constexpr double penalty = 1e30;  // supports of Abaqus are 1e36 on the diagonal
  if (line.n != 3 && line.n != 5)
    place.refuse("must be \"row column value\" or \"node, DOF, node, DOF, value\"");
  const auto& f = line.field;
  const bool has_labels = line.n == 5;
  const RawEntry entry{.row = has_labels ? dof(f[0], f[1], place) : dof_of_row(f[0], place),
                       .column = has_labels ? dof(f[2], f[3], place) : dof_of_row(f[1], place),
                       .value = number_of<double>(f[line.n - 1], place),
                       .line = place.line};
  if (std::abs(entry.value) >= penalty) {
    place.refuse(
        fmt::format("{:g} at node {} holds it: take the supports out of the model, and "
                    "write them into the scene",
                    entry.value, mesh_.node_numbers[std::size_t(entry.row / 6)]));
  }
  return entry;
}

std::vector<RawEntry> MatrixReader::read(const std::string& file) const
{
  const std::string text = text_of_matrix(file), name = short_name(file);
  const bool is_market = text.starts_with("%%MatrixMarket");
  std::vector<RawEntry> entries;
  std::int64_t n_said = -1;
  for_each_line(text, 0, [&](std::string_view line, int number) {
    const FilePlace place{name, number};
    if (is_market && number == 1) check_banner(line, place);
    const std::size_t first = line.find_first_not_of(parting);
    if (first == std::string_view::npos || line[first] == '*' || line[first] == '%' ||
        line[first] == '#')
      return true;
    const CutFields fields(line, parting);
    if (!is_market || n_said >= 0) {
      entries.push_back(entry(fields, place));
      return true;
    }
    if (fields.n != 3) place.refuse("must be the numbers of rows, columns and entries");
    n_said = number_of<std::int64_t>(fields.field[2], place);
    const auto n_rows = number_of<std::int64_t>(fields.field[0], place);
    if (!dofs_.empty() && n_rows != std::ssize(dofs_))
      place.refuse(fmt::format("{} rows, but {} has {}", n_rows, table_, dofs_.size()));
    return true;
  });
  if (entries.empty()) throw Error(fmt::format("{} has no entries", name));
  if (is_market && n_said != std::ssize(entries))
    throw Error(fmt::format("{} has {} of its {} entries", name, entries.size(), n_said));
  return entries;
}

/// "node 17, DOF 2"
std::string dof_name(const Mesh& mesh, int dof)
{
  return fmt::format("node {}, DOF {}", mesh.node_numbers[std::size_t(dof / 6)], dof % 6 + 1);
}

/// The diagonal of a matrix, [6 n_nodes].
std::vector<double> diagonal_of(const Mesh& mesh, const auto& entries)
{
  std::vector<double> diagonal(6 * std::size_t(mesh.n_nodes()), 0.0);
  for (const auto& entry : entries)
    if (entry.row == entry.column) diagonal[std::size_t(entry.row)] = entry.value;
  return diagonal;
}

/// Names the pair that only one triangle has, or has otherwise than the other.
[[noreturn]] void refuse_unsymmetric(const Mesh& mesh, const std::string& name, const RawEntry& at,
                                     const std::string& other)
{
  throw Error(fmt::format(
      "{}, line {}: {} at row {}, column {}, but {} on the other side of the diagonal; "
      "only symmetric matrices can be read: take friction, contact and follower loads "
      "out of the step",
      name, at.line, at.value, dof_name(mesh, at.row), dof_name(mesh, at.column), other));
}

/// One triangle, of a file that has one or two equal ones.
std::vector<MatrixEntry> one_triangle(const Mesh& mesh, const std::string& file,
                                      std::vector<RawEntry> raw)
{
  constexpr double round_off = 1e-9;  // of sqrt(A_ii A_jj)
  const std::string name = short_name(file);
  const std::vector<double> diagonal = diagonal_of(mesh, raw);
  const auto key = [](const RawEntry& e) {
    const auto [low, high] = std::minmax(e.row, e.column);
    return std::tuple(low / 6, high / 6, low, high, e.line);
  };
  std::ranges::sort(raw, {}, key);
  std::vector<MatrixEntry> entries;
  bool has_pairs = false;
  const RawEntry* single = nullptr;
  for (std::size_t i = 0; i < raw.size();) {
    const RawEntry& a = raw[i];
    const bool is_pair = i + 1 < raw.size() && std::minmax(a.row, a.column) ==
                                                   std::minmax(raw[i + 1].row, raw[i + 1].column);
    double value = a.value;
    if (is_pair) {
      const RawEntry& b = raw[i + 1];
      if (b.row == a.row) {
        throw Error(
            fmt::format("{}, lines {} and {}: the entry at row {}, column {} is there twice", name,
                        a.line, b.line, dof_name(mesh, a.row), dof_name(mesh, a.column)));
      }
      const double scale =
          std::sqrt(std::abs(diagonal[std::size_t(a.row)] * diagonal[std::size_t(a.column)]));
      if (std::abs(a.value - b.value) > round_off * scale)
        refuse_unsymmetric(mesh, name, a, fmt::format("{}", b.value));
      value = 0.5 * (a.value + b.value);
      has_pairs = true;
    } else if (a.row != a.column && a.value != 0.0) {
      single = &a;
    }
    if (has_pairs && single != nullptr) refuse_unsymmetric(mesh, name, *single, "nothing");
    if (value != 0.0) {
      const auto [low, high] = std::minmax(a.row, a.column);
      entries.push_back({.row = low, .column = high, .value = value});
    }
    i += is_pair ? 2 : 1;
  }
  return entries;
}

/// Entries in SI units: a rotation instead of a displacement is a length more.
void convert(std::vector<MatrixEntry>& entries, const MeshOptions& options)
{
  const double of_displacements = options.matrices->force_unit / options.length_unit;
  for (MatrixEntry& entry : entries) {
    entry.value *= of_displacements;
    for (const int dof : {entry.row, entry.column})
      if (dof % 6 >= 3) entry.value *= options.length_unit;
  }
}

/// The DOFs of the nodes by the rows of K, and what they must be.
std::vector<std::int8_t> components_by_rows(const Mesh& mesh, const MatrixFiles& files,
                                            const NodalMatrices& matrices)
{
  const std::string name = short_name(files.stiffness);
  std::vector<std::uint8_t> has(std::size_t(mesh.n_nodes()), 0);
  const std::vector<double> diagonal = diagonal_of(mesh, matrices.K);
  const std::array names{&files.stiffness, &files.mass, files.damping ? &*files.damping : nullptr,
                         files.structural_damping ? &*files.structural_damping : nullptr};
  for (std::size_t k = 0; k < names.size(); ++k) {
    for (const MatrixEntry& entry : *matrices.all()[k]) {
      for (const int dof : {entry.row, entry.column}) {
        has[std::size_t(dof / 6)] |= std::uint8_t(1 << dof % 6);
        if (diagonal[std::size_t(dof)] > 0.0) continue;
        throw Error(fmt::format("{}: {} has the diagonal {}, which must be positive{}", name,
                                dof_name(mesh, dof), diagonal[std::size_t(dof)],
                                k == 0 ? "" : ", since " + short_name(*names[k]) + " has the row"));
      }
    }
  }
  for (const MatrixEntry& entry : matrices.M) {
    if (entry.row == entry.column && entry.value < 0.0) {
      throw Error(fmt::format("{}: {} has the negative mass {:g} kg", short_name(files.mass),
                              dof_name(mesh, entry.row), entry.value));
    }
  }
  std::vector<std::int8_t> n_components;
  for (std::size_t node = 0; node < has.size(); ++node) {
    constexpr unsigned displacements = 0b111, all = 0b111111;
    if (has[node] != 0 && has[node] != displacements && has[node] != all) {
      std::string there;
      for (int c = 0; c < 6; ++c)
        if ((has[node] >> c & 1) != 0)
          there += fmt::format("{}{}", there.empty() ? "" : ", ", c + 1);
      throw Error(
          fmt::format("{}: node {} has the DOFs {} alone; {}: take supports and constraints "
                      "out of the model, and write supports into the scene",
                      name, mesh.node_numbers[node], there, components_of_files));
    }
    n_components.push_back(has[node] == all ? 6 : has[node] == displacements ? 3 : 0);
  }
  return n_components;
}

/// Component c at a distance d from the origin of motion k: three unit translations, then three
/// unit rotations.
double rigid_motion(int k, int c, const Vector& d)
{
  if (k < 3) return c == k ? 1.0 : 0.0;
  const int axis = k - 3;
  if (c >= 3) return c - 3 == axis ? 1.0 : 0.0;
  if (c == axis) return 0.0;
  return ((c + 1) % 3 == axis ? 1.0 : -1.0) * d[std::size_t(3 - axis - c)];
}

constexpr std::array names_of_motions{"translation along x", "translation along y",
                                      "translation along z", "rotation about x",
                                      "rotation about y",    "rotation about z"};

/// Calls visit(row, column, value) for both triangles.
void for_both_triangles(const std::vector<MatrixEntry>& entries, const auto& visit)
{
  for (const auto& [row, column, value] : entries) {
    visit(row, column, value);
    if (row != column) visit(column, row, value);
  }
}

/// No row of K resists a rigid motion about its own node.
void check_rigid_motions(const Mesh& mesh, const std::string& file, const NodalMatrices& matrices)
{
  constexpr double round_off = 1e-8;  // of sum sqrt(K_ii K_jj) |R_j|; files have 14 digits
  using Row = std::array<double, 6>;
  const std::vector<double> diagonal = diagonal_of(mesh, matrices.K);
  std::vector<Row> residual(diagonal.size(), Row{}), scale(diagonal.size(), Row{});
  for_both_triangles(matrices.K, [&](int row, int column, double value) {
    const auto i = std::size_t(row), j = std::size_t(column);
    const Vector d = minus(mesh.positions[j / 6], mesh.positions[i / 6]);
    for (int k = 0; k < 6; ++k) {
      const double R = rigid_motion(k, column % 6, d);
      residual[i][std::size_t(k)] += value * R;
      scale[i][std::size_t(k)] += std::sqrt(diagonal[i] * diagonal[j]) * std::abs(R);
    }
  });
  double largest = round_off;
  int n_wrong = 0, dof = -1, motion = 0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    double of_row = 0.0;
    for (std::size_t k = 0; k < 6; ++k) {
      const double share = std::abs(residual[i][k]) / std::max(scale[i][k], 1e-300);
      of_row = std::max(of_row, share);
      if (share <= largest) continue;
      largest = share;
      dof = static_cast<int>(i);
      motion = static_cast<int>(k);
    }
    n_wrong += of_row > round_off ? 1 : 0;
  }
  if (dof < 0) return;
  throw Error(fmt::format(
      "{}: {} resists a {} (by {:.1e} of its stiffness; {} such rows): the body must be free. {}",
      short_name(file), dof_name(mesh, dof), names_of_motions[std::size_t(motion)], largest,
      n_wrong,
      motion < 3 ? "Take supports and springs to the ground out of the model, and write them into "
                   "the scene; or the table of nodes does not fit"
                 : "Its constraints or local axes are left in, or the table of nodes, length_unit "
                   "or the coordinates of the mesh do not fit"));
}

/// R^T M R, about the mean of the nodes.
struct RigidMass {
  std::array<std::array<double, 6>, 6> matrix{};
  Vector origin{};
  std::vector<Vector> of_nodes;  ///< kg, of translations along x, y, z
};

RigidMass rigid_mass(const Mesh& mesh, const NodalMatrices& matrices)
{
  RigidMass mass;
  for (const auto& x : mesh.positions)
    for (std::size_t c = 0; c < 3; ++c) mass.origin[c] += x[c] / double(mesh.n_nodes());
  mass.of_nodes.resize(mesh.positions.size(), Vector{});
  for_both_triangles(matrices.M, [&](int row, int column, double value) {
    const auto i = std::size_t(row / 6), j = std::size_t(column / 6);
    const Vector at_row = minus(mesh.positions[i], mass.origin),
                 at_column = minus(mesh.positions[j], mass.origin);
    for (int k = 0; k < 6; ++k) {
      const double left = rigid_motion(k, row % 6, at_row) * value;
      if (left == 0.0) continue;
      for (int l = 0; l < 6; ++l) {
        mass.matrix[std::size_t(k)][std::size_t(l)] +=
            left * rigid_motion(l, column % 6, at_column);
      }
    }
    if (row % 6 == column % 6 && row % 6 < 3) mass.of_nodes[i][std::size_t(row % 6)] += value;
  });
  return mass;
}

/// [m I, -m c~; m c~, J], and the note that tells m and c.
std::string checked_mass(const Mesh& mesh, const std::string& file, const NodalMatrices& matrices)
{
  constexpr double alike = 1e-6;
  const RigidMass rigid = rigid_mass(mesh, matrices);
  const auto& R = rigid.matrix;
  const double m = (R[0][0] + R[1][1] + R[2][2]) / 3.0;
  double size = 0.0, wrong = 0.0;
  for (const auto& x : mesh.positions) size = std::max(size, norm(minus(x, rigid.origin)));
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < 3; ++l) {
      wrong = std::max(wrong, std::abs(R[k][l] - (k == l ? m : 0.0)));
      wrong = std::max(wrong, 0.5 * std::abs(R[k][3 + l] + R[l][3 + k]) / std::max(size, 1e-300));
    }
  }
  if (!(m > 0.0) || wrong > alike * m) {
    const auto spread = [](const Vector& of_node) {
      const auto [least, most] = std::ranges::minmax(of_node);
      return most - least;
    };
    const auto worst =
        std::ranges::max_element(rigid.of_nodes, {}, spread) - rigid.of_nodes.begin();
    throw Error(fmt::format(
        "{}: this is the mass of no body: {:.6g} kg along x, {:.6g} along y, {:.6g} along z (most "
        "unlike at node {}); rows are missing, or the table of nodes does not fit",
        short_name(file), R[0][0], R[1][1], R[2][2], mesh.node_numbers[std::size_t(worst)]));
  }
  // R_(k, 3 + a) = m (e_a x c)_k
  const Vector c{R[2][4] / m * -1.0 + rigid.origin[0], R[2][3] / m + rigid.origin[1],
                 R[0][4] / m + rigid.origin[2]};
  return fmt::format(
      "the matrices have the mass {:.6g} kg with its centre at ({:.4g}, {:.4g}, {:.4g}) m: if that "
      "is not the body's, length_unit or force_unit in [mesh] is another",
      m, c[0], c[1], c[2]);
}

/// Drops the nodes without DOFs, element and coupling.
void drop_other_nodes(Mesh& mesh, NodalMatrices& matrices, const MeshOptions& options)
{
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      for (const int node : block.element_nodes(e)) {
        if (matrices.n_components[std::size_t(node)] > 0) continue;
        throw Error(fmt::format(
            "{} has no row of node {}, which element {} has: take supports and constraints that "
            "hold it out of the model, or take the mesh of the same model",
            short_name(options.matrices->stiffness), mesh.node_numbers[std::size_t(node)],
            block.numbers[std::size_t(e)]));
      }
    }
  }
  const std::vector<std::int64_t> before = mesh.node_numbers;
  Group with_dofs{.name = "", .dimension = 0, .nodes = {}};  // no file has such a name
  for (std::size_t node = 0; node < matrices.n_components.size(); ++node)
    if (matrices.n_components[node] > 0) with_dofs.nodes.push_back(static_cast<int>(node));
  mesh.groups.push_back(std::move(with_dofs));
  std::vector<std::string> kept = options.coupled_groups;
  kept.emplace_back();
  drop_unused_nodes(mesh, kept);
  mesh.groups.pop_back();
  std::vector<int> now(before.size(), -1);
  std::vector<std::int8_t> n_components;
  for (std::size_t old = 0, next = 0; next < mesh.node_numbers.size(); ++old) {
    if (before[old] != mesh.node_numbers[next]) continue;
    now[old] = static_cast<int>(next++);
    n_components.push_back(matrices.n_components[old]);
  }
  matrices.n_components = std::move(n_components);
  const auto renumber = [&](int& dof) { dof = 6 * now[std::size_t(dof / 6)] + dof % 6; };
  for (auto* matrix : {&matrices.K, &matrices.M, &matrices.C, &matrices.H}) {
    for (MatrixEntry& entry : *matrix) {
      renumber(entry.row);
      renumber(entry.column);
    }
  }
}

}  // namespace

bool is_mass_of_points(const NodalMatrices& matrices)
{
  constexpr double digits = 1e-11;  // of a file of 14 digits
  bool is = true;
  for_blocks(matrices.M, [&](std::span<const int>, std::span<const MatrixEntry> entries) {
    double m = 0.0, largest = 0.0;
    int n_diagonal = 0;
    for (const auto& [row, column, value] : entries) {
      if (row % 6 >= 3 || column % 6 >= 3) is = false;
      largest = std::max(largest, std::abs(value));
      if (row % 6 != column % 6) continue;
      m += value / 3.0;
      ++n_diagonal;
    }
    if (n_diagonal != 3) is = false;
    for (const auto& [row, column, value] : entries)
      if (std::abs(value - (row % 6 == column % 6 ? m : 0.0)) > digits * largest) is = false;
  });
  return is;
}

void add_matrices(Mesh& mesh, const MeshOptions& options)
{
  const MatrixFiles& files = options.matrices.value();
  const MatrixReader reader(mesh, files.dofs);
  NodalMatrices matrices;
  const auto read = [&](const std::string& file) {
    std::vector<MatrixEntry> entries = one_triangle(mesh, file, reader.read(file));
    convert(entries, options);
    return entries;
  };
  matrices.K = read(files.stiffness);
  matrices.M = read(files.mass);
  if (files.damping) matrices.C = read(*files.damping);
  if (files.structural_damping) matrices.H = read(*files.structural_damping);
  matrices.n_components = components_by_rows(mesh, files, matrices);
  drop_other_nodes(mesh, matrices, options);
  check_rigid_motions(mesh, files.stiffness, matrices);
  mesh.notes.push_back(checked_mass(mesh, files.mass, matrices));
  mesh.matrices = std::make_shared<const NodalMatrices>(std::move(matrices));
}

}  // namespace chladni::mesh
