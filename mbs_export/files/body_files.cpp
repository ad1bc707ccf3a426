#include "mbs_export/files/body_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

#include "common/error.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export::file_parts {

using Eigen::Index;

void write_attachment(files::Writer& file, const std::vector<AttachmentNode>& nodes,
                      const std::vector<AttachmentSet>& sets)
{
  std::vector<std::int64_t> numbers;
  Eigen::MatrixXd positions(Index(nodes.size()), 3), axes(Index(nodes.size()), 3);
  for (const AttachmentNode& node : nodes) {
    positions.row(Index(numbers.size())) = node.position;
    axes.row(Index(numbers.size())) = node.drilling_axis;
    numbers.push_back(node.number);
  }
  std::vector<std::string> names;
  for (const AttachmentSet& set : sets) names.push_back(link_name(set.name));
  file.write("attachment/node_numbers", std::span<const std::int64_t>(numbers), "1");
  file.write("attachment/node_positions", positions, "m");
  if (!axes.isZero(0.0)) file.write("attachment/drilling_axes", axes, "1");
  file.write("attachment/set_names", names);
  for (const AttachmentSet& set : sets)
    file.write("attachment/sets/" + set.name, std::span<const int>(set.nodes), "1");
}

Attachment read_attachment(const files::Reader& file)
{
  Attachment attachment;
  const auto numbers = file.integers("attachment/node_numbers");
  const Index n = Index(numbers.size());
  const Eigen::MatrixXd positions = file.matrix("attachment/node_positions", {n, 3});
  const Eigen::MatrixXd axes = file.contains("attachment/drilling_axes")
                                   ? file.matrix("attachment/drilling_axes", {n, 3})
                                   : Eigen::MatrixXd::Zero(n, 3);
  for (Index i = 0; i < n; ++i) {
    attachment.nodes.push_back(
        {numbers[static_cast<std::size_t>(i)], positions.row(i), axes.row(i)});
  }
  std::set<std::string> names;
  for (const std::string& name : file.texts("attachment/set_names")) {
    if (!names.insert(name).second) file.fail("attachment/set_names", "names '" + name + "' twice");
    attachment.sets.push_back({name, read_indices(file, "attachment/sets/" + name, n)});
  }
  return attachment;
}

