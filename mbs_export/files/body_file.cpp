#include "mbs_export/files/body_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "mbs_export/contact_rings.hpp"
#include "mbs_export/files/certificate_file.hpp"
#include "mbs_export/files/condensation_file.hpp"
#include "mbs_export/files/file_parts.hpp"
#include "mbs_export/files/provenance.hpp"
#include "mbs_export/files/selection_file.hpp"
#include "mbs_export/files/vtkhdf.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::int64_t version = 1;
constexpr auto frame =
    "axes and origin of the mesh; displacements relative to the undeformed body, small rotations "
    "as "
    "vectors";

/// In the order of ModeKind.
constexpr std::array kind_names{"rigid", "constrained", "interface"};

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
    kinds.push_back(kind_names[static_cast<std::size_t>(kind)]);
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

std::vector<ModeKind> read_kinds(const files::Reader& file, Index n_modes)
{
  std::vector<ModeKind> kinds;
  for (const std::string& name : file.texts("modes/kinds")) {
    const auto found = std::ranges::find(kind_names, name);
    if (found == kind_names.end()) {
      file.fail("modes/kinds",
                fmt::format("has '{}', expected {}", name, fmt::join(kind_names, ", ")));
    }
    kinds.push_back(static_cast<ModeKind>(found - kind_names.begin()));
  }
  if (Index(kinds.size()) != n_modes)
    file.fail("modes/kinds", fmt::format("has {} values for {} modes", kinds.size(), n_modes));
  return kinds;
}

void write_preparation(files::Writer& file, const ModalBody& body)
{
  const auto count = [&](const std::string& name, int n) {
    file.write("preparation/" + name, std::int64_t{n}, "1");
  };
  file.write("preparation/condition_Q_dd", body.condition_Q_dd, "1");
  if (body.preparation.condition_directions)
    file.write("preparation/condition_directions", *body.preparation.condition_directions, "1");
  file.write("preparation/rigid_residual", body.preparation.rigid_residual, "1");
  count("free_rigid_modes", body.n_free_rigid);
  count("constrained_modes", body.preparation.n_constrained_modes);
  count("partner_modes", body.preparation.n_partners);
  count("interface_modes_dropped", body.preparation.n_interface_dropped);
  count("massless_coordinates", body.preparation.n_massless);
}

Preparation read_preparation(const files::Reader& file)
{
  const auto count = [&](const std::string& name) {
    return file_parts::read_count(file, "preparation/" + name);
  };
  std::optional<double> directions;
  if (file.contains("preparation/condition_directions"))
    directions = file.real("preparation/condition_directions");
  return {.n_constrained_modes = count("constrained_modes"),
          .n_partners = count("partner_modes"),
          .n_interface_dropped = count("interface_modes_dropped"),
          .n_massless = count("massless_coordinates"),
          .rigid_residual = file.real("preparation/rigid_residual"),
          .condition_directions = directions};
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
  file.attribute("/", "version", version);
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
  write_preparation(file, body);
  if (body.selection) write_selection(file, *body.selection);
  file_parts::write_sector_harmonics(file, body.sector_harmonics);
  file_parts::write_condensation(file, body.condensation);
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
  file.expect_format(body_format, version);
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
          .kinds = read_kinds(file, n),
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
          .preparation = read_preparation(file),
          .resultants = file_parts::read_resultants(file, n),
          .mass_integrals = file_parts::read_mass_integrals(file, n),
          .stiffening = file_parts::read_stiffening(file, n),
          .selection = read_selection(file),
          .sector_harmonics = file_parts::read_sector_harmonics(file, n),
          .condensation = file_parts::read_condensation(file),
          .certificate = read_certificate(file),
          .provenance = file_parts::read_provenance(file)};
}

}  // namespace chladni::mbs_export
