#include "mbs_export/formats/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {

using Eigen::MatrixXd;

namespace {

/// Indices from 1, as MATLAB counts.
MatArray numbers(const std::vector<int>& indices)
{
  MatrixXd column(std::ssize(indices), 1);
  for (Eigen::Index i = 0; i < column.size(); ++i) column(i) = indices[std::size_t(i)] + 1;
  return mat_array(column);
}

MatArray scalar(double x)
{
  return mat_array(MatrixXd::Constant(1, 1, x));
}

std::vector<std::string> kinds_of(const ModalBody& body)
{
  std::vector<std::string> kinds;
  for (const ModeKind kind : body.kinds) {
    kinds.emplace_back(kind == ModeKind::rigid         ? "rigid"
                       : kind == ModeKind::constrained ? "constrained"
                                                       : "interface");
  }
  return kinds;
}

/// Node and component of each row of the modes at the attachment nodes.
MatrixXd rows_of(const ModalBody& body)
{
  MatrixXd rows(body.attachment_modes.rows(), 2);
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const Eigen::Index node = row / 6 + 1, component = row % 6 + 1;
    rows(row, 0) = double(node);
    rows(row, 1) = double(component);
  }
  return rows;
}

MatFields nodes_of(const ModalBody& body)
{
  const Eigen::Index n = std::ssize(body.attachment_nodes);
  MatrixXd positions(n, 3), node_numbers(n, 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const AttachmentNode& node = body.attachment_nodes[std::size_t(i)];
    node_numbers(i) = double(node.number);
    positions.row(i) = Eigen::Map<const Eigen::RowVector3d>(node.position.data());
  }
  return {{"node_numbers", mat_array(node_numbers)}, {"node_positions", mat_array(positions)}};
}

std::vector<MatFields> sets_of(const ModalBody& body)
{
  std::vector<MatFields> sets;
  for (const AttachmentSet& set : body.sets)
    sets.push_back({{"name", mat_array(set.name)}, {"nodes", numbers(set.nodes)}});
  return sets;
}

std::vector<MatFields> rings_of(const ModalBody& body)
{
  std::vector<MatFields> rings;
  for (const ContactRing& ring : body.rings) {
    rings.push_back({{"name", mat_array(ring.name)},
                     {"radius", scalar(ring.radius)},
                     {"height", scalar(ring.height)},
                     {"nodes", numbers(ring.nodes)},
                     {"angles", mat_array(MatrixXd(ring.angles))},
                     {"displacement", mat_array(ring.W)},
                     {"radial_slope", mat_array(ring.W_r)},
                     {"circumferential_slope", mat_array(ring.W_t)}});
  }
  return rings;
}

/// The matrix of each load.
std::vector<MatFields> stiffening_of(const Stiffening& stiffening)
{
  std::vector<MatFields> loads;
  for (std::size_t i = 0; i < stiffening.loads.size(); ++i) {
    loads.push_back(
        {{"load", mat_array(stiffening.loads[i])}, {"matrix", mat_array(stiffening.K[i])}});
  }
  return loads;
}

}  // namespace

std::string matlab_body(const ModalBody& body)
{
  MatFields fields{{"title", mat_array(body.title)},
                   {"frequencies", mat_array(MatrixXd(body.omega))},
                   {"kinds", mat_array(kinds_of(body))},
                   {"damping", mat_array(body.C)},
                   {"structural_damping", mat_array(body.H)},
                   {"attachment_displacements", mat_array(body.attachment_modes)},
                   {"row_nodes", mat_array(MatrixXd(rows_of(body).col(0)))},
                   {"row_components", mat_array(MatrixXd(rows_of(body).col(1)))},
                   {"sets", mat_array(sets_of(body))},
                   {"rings", mat_array(rings_of(body))},
                   {"fixed", mat_array(body.fixed)},
                   {"mass", scalar(body.mass)},
                   {"centre_of_mass", mat_array(MatrixXd(body.centre_of_mass))},
                   {"inertia", mat_array(MatrixXd(body.inertia))},
                   {"free_frequencies", mat_array(MatrixXd(body.free_frequencies))},
                   {"free_rigid_modes", scalar(body.n_rigid)}};
  for (auto& field : nodes_of(body)) fields.push_back(std::move(field));
  if (body.stiffening)
    fields.emplace_back("stiffening", mat_array(stiffening_of(*body.stiffening)));
  return mat_file("MATLAB 5.0 MAT-file, a modal body of Chladni in SI units", "body",
                  mat_array(std::vector<MatFields>{std::move(fields)}));
}