void write_picture(files::Writer& file, const Picture& picture)
{
  if (picture.positions.rows() == 0) return;
  files::IntegerMatrix cells(Index(picture.cells.size()), 4);
  for (Index i = 0; i < cells.rows(); ++i)
    for (Index k = 0; k < 4; ++k)
      cells(i, k) = picture.cells[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  file.write("picture/positions", picture.positions, "m");
  file.write("picture/cells", cells, "1");
  if (picture.transformation.size() > 0)
    file.write("picture/displacements", picture.transformation, "m per unit of each coordinate");
}

Picture read_surface(const files::Reader& file)
{
  if (!file.contains("picture")) return {};
  Picture picture;
  picture.positions = file.matrix("picture/positions", {files::any, 3});
  const Index n = picture.positions.rows();
  const files::IntegerMatrix cells = file.integer_matrix("picture/cells", {files::any, 4});
  if (cells.size() > 0 && (cells.minCoeff() < 0 || cells.maxCoeff() >= n))
    file.fail("picture/cells", fmt::format("has a corner outside 0 .. {}", n - 1));
  for (Index i = 0; i < cells.rows(); ++i) {
    picture.cells.push_back(
        {int(cells(i, 0)), int(cells(i, 1)), int(cells(i, 2)), int(cells(i, 3))});
  }
  return picture;
}

Picture read_picture(const files::Reader& file, Index n_columns)
{
  Picture picture = read_surface(file);
  if (file.contains("picture")) {
    picture.transformation =
        file.matrix("picture/displacements", {3 * picture.positions.rows(), n_columns});
  }
  return picture;
}

void write_sector_harmonics(files::Writer& file, const std::optional<SectorHarmonics>& harmonics)
{
  if (!harmonics) return;
  file.write("sectors/count", std::int64_t{harmonics->n_sectors}, "1");
  file.write("sectors/harmonics", std::span<const int>(harmonics->order), "1");
}

std::optional<SectorHarmonics> read_sector_harmonics(const files::Reader& file, Index n)
{
  if (!file.contains("sectors")) return std::nullopt;
  SectorHarmonics harmonics{.n_sectors = read_count(file, "sectors/count"), .order = {}};
  if (harmonics.n_sectors < 3)
    file.fail("sectors/count", fmt::format("is {}, expected 3 or more", harmonics.n_sectors));
  const int largest = harmonics.n_sectors / 2;
  for (const std::int64_t order : file.integers("sectors/harmonics", n)) {
    if (order < -1 || order > largest) {
      file.fail("sectors/harmonics",
                fmt::format("has the harmonic {}, expected -1 .. {}", order, largest));
    }
    harmonics.order.push_back(static_cast<int>(order));
  }
  return harmonics;
}

std::vector<int> read_indices(const files::Reader& file, const std::string& name, Index limit,
                              Index size)
{
  std::vector<int> indices;
  for (const std::int64_t i : file.integers(name, size)) {
    if (i < 0 || i >= limit)
      file.fail(name, fmt::format("has the index {}, expected 0 .. {}", i, limit - 1));
    indices.push_back(static_cast<int>(i));
  }
  return indices;
}

int read_count(const files::Reader& file, const std::string& name)
{
  const std::int64_t count = file.integer(name);
  if (count < 0 || count > std::numeric_limits<int>::max())
    file.fail(name, fmt::format("is {}, expected a count", count));
  return static_cast<int>(count);
}

const std::string& link_name(const std::string& name)
{
  if (name.empty() || name == "." || name.find('/') != std::string::npos) {
    throw Error(
        fmt::format("'{}' cannot name a set in a file; use letters, digits, _ and -", name));
  }
  return name;
}

}  // namespace chladni::mbs_export::file_parts

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr std::int64_t body_file_version = 1;
constexpr auto frame =
    "axes and origin of the mesh; displacements relative to the undeformed body, small rotations "
    "as "
    "vectors";

/// In the order of ModeKind.
constexpr std::array mode_kind_names{"rigid", "constrained", "interface"};

/// Something that each mode does at the nodes of a ring.
struct RingQuantity {
  const MatrixXd& values;  ///< [n x n_modes]
  std::string unit;
};

void write_quantity(files::Writer& file, const std::string& name, const VectorXd& angles,
                    const RingQuantity& quantity)
{
  const FourierCoefficients fourier = fourier_coefficients(angles, quantity.values);
  file.write(name, quantity.values, quantity.unit);
  file.write(name + "_cosine", fourier.cosine, quantity.unit);
  file.write(name + "_sine", fourier.sine, quantity.unit);
}

void write_ring(files::Writer& file, const ContactRing& ring)
{
  const std::string group = "rings/" + ring.name + "/";
  file.write(group + "radius", ring.radius, "m");
  file.write(group + "height", ring.height, "m");
  file.write(group + "nodes", std::span<const int>(ring.nodes), "1");
  file.write(group + "angles", ring.angles, "rad");
  write_quantity(file, group + "displacement", ring.angles, {ring.W, "m per unit of q"});
  write_quantity(file, group + "radial_slope", ring.angles, {ring.W_r, "rad per unit of q"});
  write_quantity(file, group + "circumferential_slope", ring.angles,
                 {ring.W_t, "rad per unit of q"});
}

/// Largest difference of a stored Fourier coefficient from that of the values, over the largest of
/// these: another order of summation changes 1e-15.
constexpr double fourier_tolerance = 1e-9;

/// The values at the nodes. The coefficients follow from them; a file in which they do not is
/// damaged.
MatrixXd read_quantity(const files::Reader& file, const std::string& name, const VectorXd& angles,
                       Index n_modes)
{
  const MatrixXd values = file.matrix(name, {angles.size(), n_modes});
  const FourierCoefficients expected = fourier_coefficients(angles, values);
  const double largest = values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0;
  for (const auto& [suffix, coefficients] :
       {std::pair{"_cosine", &expected.cosine}, std::pair{"_sine", &expected.sine}}) {
    if (!file.contains(name + suffix)) continue;
    const MatrixXd stored =
        file.matrix(name + suffix, {coefficients->rows(), coefficients->cols()});
    if (!((stored - *coefficients).cwiseAbs().array() <= fourier_tolerance * largest).all())
      file.fail(name + suffix, "is not the Fourier coefficients of the values at the nodes");
  }
  return values;
}

