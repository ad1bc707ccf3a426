#include "squeal/brake/disc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/mass_integrals.hpp"
#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/mode_parts.hpp"
#include "squeal/brake/rotation_generator.hpp"

namespace chladni::squeal {
namespace {

using mbs_export::ModalBody;
using std::numbers::pi;

/// int rho phi_i . (e_z x phi_j) dV when the body has the integrals, else zero.
Eigen::MatrixXd coriolis_of(const ModalBody& body)
{
  if (!body.mass_integrals) return Eigen::MatrixXd::Zero(body.n_modes(), body.n_modes());
  return 0.5 * mbs_export::gyroscopic_matrix(*body.mass_integrals, Eigen::Vector3d::UnitZ());
}

/// Of the constrained modes those of the body's certificate that have their frequencies, in order;
/// modes beyond it, and interface modes, which are no modes of the disc, have none.
Eigen::VectorXd errors_of(const ModalBody& body, const Eigen::VectorXd& certified)
{
  constexpr double same = 1e-6;
  if (certified.size() == 0 || body.certificate.fixed != body.fixed) return {};
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(body.n_modes());
  Eigen::Index next = 0;
  for (Eigen::Index i = 0; i < body.n_modes(); ++i) {
    if (body.kinds[static_cast<std::size_t>(i)] != mbs_export::ModeKind::constrained) continue;
    const auto& omega = body.certificate.frequencies;
    while (next < certified.size() && omega[next] < (1.0 - same) * body.omega[i]) ++next;
    if (next == certified.size()) break;
    if (omega[next] <= (1.0 + same) * body.omega[i]) errors[i] = certified[next++];
  }
  return errors;
}

/// [6 x n_modes]
Eigen::MatrixXd shape_errors_of(const ModalBody& body)
{
  const Eigen::MatrixXd& certified = body.certificate.mesh_shape_errors;
  Eigen::MatrixXd errors(certified.rows(), certified.rows() > 0 ? body.n_modes() : 0);
  for (Eigen::Index row = 0; row < errors.rows(); ++row) {
    const Eigen::VectorXd of_modes = errors_of(body, certified.row(row));
    if (of_modes.size() == 0) return {};
    errors.row(row) = of_modes;
  }
  return errors;
}

/// Whether a static force at a ring displaces it as it does the reduced system: by modes for
/// responses, or by all modes.
bool has_static_compliance(const ModalBody& body)
{
  using mbs_export::ModeKind;
  return std::ranges::count(body.kinds, ModeKind::interface) > 0 ||
         std::ranges::count(body.kinds, ModeKind::constrained) >=
             body.preparation.n_constrained_modes;
}

/// [3 x n_rings]
Eigen::MatrixXd mesh_compliances_of(const ModalBody& body, const std::vector<DiscRing>& rings)
{
  const mbs_export::OwnCompliances& own = body.certificate.mesh_compliances;
  if (!has_static_compliance(body) || body.certificate.fixed != body.fixed) return {};
  Eigen::MatrixXd growth(3, std::ssize(rings));
  for (Eigen::Index i = 0; i < growth.cols(); ++i) {
    const auto at = std::ranges::find(own.sets, rings[static_cast<std::size_t>(i)].name);
    if (at == own.sets.end()) return {};
    growth.col(i) = own.growth.col(at - own.sets.begin());
  }
  return growth;
}

ModeErrors mode_errors(const ModalBody& body, const std::vector<DiscRing>& rings)
{
  const Eigen::VectorXd& certified = body.certificate.frequencies;
  ModeErrors errors{.mesh = errors_of(body, body.certificate.mesh_errors),
                    .mesh_shapes = shape_errors_of(body),
                    .reduction = errors_of(body, mbs_export::estimated_errors(body.certificate)),
                    .responses = {},
                    .mesh_compliances = mesh_compliances_of(body, rings),
                    .n_harmonics = std::ssize(ring_harmonics(rings).c),
                    .range = certified.size() > 0 ? certified[certified.size() - 1] : 0.0};
  if (body.selection && !body.selection->with_interface_modes.empty()) {
    const mbs_export::SelectionTable& table = *body.selection;
    const double of_steps =
        std::min(table.with_interface_modes.back().error,
                 table.modes_only.empty() ? table.error : table.modes_only.back().error);
    errors.responses = of_steps + table.of_reduction.value_or(0.0);
  }
  return errors;
}

Disc disc_of_all_modes(const ModalBody& body, const RingChoice& choice)
{
  std::vector<DiscRing> rings;
  for (const std::string& name : choice.names) rings.push_back(disc_ring(body, name, choice));
  std::vector<int> numbers(static_cast<std::size_t>(body.n_modes()));
  std::iota(numbers.begin(), numbers.end(), 1);
  const Eigen::MatrixXd C =
      body.C.size() > 0 ? body.C : Eigen::MatrixXd::Zero(body.n_modes(), body.n_modes());
  return {.rings = rings,
          .mode_numbers = numbers,
          .omega = body.omega,
          .C = C,
          .G = coriolis_of(body),
          .errors = mode_errors(body, rings)};
}

Harmonics columns(const Harmonics& f, const std::vector<int>& modes)
{
  if (f.cosine.size() == 0) return {};
  return {f.cosine(every, modes), f.sine(every, modes)};
}

Eigen::VectorXd part(const Eigen::VectorXd& values, const std::vector<int>& modes)
{
  if (values.size() == 0) return {};
  return values(modes);
}

Eigen::MatrixXd columns_of(const Eigen::MatrixXd& values, const std::vector<int>& modes)
{
  if (values.size() == 0) return {};
  return values(every, modes);
}

Disc with_modes(const Disc& all, const std::vector<int>& modes)
{
  std::vector<int> numbers;
  numbers.reserve(modes.size());
  for (const int i : modes) numbers.push_back(all.mode_numbers[static_cast<std::size_t>(i)]);
  std::vector<DiscRing> rings;
  for (const DiscRing& ring : all.rings) {
    rings.push_back({ring.name, ring.radius, columns(ring.W, modes), columns(ring.W_r, modes),
                     columns(ring.W_t, modes), ring.n_nodes, columns(ring.V_r, modes),
                     columns(ring.V_t, modes), ring.height});
  }
  return {.rings = rings,
          .mode_numbers = numbers,
          .omega = all.omega(modes),
          .C = all.C(modes, modes),
          .G = all.G(modes, modes),
          .errors = {.mesh = part(all.errors.mesh, modes),
                     .mesh_shapes = columns_of(all.errors.mesh_shapes, modes),
                     .reduction = part(all.errors.reduction, modes),
                     .responses = all.errors.responses,
                     .mesh_compliances = all.errors.mesh_compliances,
                     .n_harmonics = all.errors.n_harmonics,
                     .range = all.errors.range}};
}

/// Of some modes those that the others leave without a partner, or with one that is too different.
std::vector<int> unpaired(const Disc& all, const std::vector<int>& modes)
{
  const Eigen::VectorXd shares = unpaired_shares(with_modes(all, modes));
  std::vector<int> found;
  for (Eigen::Index k = 0; k < shares.size(); ++k)
    if (shares[k] >= impurity_limit * impurity_limit)
      found.push_back(modes[static_cast<std::size_t>(k)]);
  return found;
}

/// Whether these modes are those of an axisymmetric disc, whatever their damping.
bool are_axisymmetric(const Disc& all, const std::vector<int>& modes)
{
  Disc disc = with_modes(all, modes);
  disc.C.setZero();
  return !asymmetry(disc);
}

/// Modes beyond `end` follow the pads without inertia where the disc would not be axisymmetric with
/// them, and is without: a reduction has there what its shapes make of others. Those whose partners
/// are missing do first.
void let_unpaired_follow(const Disc& all, double end, ModeParts& parts)
{
  std::vector<int> within, beyond;
  for (const int mode : parts.dynamic) (all.omega[mode] <= end ? within : beyond).push_back(mode);
  if (within.empty() || beyond.empty() || are_axisymmetric(all, parts.dynamic) ||
      !are_axisymmetric(all, within))
    return;
  std::vector<int> alone = unpaired(all, parts.dynamic), paired;
  std::erase_if(alone, [&](int mode) { return all.omega[mode] <= end; });
  std::ranges::set_difference(parts.dynamic, alone, std::back_inserter(paired));
  const bool is_enough = are_axisymmetric(all, paired);
  parts.alone = is_enough ? std::move(alone) : std::move(beyond);
  parts.dynamic = is_enough ? std::move(paired) : std::move(within);
  parts.quasi_static.insert(parts.quasi_static.end(), parts.alone.begin(), parts.alone.end());
  std::ranges::sort(parts.quasi_static);
}

}  // namespace

std::vector<int> nodal_diameters(const Disc& disc)
{
  const Eigen::MatrixXd motion = ring_harmonics(disc.rings).squares_by_harmonic();
  std::vector<int> n;
  for (Eigen::Index i = 0; i < motion.cols(); ++i) {
    Eigen::Index k = 0;
    motion.col(i).maxCoeff(&k);
    n.push_back(static_cast<int>(k));
  }
  return n;
}

Disc disc_on_ring(const ModalBody& body, const std::string& ring, const ModeChoice& modes)
{
  return make_disc(body, RingChoice{.names = {ring}}, modes);
}

std::vector<std::string> notes_of(const Disc& disc)
{
  std::vector<std::string> notes;
  if (!disc.compliance.empty()) {
    notes.push_back(fmt::format(
        "{} of the body's modes, from {:.5g} Hz on, follow the pads without inertia{}",
        disc.compliance.mode_numbers.size(), disc.compliance.lowest_omega / (2.0 * pi),
        disc.compliance.mode_numbers.size() > disc.alone.size() ? " (quasi_static_above_Hz)" : ""));
  }
  if (!disc.alone.empty()) {
    notes.push_back(fmt::format(
        "{} of these, beyond the frequencies that the reduction knows the errors of, lack the "
        "partners that modes of an axisymmetric disc have: they are none of its modes",
        disc.alone.size()));
  }
  if (!disc.still.empty()) {
    notes.push_back(fmt::format(
        "{} of the body's modes do not move the ring{} and take no part: {}", disc.still.size(),
        disc.rings.front().V_r.cosine.size() > 0 ? "" : " along the axis",
        fmt::join(disc.still, ", ")));
  }
  if (!disc.alternating.empty()) {
    notes.push_back(
        fmt::format("{} of the body's modes, whose sign changes from node to node of the ring, "
                    "take no part: {}; "
                    "a ring of more nodes would show both modes of such a pair",
                    disc.alternating.size(), fmt::join(disc.alternating, ", ")));
  }
  return notes;
}

RingChoice ring_choice(const SquealOptions& options)
{
  RingChoice choice{.names = {options.ring},
                    .in_plane = options.planes.has_value(),
                    .slopes_from = options.slopes_from};
  const auto add = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names)
      if (!name.empty() && std::ranges::find(choice.names, name) == choice.names.end())
        choice.names.push_back(name);
  };
  if (options.planes) add({options.planes->opposite_ring});
  for (const PadPair& pad : options.pads) {
    if (!pad.grid) continue;
    add(pad.grid->rings);
    add(pad.grid->opposite_rings);
  }
  return choice;
}