namespace {

/// Types of data and classes of arrays, tables 1-1 and 1-3 of the source.
enum class Type : std::int32_t {
  int8 = 1,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  real = 9,
  matrix = 14,
  utf16 = 17
};
enum class Class : std::uint32_t { cell = 1, structure = 2, characters = 4, real = 6 };

template <class T>
std::string bytes_of(std::span<const T> values)
{
  std::string bytes(values.size_bytes(), '\0');
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Type and number of bytes, the bytes, and zeros up to a multiple of 8.
std::string element(Type type, const std::string& bytes)
{
  if (bytes.size() > std::size_t(std::numeric_limits<std::int32_t>::max())) {
    throw Error(
        fmt::format("a MAT-file of version 5 holds arrays of up to 2 GiB, and one has {} bytes; "
                    "leave pictures out (reduce.pictures), or read the HDF5 file: h5read",
                    bytes.size()));
  }
  const std::int32_t tag[]{std::int32_t(type), std::int32_t(bytes.size())};
  return bytes_of<std::int32_t>(tag) + bytes + std::string((8 - bytes.size() % 8) % 8, '\0');
}

std::string flags_and_extents(Class kind, Eigen::Index rows, Eigen::Index cols)
{
  const std::uint32_t flags[]{std::uint32_t(kind), 0};
  const std::int32_t extents[]{std::int32_t(rows), std::int32_t(cols)};
  return element(Type::uint32, bytes_of<std::uint32_t>(flags)) +
         element(Type::int32, bytes_of<std::int32_t>(extents));
}

std::string named(const std::string& name, const MatArray& x)
{
  return element(Type::matrix, x.before_name + element(Type::int8, name) + x.after_name);
}

/// How many bytes of UTF-8 the character has that begins so; 1 for what begins none.
std::size_t length_of(unsigned char first)
{
  if (first >= 0xF0) return 4;
  if (first >= 0xE0) return 3;
  return first >= 0xC0 ? 2 : 1;
}

/// A unit for each character; for those beyond U+FFFF that of an unknown one.
std::vector<std::uint16_t> utf16_of(const std::string& text)
{
  std::vector<std::uint16_t> units;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t n = std::min(length_of(first), text.size() - i);
    std::uint32_t code = n == 1 ? first : first & (0x7FU >> n);
    for (std::size_t k = 1; k < n; ++k)
      code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    i += n;
    // scipy takes pairs of units for two characters, and then refuses the file.
    constexpr std::uint32_t unknown = 0xFFFD;
    units.push_back(std::uint16_t(code > 0xFFFF ? unknown : code));
  }
  return units;
}

}  // namespace

MatArray mat_array(const Eigen::MatrixXd& x)
{
  return {.before_name = flags_and_extents(Class::real, x.rows(), x.cols()),
          .after_name = element(
              Type::real, bytes_of(std::span<const double>(x.data(), std::size_t(x.size()))))};
}

MatArray mat_array(const std::string& text)
{
  const std::vector<std::uint16_t> units = utf16_of(text);
  // What MATLAB itself writes is uint16, of which scipy takes one byte.
  const bool is_ascii = std::ranges::all_of(units, [](std::uint16_t unit) { return unit < 0x80; });
  return {
      .before_name = flags_and_extents(Class::characters, units.empty() ? 0 : 1, std::ssize(units)),
      .after_name = element(is_ascii ? Type::uint16 : Type::utf16, bytes_of<std::uint16_t>(units))};
}

MatArray mat_array(const std::vector<std::string>& texts)
{
  MatArray cells{.before_name = flags_and_extents(Class::cell, std::ssize(texts), 1),
                 .after_name = {}};
  for (const std::string& text : texts) cells.after_name += named("", mat_array(text));
  return cells;
}

MatArray mat_array(const std::vector<MatFields>& elements)
{
  constexpr std::int32_t name_size = 32;
  const std::int32_t size_of_names[]{4 << 16 | std::int32_t(Type::int32), name_size};
  MatArray structs{.before_name = flags_and_extents(Class::structure, 1, std::ssize(elements)),
                   .after_name = bytes_of<std::int32_t>(size_of_names)};
  std::string names;
  if (!elements.empty())
    for (const auto& [name, value] : elements.front())
      names += name + std::string(name_size - name.size(), '\0');
  structs.after_name += element(Type::int8, names);
  for (const MatFields& fields : elements)
    for (const auto& [name, value] : fields) structs.after_name += named("", value);
  return structs;
}

std::string mat_file(const std::string& description, const std::string& name, const MatArray& x)
{
  std::string header = description.substr(0, 116);
  header.resize(116, ' ');
  header.resize(124, '\0');  // no data of subsystems
  const std::uint16_t version_and_order[]{0x0100, 'M' << 8 | 'I'};
  return header + bytes_of<std::uint16_t>(version_and_order) + named(name, x);
}

}  // namespace chladni::mbs_export::formats