ContactRing read_ring(const files::Reader& file, const std::string& name, Index n_nodes,
                      Index n_modes)
{
  const std::string group = "rings/" + name + "/";
  ContactRing ring{.name = name,
                   .radius = file.real(group + "radius"),
                   .height = file.real(group + "height"),
                   .nodes = file_parts::read_indices(file, group + "nodes", n_nodes),
                   .angles = {},
                   .W = {},
                   .W_r = {},
                   .W_t = {}};
  const Index n = Index(ring.nodes.size());
  ring.angles = file.vector(group + "angles", n);
  ring.W = read_quantity(file, group + "displacement", ring.angles, n_modes);
  ring.W_r = read_quantity(file, group + "radial_slope", ring.angles, n_modes);
  ring.W_t = read_quantity(file, group + "circumferential_slope", ring.angles, n_modes);
  if (ring.radius <= 0.0) file.fail(group + "radius", "is not positive");
  if (n < 3 || !std::ranges::is_sorted(ring.angles))
    file.fail(group + "angles", "expected three or more angles in ascending order");
  return ring;
}

/// The order of the rows of `attachment_displacements`, as data for other readers.
struct RowOrder {
  std::vector<std::int64_t> nodes, components;
};

RowOrder row_order(Index n_nodes)
{
  RowOrder order;
  for (Index row = 0; row < 6 * n_nodes; ++row) {
    order.nodes.push_back(row / 6);
    order.components.push_back(row % 6);
  }
  return order;
}

void write_modes(files::Writer& file, const ModalBody& body)
{
  std::vector<std::string> kinds;
  for (const ModeKind kind : body.kinds)
    kinds.push_back(mode_kind_names[static_cast<std::size_t>(kind)]);
  file.write("modes/frequencies", body.omega, "rad/s");
  file.write("modes/kinds", kinds);
  if (body.C.size() > 0) file.write("modes/damping", body.C, "1/s");
  if (body.H.size() > 0) {
    file.write("modes/structural_damping", body.H, "1/s^2");
    file.write("modes/loss_factors", loss_factors(body), "1");
  }
  file.write("modes/attachment_displacements", body.attachment_modes, "m, rad per unit of q");
  const RowOrder order = row_order(Index(body.attachment_nodes.size()));
  file.write("modes/row_nodes", std::span<const std::int64_t>(order.nodes), "1");
  file.write("modes/row_components", std::span<const std::int64_t>(order.components), "1");
}

/// Files written before they said so have the same order.
void check_row_order(const files::Reader& file, Index n_nodes)
{
  const RowOrder order = row_order(n_nodes);
  const auto expect = [&](const std::string& name, const std::vector<std::int64_t>& values) {
    if (file.contains(name) && file.integers(name, 6 * n_nodes) != values)
      file.fail(name, "expected all six components of each node in turn");
  };
  expect("modes/row_nodes", order.nodes);
  expect("modes/row_components", order.components);
}

VectorXd read_frequencies(const files::Reader& file, const std::string& name)
{
  VectorXd omega = file.vector(name);
  if ((omega.size() > 0 && omega[0] < 0.0) || !std::ranges::is_sorted(omega))
    file.fail(name, "expected frequencies of zero or more in ascending order");
  return omega;
}

std::vector<ModeKind> read_mode_kinds(const files::Reader& file, Index n_modes)
{
  std::vector<ModeKind> kinds;
  for (const std::string& name : file.texts("modes/kinds")) {
    const auto found = std::ranges::find(mode_kind_names, name);
    if (found == mode_kind_names.end()) {
      file.fail("modes/kinds",
                fmt::format("has '{}', expected {}", name, fmt::join(mode_kind_names, ", ")));
    }
    kinds.push_back(static_cast<ModeKind>(found - mode_kind_names.begin()));
  }
  if (Index(kinds.size()) != n_modes)
    file.fail("modes/kinds", fmt::format("has {} values for {} modes", kinds.size(), n_modes));
  return kinds;
}