std::vector<RingPlace> ring_places(const Disc& disc)
{
  std::vector<RingPlace> places;
  for (const DiscRing& ring : disc.rings) places.push_back({ring.name, ring.radius, ring.height});
  return places;
}

Disc make_disc(const ModalBody& body, const RingChoice& rings, const ModeChoice& choice)
{
  const Disc all = disc_of_all_modes(body, rings);
  if (!(ring_harmonics(all.rings).squares_by_harmonic().maxCoeff() > 0.0)) {
    throw Error(
        fmt::format("ring '{}': no mode of the body moves it{}; it is held, or the body has no "
                    "bending modes",
                    fmt::join(rings.names, "', '"), rings.in_plane ? "" : " along the axis"));
  }
  ModeParts parts = mode_parts(all, body, choice);
  const bool has_choice = choice.list || choice.nodal_diameters;
  if (!has_choice) let_unpaired_follow(all, end_of_known(all, body), parts);
  Disc disc = with_modes(all, parts.dynamic);
  if (has_choice) disc.errors.mesh_compliances = {};  // of what is left out
  disc.range = range_of(body);
  if (!parts.quasi_static.empty())
    disc.compliance = ring_compliance(with_modes(all, parts.quasi_static));
  disc.still = parts.still;
  disc.alternating = parts.alternating;
  for (const int i : parts.alone) disc.alone.push_back(i + 1);
  const std::vector<ModeFigure> figures = mode_figures(body, nodal_diameters(all));
  for (const int i : parts.dynamic) disc.figures.push_back(figures[static_cast<std::size_t>(i)]);
  return disc;
}

Shapes shapes_at(const Disc& disc, double theta)
{
  return shapes_at(disc.rings.front(), theta);
}

}  // namespace chladni::squeal