std::vector<ContactRing> read_rings(const files::Reader& file, Index n_nodes, Index n_modes)
{
  std::vector<ContactRing> rings;
  for (const std::string& name : file.texts("ring_names"))
    rings.push_back(read_ring(file, name, n_nodes, n_modes));
  return rings;
}

int read_n_rigid(const files::Reader& file, const VectorXd& free_frequencies)
{
  const int n_rigid = file_parts::read_count(file, "free_body/rigid_modes");
  if (n_rigid > free_frequencies.size())
    file.fail("free_body/rigid_modes", "counts more than there are free frequencies");
  return n_rigid;
}

}  // namespace

void write_body(const std::string& path, const ModalBody& body)
{
  files::Writer file(path);
  file.attribute("/", "format", body_format);
  file.attribute("/", "version", body_file_version);
  file.attribute("/", "title", body.title);
  file.attribute("/", "frame", frame);
  file_parts::write_attachment(file, body.attachment_nodes, body.sets);
  write_modes(file, body);
  file.write("fixed", body.fixed);
  std::vector<std::string> ring_names;
  for (const ContactRing& ring : body.rings) ring_names.push_back(ring.name);
  file.write("ring_names", ring_names);
  for (const ContactRing& ring : body.rings) write_ring(file, ring);
  file_parts::write_picture(file, body.picture);
  write_vtkhdf(file, body);
  file_parts::write_resultants(file, body.resultants);
  file_parts::write_mass_integrals(file, body.mass_integrals);
  file_parts::write_stiffening(file, body.stiffening);
  file.write("rigid_body/mass", body.mass, "kg");
  file.write("rigid_body/centre_of_mass", body.centre_of_mass, "m");
  file.write("rigid_body/inertia", body.inertia, "kg m^2");
  file.write("free_body/frequencies", body.free_frequencies, "rad/s");
  file.write("free_body/rigid_modes", std::int64_t{body.n_rigid}, "1");
  file.write("preparation/condition_Q_dd", body.condition_Q_dd, "1");
  file.write("preparation/free_rigid_modes", std::int64_t{body.n_free_rigid}, "1");
  files::write_fields(file, "preparation", body.preparation);
  write_if_any(file, "selection", body.selection);
  file_parts::write_sector_harmonics(file, body.sector_harmonics);
  write_if_any(file, "condensation", body.condensation);
  write_certificate(file, body.certificate);
  file_parts::write_provenance(file, body.provenance);
  file.commit();
}

ModalBody read_body(const std::string& path)
{
  return read_body(files::Reader(path));
}

ModalBody read_body(const files::Reader& file)
{
  file.expect_format(body_format, body_file_version);
  auto [nodes, sets] = file_parts::read_attachment(file);
  VectorXd omega = read_frequencies(file, "modes/frequencies");
  VectorXd free_frequencies = read_frequencies(file, "free_body/frequencies");
  const Index n_nodes = Index(nodes.size()), n = omega.size();
  const int n_rigid = read_n_rigid(file, free_frequencies);
  check_row_order(file, n_nodes);
  MatrixXd C;
  if (file.contains("modes/damping")) C = file.matrix("modes/damping", {n, n});
  MatrixXd H;
  if (file.contains("modes/structural_damping"))
    H = file.matrix("modes/structural_damping", {n, n});
  return {.title = file.text_attribute("/", "title"),
          .kinds = read_mode_kinds(file, n),
          .omega = std::move(omega),
          .C = std::move(C),
          .H = std::move(H),
          .attachment_nodes = std::move(nodes),
          .sets = std::move(sets),
          .fixed = file.texts("fixed"),
          .attachment_modes = file.matrix("modes/attachment_displacements", {6 * n_nodes, n}),
          .rings = read_rings(file, n_nodes, n),
          .picture = file_parts::read_picture(file, n),
          .mass = file.real("rigid_body/mass"),
          .centre_of_mass = file.vector("rigid_body/centre_of_mass", 3),
          .inertia = file.matrix("rigid_body/inertia", {3, 3}),
          .free_frequencies = std::move(free_frequencies),
          .n_rigid = n_rigid,
          .condition_Q_dd = file.real("preparation/condition_Q_dd"),
          .n_free_rigid = file_parts::read_count(file, "preparation/free_rigid_modes"),
          .preparation = files::read_fields<Preparation>(file, "preparation"),
          .resultants = file_parts::read_resultants(file, n),
          .mass_integrals = file_parts::read_mass_integrals(file, n),
          .stiffening = file_parts::read_stiffening(file, n),
          .selection = read_if_any<SelectionTable>(file, "selection"),
          .sector_harmonics = file_parts::read_sector_harmonics(file, n),
          .condensation = read_if_any<Condensation>(file, "condensation"),
          .certificate = read_certificate(file),
          .provenance = file_parts::read_provenance(file)};
}

namespace {

/// |A_ij - A_ji| beyond 1e-8 of sqrt(A_ii A_jj), the bound of a semidefinite A, is no round-off.
void require_symmetric(const files::Reader& file, const std::string& name, const MatrixXd& A)
{
  const Eigen::VectorXd scale = A.diagonal().cwiseAbs().cwiseSqrt();
  const double floor = A.size() > 0 ? 1e-14 * A.cwiseAbs().maxCoeff() : 0.0;
  for (Index j = 0; j < A.cols(); ++j)
    for (Index i = 0; i < j; ++i)
      if (std::abs(A(i, j) - A(j, i)) > 1e-8 * scale[i] * scale[j] + floor) {
        file.fail(name, fmt::format("is not symmetric: [{}, {}] = {} but [{}, {}] = {}", i, j,
                                    A(i, j), j, i, A(j, i)));
      }
}

MatrixXd read_symmetric(const files::Reader& file, const std::string& name, Index n)
{
  MatrixXd A = file.matrix(name, {n, n});
  require_symmetric(file, name, A);
  for (Index i = 0; i < n; ++i)
    if (A(i, i) < 0.0)
      file.fail(name, fmt::format("has the negative diagonal value {} in row {}", A(i, i), i));
  return A;
}

std::vector<MasterDof> read_node_masters(const files::Reader& file, Index n_nodes)
{
  const auto nodes = file_parts::read_indices(file, "masters/node", n_nodes);
  const auto components =
      file_parts::read_indices(file, "masters/component", 6, Index(nodes.size()));
  std::vector<MasterDof> masters;
  std::set<std::pair<int, int>> seen;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!seen.insert({nodes[i], components[i]}).second) {
      file.fail("masters",
                fmt::format("has component {} of node {} twice", components[i], nodes[i]));
    }
    masters.push_back({nodes[i], components[i]});
  }
  return masters;
}

}  // namespace

void write_reduced(const std::string& path, const ReducedSystem& reduced)
{
  files::Writer file(path);
  file.attribute("/", "format", reduced_format);
  file.attribute("/", "version", body_file_version);
  file.attribute("/", "title", reduced.title);
  file_parts::write_attachment(file, reduced.attachment_nodes, reduced.sets);
  std::vector<int> nodes, components;
  for (const MasterDof& dof : reduced.masters) {
    nodes.push_back(dof.node);
    components.push_back(dof.component);
  }
  file.write("masters/node", std::span<const int>(nodes), "1");
  file.write("masters/component", std::span<const int>(components), "1");
  write_ring_masters(file, reduced);
  file.write("matrices/stiffness", reduced.K, "N/m, N, N m; 1/s^2 of fixed-interface modes");
  file.write("matrices/mass", reduced.M, "kg, kg m, kg m^2; 1 of fixed-interface modes");
  if (reduced.C.size() > 0)
    file.write("matrices/damping", reduced.C, "N s/m, N s, N m s; 1/s of fixed-interface modes");
  if (reduced.H.size() > 0) {
    file.write("matrices/structural_damping", reduced.H,
               "N/m, N, N m; 1/s^2 of fixed-interface modes");
  }
  file.write("fixed_interface_frequencies", reduced.fixed_interface_frequencies, "rad/s");
  file_parts::write_sector_harmonics(file, reduced.sector_harmonics);
  write_certificate(file, reduced.certificate);
  file_parts::write_picture(file, reduced.picture);
  file_parts::write_sector_motions(file, reduced.picture_of_sectors);
  file_parts::write_resultants(file, reduced.resultants);
  file_parts::write_mass_integrals(file, reduced.mass_integrals);
  file_parts::write_stiffening(file, reduced.stiffening);
  file_parts::write_provenance(file, reduced.provenance);
  file.commit();
}

ReducedSystem read_reduced(const std::string& path)
{
  return read_reduced(files::Reader(path));
}

ReducedSystem read_reduced(const files::Reader& file)
{
  file.expect_format(reduced_format, body_file_version);
  auto [nodes, sets] = file_parts::read_attachment(file);
  auto masters = has_ring_masters(file) ? read_ring_masters(file, Index(nodes.size()), sets)
                                        : read_node_masters(file, Index(nodes.size()));
  Eigen::VectorXd frequencies = file.vector("fixed_interface_frequencies");
  if (frequencies.size() > 0 && frequencies.minCoeff() <= 0.0)
    file.fail("fixed_interface_frequencies", "has a value that is not positive");
  const Index n = Index(masters.size()) + frequencies.size();
  if (n == 0)
    file.fail("masters", "are none, and there is no fixed-interface mode: nothing to read");
  MatrixXd C;
  if (file.contains("matrices/damping")) C = file.matrix("matrices/damping", {n, n});
  MatrixXd H;
  if (file.contains("matrices/structural_damping"))
    H = read_symmetric(file, "matrices/structural_damping", n);
  Picture picture = file.contains("picture/sectors") ? file_parts::read_surface(file)
                                                     : file_parts::read_picture(file, n);
  auto picture_of_sectors = file_parts::read_sector_motions(file, picture.positions.rows(), n);
  auto ring_motion = read_ring_motion(file, {6 * Index(nodes.size()), Index(masters.size())}, n);
  return {.title = file.text_attribute("/", "title"),
          .attachment_nodes = std::move(nodes),
          .sets = std::move(sets),
          .masters = std::move(masters),
          .ring_motion = std::move(ring_motion),
          .K = read_symmetric(file, "matrices/stiffness", n),
          .M = read_symmetric(file, "matrices/mass", n),
          .C = std::move(C),
          .H = std::move(H),
          .fixed_interface_frequencies = std::move(frequencies),
          .picture = std::move(picture),
          .picture_of_sectors = std::move(picture_of_sectors),
          .sector_harmonics = file_parts::read_sector_harmonics(file, n),
          .certificate = read_certificate(file),
          .resultants = file_parts::read_resultants(file, n),
          .mass_integrals = file_parts::read_mass_integrals(file, n),
          .stiffening = file_parts::read_stiffening(file, n),
          .provenance = file_parts::read_provenance(file)};
}

namespace {

using Counts = std::array<ModeCount Certificate::*, 3>;
constexpr Counts counts = {&Certificate::fixed_interface, &Certificate::range,
                           &Certificate::complete};

void write_counts(files::Writer& file, const Certificate& certificate)
{
  Eigen::Vector3d up_to;
  std::vector<int> expected, found;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const ModeCount& count = certificate.*counts[i];
    up_to[Eigen::Index(i)] = count.up_to;
    expected.push_back(count.expected);
    found.push_back(count.found);
  }
  file.write("certificate/counts/up_to", up_to, "rad/s");
  file.write("certificate/counts/expected", std::span<const int>(expected), "1");
  file.write("certificate/counts/found", std::span<const int>(found), "1");
}

void read_counts(const files::Reader& file, Certificate& certificate)
{
  const auto n = Eigen::Index(counts.size());
  const Eigen::VectorXd up_to = file.vector("certificate/counts/up_to", n);
  constexpr Eigen::Index many = std::numeric_limits<int>::max();
  const auto expected = file_parts::read_indices(file, "certificate/counts/expected", many, n);
  const auto found = file_parts::read_indices(file, "certificate/counts/found", many, n);
  for (std::size_t i = 0; i < counts.size(); ++i)
    certificate.*counts[i] = {up_to[Eigen::Index(i)], expected[i], found[i]};
}

/// Of the first modes of the certificate.
void check_length(const files::Reader& file, const std::string& name, const Eigen::VectorXd& values,
                  const Certificate& certificate)
{
  if (values.size() <= certificate.eta2.size()) return;
  file.fail(name,
            fmt::format("has {} values for {} modes", values.size(), certificate.eta2.size()));
}

}  // namespace

Eigen::VectorXd estimated_errors(const Certificate& certificate)
{
  if (certificate.estimates.size() > 0) return certificate.estimates;
  return 0.5 * certificate.eta2;
}

void write_certificate(files::Writer& file, const Certificate& certificate)
{
  if (certificate.eta2.size() == 0) return;
  file.write("certificate/fixed", certificate.fixed);
  file.write("certificate/frequencies", certificate.frequencies, "rad/s");
  file.write("certificate/eta2", certificate.eta2, "1");
  if (certificate.rounding.size() > 0) {
    file.write("certificate/estimates", certificate.estimates, "1");
    file.write("certificate/rounding", certificate.rounding, "1");
  }
  if (certificate.mesh_errors.size() > 0) {
    file.write("certificate/mesh_errors", certificate.mesh_errors, "1");
    file.write("certificate/mesh_shape_errors", certificate.mesh_shape_errors, "1");
  }
  if (const OwnCompliances& own = certificate.mesh_compliances; !own.sets.empty()) {
    file.write("certificate/mesh_compliances/sets", own.sets);
    file.write("certificate/mesh_compliances/growth", own.growth, "m/N or rad/(N m)");
  }
  file.write("certificate/rigid_modes", std::int64_t{certificate.n_rigid}, "1");
  file.write("certificate/rigid_residual", certificate.rigid_residual, "1");
  if (certificate.condition > 0.0)
    file.write("certificate/condition_K_ss", certificate.condition, "1");
  write_if_any(file, "certificate/responses", certificate.responses);
  if (certificate.range.up_to == 0.0) return;
  file.write("certificate/bounds", certificate.bounds, "1");
  write_counts(file, certificate);
}

Certificate read_certificate(const files::Reader& file)
{
  if (!file.contains("certificate")) return {};
  Certificate certificate;
  certificate.fixed = file.texts("certificate/fixed");
  certificate.frequencies = file.vector("certificate/frequencies");
  certificate.eta2 = file.vector("certificate/eta2", certificate.frequencies.size());
  if (file.contains("certificate/rounding")) {
    certificate.estimates = file.vector("certificate/estimates", certificate.eta2.size());
    certificate.rounding = file.vector("certificate/rounding", certificate.eta2.size());
  }
  if (file.contains("certificate/mesh_errors")) {
    certificate.mesh_errors = file.vector("certificate/mesh_errors");
    check_length(file, "certificate/mesh_errors", certificate.mesh_errors, certificate);
    certificate.mesh_shape_errors =
        file.matrix("certificate/mesh_shape_errors", {6, certificate.mesh_errors.size()});
  }
  if (file.contains("certificate/mesh_compliances")) {
    OwnCompliances& own = certificate.mesh_compliances;
    own.sets = file.texts("certificate/mesh_compliances/sets");
    own.growth = file.matrix("certificate/mesh_compliances/growth", {3, std::ssize(own.sets)});
  }
  if (file.contains("certificate/rigid_modes")) {
    certificate.n_rigid = file_parts::read_count(file, "certificate/rigid_modes");
    certificate.rigid_residual = file.real("certificate/rigid_residual");
  }
  if (file.contains("certificate/condition_K_ss"))
    certificate.condition = file.real("certificate/condition_K_ss");
  certificate.responses = read_if_any<ResponseCheck>(file, "certificate/responses");
  if (!file.contains("certificate/counts")) return certificate;
  certificate.bounds = file.vector("certificate/bounds");
  check_length(file, "certificate/bounds", certificate.bounds, certificate);
  read_counts(file, certificate);
  return certificate;
}

}  // namespace chladni::mbs_export

namespace chladni::mbs_export::file_parts {

void write_provenance(files::Writer& file, const Provenance& provenance)
{
  files::write_fields(file, "provenance", provenance);
}

Provenance read_provenance(const files::Reader& file)
{
  return files::read_fields<Provenance>(file, "provenance");
}

Provenance read_provenance(const std::filesystem::path& file)
{
  return read_provenance(files::Reader(file.string()));
}

}  // namespace chladni::mbs_export::file_parts
