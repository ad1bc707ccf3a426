#include "cases/whole_body.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "cases/fe_model.hpp"
#include "cases/section_forces.hpp"
#include "cases/sector_model.hpp"
#include "common/eigen_every.hpp"
#include "reduce/cyclic/sector.hpp"
#include "reduce/reduced_system.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd, Eigen::seqN;
using mbs_export::ResultantModes;

namespace {

/// The motion of sector j, cos(j mu) x - sin(j mu) y, turned with it; `rows` vectors of three.
MatrixXd turned_motion(const cyclic::SectorMotion& motion, int order, int sector, int count)
{
  const double phase = 2.0 * std::numbers::pi * order * sector / count;
  MatrixXd rows = std::cos(phase) * motion.x - std::sin(phase) * motion.y;
  const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, count);
  for (Index i = 0; i < rows.rows(); i += 3)
    rows.middleRows<3>(i) = (R * rows.middleRows<3>(i)).eval();
  return rows;
}

/// Adds what the rows of a part move at the attachment nodes, which stand ring by ring, sector by
/// sector, behind the nodes on the axis.
void add_interface_motion(MatrixXd& motion, const SectorModel& model, const HarmonicPart& part,
                          const std::vector<Index>& places)
{
  const int count = model.mesh.sectors.count;
  const std::vector<SectorNode>& nodes = model.interface.nodes;
  std::vector<Index> first(model.dofs.rings.size() + 1, std::ssize(model.dofs.axis));
  for (std::size_t r = 0; r < model.dofs.rings.size(); ++r)
    first[r + 1] = first[r] + model.dofs.rings[r].n_nodes;
  for (int sector = 0; sector < count; ++sector) {
    const MatrixXd rows = turned_motion(part.interface, part.order, sector, count);
    std::vector<Index> seen(first.size(), 0);
    Index n_axis = 0;
    for (Index i = 0; i < std::ssize(nodes); ++i) {
      const int ring = nodes[std::size_t(i)].ring;
      if (ring < 0 && sector > 0) continue;
      const Index own = ring < 0 ? 0 : model.dofs.rings[std::size_t(ring)].n_nodes / count;
      const Index node =
          ring < 0 ? n_axis++ : first[std::size_t(ring)] + sector * own + seen[std::size_t(ring)]++;
      motion(Eigen::seqN(6 * node, 6), places) += rows.middleRows<6>(6 * i);
    }
  }
}

}  // namespace

std::vector<std::vector<Index>> places_of(const std::vector<HarmonicPart>& parts, Index n_masters)
{
  struct Mode {
    double omega;
    std::size_t part;
    Index row;
  };
  std::vector<Mode> modes;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (Index k = 0; k < parts[p].omega.size(); ++k) modes.push_back({parts[p].omega[k], p, k});
  std::ranges::stable_sort(modes, {}, &Mode::omega);
  std::vector<std::vector<Index>> places;
  for (const HarmonicPart& part : parts) {
    places.emplace_back(part.masters.begin(), part.masters.end());
    places.back().resize(part.masters.size() + std::size_t(part.omega.size()));
  }
  for (Index i = 0; i < std::ssize(modes); ++i) {
    const Mode& mode = modes[std::size_t(i)];
    places[mode.part][parts[mode.part].masters.size() + std::size_t(mode.row)] = n_masters + i;
  }
  return places;
}

mbs_export::ReducedSystem unfolded(mbs_export::ReducedSystem whole, const SectorModel& model,
                                   const std::vector<HarmonicPart>& parts,
                                   const std::vector<std::string>& fixed, double lambda_max)
{
  const Index n_m = whole.n_masters();
  const auto places = places_of(parts, n_m);
  const Index n = n_m + std::accumulate(parts.begin(), parts.end(), Index{0},
                                        [](Index sum, const HarmonicPart& part) {
                                          return sum + part.omega.size();
                                        });
  whole.K = whole.M = MatrixXd::Zero(n, n);
  if (!parts.empty() && parts.front().C.size() > 0) whole.C = MatrixXd::Zero(n, n);
  if (!parts.empty() && parts.front().H.size() > 0) whole.H = MatrixXd::Zero(n, n);
  whole.fixed_interface_frequencies = VectorXd(n - n_m);
  MatrixXd& motion = whole.ring_motion->displacements;
  motion = MatrixXd::Zero(6 * std::ssize(whole.attachment_nodes), n);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const HarmonicPart& part = parts[p];
    whole.K(places[p], places[p]) = part.K;
    whole.M(places[p], places[p]) = part.M;
    if (whole.C.size() > 0) whole.C(places[p], places[p]) = part.C;
    if (whole.H.size() > 0) whole.H(places[p], places[p]) = part.H;
    for (Index k = 0; k < part.omega.size(); ++k) {
      whole.fixed_interface_frequencies[places[p][part.masters.size() + std::size_t(k)] - n_m] =
          part.omega[k];
    }
    add_interface_motion(motion, model, part, places[p]);
  }
  whole.sector_harmonics = {.n_sectors = model.mesh.sectors.count,
                            .order = std::vector<int>(std::size_t(n), -1)};
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const Index i : places[p]) whole.sector_harmonics->order[std::size_t(i)] = parts[p].order;
  whole.certificate = whole_certificate(parts, fixed, lambda_max);
  return whole;
}

void add_picture(mbs_export::ReducedSystem& whole, const PictureNodes& chosen,
                 const SectorModel& model, std::vector<HarmonicPart>& parts)
{
  const int count = model.mesh.sectors.count;
  const auto n_nodes = std::ssize(chosen.nodes);
  mbs_export::Picture& picture = whole.picture;
  picture.positions.resize(n_nodes * count, 3);
  for (int sector = 0; sector < count; ++sector) {
    const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, count);
    for (Index i = 0; i < n_nodes; ++i) {
      picture.positions.row(sector * n_nodes + i) =
          (R * model.system.dofs.position(chosen.nodes[std::size_t(i)])).transpose();
    }
    for (std::array<int, 4> cell : chosen.cells) {
      for (int& corner : cell) corner += static_cast<int>(sector * n_nodes);
      picture.cells.push_back(cell);
    }
  }
  auto places = places_of(parts, whole.n_masters());
  whole.picture_of_sectors = {.n_sectors = count, .n_coordinates = whole.K.rows(), .harmonics = {}};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    cyclic::SectorMotion motion = std::exchange(parts[p].picture, {});
    whole.picture_of_sectors->harmonics.push_back({.order = parts[p].order,
                                                   .x = std::move(motion.x),
                                                   .y = std::move(motion.y),
                                                   .columns = std::move(places[p])});
  }
}

namespace {

/// The nodes of a ring all around, by angle; the first one is the first of the sector.
struct WholeRing {
  std::vector<int> nodes;  ///< indices in attachment_nodes
  std::vector<double> angles;
};

/// F of the masters of a ring.
void add_shapes(Eigen::MatrixXd& F, const WholeRing& whole, const cyclic::Ring& ring,
                const std::vector<mbs_export::MasterDof>& masters, int set)
{
  for (Eigen::Index column = 0; column < std::ssize(masters); ++column) {
    const auto& master = masters[static_cast<std::size_t>(column)];
    if (!master.harmonic || master.harmonic->set != set) continue;
    const int d = master.harmonic->order;
    const bool is_highest = 2 * d == ring.n_nodes;
    const double length = std::sqrt((d == 0 || is_highest ? 1.0 : 2.0) / ring.n_nodes);
    for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
      const double phase = d * (whole.angles[i] - (is_highest ? ring.first_angle : 0.0));
      const double value = length * (master.harmonic->is_sine ? std::sin(phase) : std::cos(phase));
      F.block<3, 1>(6 * whole.nodes[i] + 3 * (master.component / 3), column) =
          value * cyclic::turn(whole.angles[i]).col(master.component % 3);
    }
  }
}

int add_attachment(mbs_export::ReducedSystem& whole, const SectorModel& model,
                   const SectorNode& node, int sector)
{
  const std::int64_t n_numbers = model.mesh.node_numbers.back() + model.system.dofs.n_nodes();
  const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, model.mesh.sectors.count);
  whole.attachment_nodes.push_back(
      {.number = node_number(model.mesh, model.system.dofs, node.node) + sector * n_numbers,
       .position = R * model.system.dofs.position(node.node),
       .drilling_axis = R * node.drilling_axis});
  return static_cast<int>(whole.attachment_nodes.size()) - 1;
}

/// Adds the nodes of all sectors, sector by sector, and their set, by angle.
WholeRing add_whole_ring(mbs_export::ReducedSystem& whole, const SectorModel& model, int index)
{
  constexpr double digits = 1e-9;
  std::vector<std::pair<double, int>> by_angle;
  for (int sector = 0; sector < model.mesh.sectors.count; ++sector) {
    const double start = 2.0 * std::numbers::pi * sector / model.mesh.sectors.count;
    for (const SectorNode& node : model.interface.nodes) {
      if (node.ring != index) continue;
      by_angle.emplace_back(std::fmod(node.angle + start + digits, 2.0 * std::numbers::pi) - digits,
                            add_attachment(whole, model, node, sector));
    }
  }
  std::ranges::sort(by_angle);
  WholeRing ring;
  for (const auto& [angle, node] : by_angle) {
    ring.angles.push_back(angle);
    ring.nodes.push_back(node);
  }
  whole.sets.push_back(
      {.name = model.interface.ring_names[std::size_t(index)], .nodes = ring.nodes});
  return ring;
}

/// The wanted harmonics of the last set.
void add_ring_masters_of_sector(mbs_export::ReducedSystem& whole, const SectorModel& model,
                                int index)
{
  const cyclic::Ring& ring = model.dofs.rings[std::size_t(index)];
  const int set = static_cast<int>(whole.sets.size()) - 1;
  for (int k = 0; k < std::min(2 * ring.up_to + 1, ring.n_nodes); ++k) {
    for (const int c : model.dofs.components) {
      whole.masters.push_back(
          {.node = -1,
           .component = c,
           .harmonic = mbs_export::RingHarmonic{
               .set = set, .order = (k + 1) / 2, .is_sine = k > 0 && k % 2 == 0}});
    }
  }
}

/// F of all masters: the sets of nodes on the axis stand before those of rings.
Eigen::MatrixXd shapes_of(const mbs_export::ReducedSystem& whole, const SectorModel& model,
                          const std::vector<WholeRing>& rings, int n_axis)
{
  Eigen::MatrixXd F =
      Eigen::MatrixXd::Zero(6 * std::ssize(whole.attachment_nodes), std::ssize(whole.masters));
  for (Eigen::Index i = 0; i < std::ssize(whole.masters); ++i) {
    const auto& master = whole.masters[static_cast<std::size_t>(i)];
    if (master.node >= 0) F(6 * master.node + master.component, i) = 1.0;
  }
  for (std::size_t r = 0; r < rings.size(); ++r)
    add_shapes(F, rings[r], model.dofs.rings[r], whole.masters, n_axis + static_cast<int>(r));
  return F;
}

}  // namespace

mbs_export::ReducedSystem described_whole(const scene::Scene& scene, const SectorModel& model)
{
  mbs_export::ReducedSystem whole;
  whole.title = scene.title;
  int n_axis = 0;
  for (const SectorNode& node : model.interface.nodes) {
    if (node.ring >= 0) continue;
    const int place = add_attachment(whole, model, node, 0);
    whole.sets.push_back(
        {.name = model.interface.axis_names[std::size_t(n_axis++)], .nodes = {place}});
    for (const int c : model.system.dofs.components_of(node.node))
      whole.masters.push_back({.node = place, .component = c});
  }
  std::vector<WholeRing> rings;
  for (int r = 0; r < std::ssize(model.dofs.rings); ++r) {
    rings.push_back(add_whole_ring(whole, model, r));
    add_ring_masters_of_sector(whole, model, r);
  }
  const Eigen::MatrixXd F = shapes_of(whole, model, rings, n_axis);
  whole.ring_motion = {.shapes = F, .displacements = F};  // of the masters alone
  return whole;
}

int master_index(const mbs_export::ReducedSystem& whole, const SectorModel& model,
                 const cyclic::Master& master)
{
  const auto n_axis = static_cast<int>(model.dofs.axis.size());
  const auto found = std::ranges::find_if(whole.masters, [&](const mbs_export::MasterDof& dof) {
    if (dof.component != master.component) return false;
    if (master.ring < 0) return dof.node == master.place;
    return dof.harmonic && dof.harmonic->set == n_axis + master.ring &&
           dof.harmonic->order == (master.place + 1) / 2 &&
           dof.harmonic->is_sine == (master.place > 0 && master.place % 2 == 0);
  });
  return static_cast<int>(found - whole.masters.begin());
}

SectorSupport sector_support(const scene::Scene& scene, const SectorModel& model)
{
  struct Held {
    int ring, place;
    std::vector<int> components;
  };
  std::vector<Held> held;
  SectorSupport support;
  for (const std::string& fixed : scene.body.fixed) {
    const std::string::size_type dot = fixed.rfind('.');
    const auto place_in = [](const std::vector<std::string>& names, const std::string& name) {
      const auto it = std::ranges::find(names, name);
      return it == names.end() ? -1 : static_cast<int>(it - names.begin());
    };
    int component = -1;
    std::string name = fixed;
    const auto& [nodes, axis, rings] = model.interface;
    if (place_in(axis, name) < 0 && place_in(rings, name) < 0 && dot != std::string::npos) {
      name = fixed.substr(0, dot);
      component = place_in({"x", "y", "z", "rx", "ry", "rz"}, fixed.substr(dot + 1));
    }
    // A component across the axis is no component of a harmonic.
    if (component >= 0 && component % 3 != 2) continue;
    const std::vector<int> components =
        component >= 0 ? std::vector{component} : std::vector{0, 1, 2, 3, 4, 5};
    if (const int place = place_in(axis, name); place >= 0) {
      held.push_back({.ring = -1, .place = place, .components = components});
      support.names.push_back(fixed);
    }
    const int ring = place_in(rings, name);
    if (ring < 0) continue;
    const cyclic::Ring& wanted = model.dofs.rings[std::size_t(ring)];
    if (wanted.up_to < wanted.n_nodes / 2) continue;
    held.push_back({.ring = ring, .place = -1, .components = components});
    support.names.push_back(fixed);
  }
  support.is_held = [held](const cyclic::Master& master) {
    return std::ranges::any_of(held, [&](const Held& one) {
      return one.ring == master.ring && (one.place < 0 || one.place == master.place) &&
             std::ranges::find(one.components, master.component) != one.components.end();
    });
  };
  return support;
}

namespace {

/// The counts of all harmonics as one. Where no harmonic misses a mode, all together have as many
/// as the model has below the lowest of their limits.
/// @param lambda  of the model, all of a part
mbs_export::ModeCount whole_count(
    const std::vector<HarmonicPart>& parts, reduce::EigenvalueCount reduce::Certificate::*which,
    const std::function<std::vector<double>(const HarmonicPart&)>& lambda)
{
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  mbs_export::ModeCount sum;
  for (const HarmonicPart& part : parts) {
    const reduce::EigenvalueCount& count = part.certificate.*which;
    if (!(count.sigma > 0.0)) return {};
    least = std::min(least, count.sigma);
    largest = std::max(largest, count.sigma);
    sum.expected += count.expected;
    sum.found += count.found;
  }
  sum.up_to = std::sqrt(largest);
  if (sum.missing() > 0) return sum;
  sum = {.up_to = std::sqrt(least), .expected = 0, .found = 0};
  for (const HarmonicPart& part : parts) {
    const double sigma = (part.certificate.*which).sigma;
    const auto is_above = [&](double value) { return value >= least && value < sigma; };
    sum.found += (part.certificate.*which).found -
                 static_cast<int>(std::ranges::count_if(lambda(part), is_above));
  }
  sum.expected = sum.found;
  return sum;
}

/// Up to which eigenvalue no harmonic misses one; 0 where one was not counted.
double complete_up_to(const std::vector<HarmonicPart>& parts)
{
  double least = std::numeric_limits<double>::infinity();
  for (const HarmonicPart& part : parts) {
    const reduce::EigenvalueCount& complete = part.certificate.complete;
    least = std::min(least, complete.expected == complete.found ? complete.sigma : 0.0);
  }
  return least;
}

}  // namespace

void add_responses(mbs_export::Certificate& whole, const std::vector<HarmonicPart>& parts,
                   const std::vector<std::string>& loads)
{
  mbs_export::ResponseCheck check{.up_to = 0.0, .error = 0.0, .loads = loads};
  for (const HarmonicPart& part : parts) {
    const reduce::ResponseCertificate& responses = part.certificate.responses;
    if (!(responses.Omega > 0.0)) continue;
    check.up_to = responses.Omega;
    check.error = std::max(check.error, responses.error);
  }
  if (check.up_to > 0.0) whole.responses = check;
}

mbs_export::Certificate whole_certificate(const std::vector<HarmonicPart>& parts,
                                          const std::vector<std::string>& fixed, double lambda_max)
{
  struct Entry {
    double lambda, eta2, estimate, rounding, bound;
  };
  std::vector<Entry> entries;
  mbs_export::Certificate whole;
  whole.fixed = fixed;
  for (const HarmonicPart& part : parts) {
    const reduce::Certificate& c = part.certificate;
    whole.n_rigid += c.n_zero;
    whole.rigid_residual = std::max(whole.rigid_residual, c.zero_energy);
    whole.condition = std::max(whole.condition, c.condition);
    for (std::size_t i = 0; i < c.eta2.size(); ++i) {
      if (c.lambda[i] > lambda_max) continue;
      entries.push_back({c.lambda[i], c.eta2[i], c.estimates[i],
                         i < c.rounding.size() ? c.rounding[i] : 0.0,
                         i < c.bounds.size() ? c.bounds[i] : -1.0});
    }
  }
  std::ranges::stable_sort(entries, {}, &Entry::lambda);
  const auto column = [&](double Entry::*member, std::size_t n) {
    VectorXd values(static_cast<Index>(n));
    for (std::size_t i = 0; i < n; ++i) values[static_cast<Index>(i)] = entries[i].*member;
    return values;
  };
  const double complete = complete_up_to(parts);
  std::vector<double> lower;
  for (const Entry& e : entries) {
    if (e.bound < 0.0 || e.lambda > complete) break;
    lower.push_back(e.lambda / (1.0 + e.bound));
  }
  std::ranges::sort(lower);
  for (std::size_t i = 0; i < lower.size(); ++i)
    entries[i].bound = std::max(0.0, entries[i].lambda / lower[i] - 1.0);
  whole.frequencies = column(&Entry::lambda, entries.size()).cwiseSqrt();
  whole.eta2 = column(&Entry::eta2, entries.size());
  whole.estimates = column(&Entry::estimate, entries.size());
  whole.rounding = column(&Entry::rounding, entries.size());
  whole.bounds = column(&Entry::bound, lower.size());
  const auto of_model = [](const HarmonicPart& part) { return part.certificate.lambda; };
  const auto of_modes = [](const HarmonicPart& part) {
    const VectorXd lambda = part.omega.cwiseAbs2();
    return std::vector<double>(lambda.begin(), lambda.end());
  };
  whole.fixed_interface = whole_count(parts, &reduce::Certificate::fixed_interface, of_modes);
  whole.range = whole_count(parts, &reduce::Certificate::range, of_model);
  whole.complete = whole_count(parts, &reduce::Certificate::complete, of_model);
  return whole;
}

mbs_export::MassIntegrals sector_integrals(const SectorMass& mass,
                                           const std::vector<HarmonicPart>& parts,
                                           const MatrixXd& M, Index n_masters)
{
  const Index n = M.rows();
  const auto places = places_of(parts, n_masters);
  mbs_export::MassIntegrals whole = mass.of_rigid_body();
  whole.displacement = MatrixXd::Zero(3, n);
  whole.position_displacement = MatrixXd::Zero(9, n);
  auto& S = whole.products;
  for (MatrixXd& product : S) product = MatrixXd::Zero(n, n);
  for (std::size_t b = 0; b < parts.size(); ++b) {
    whole.displacement(every, places[b]) = parts[b].mass.displacement;
    whole.position_displacement(every, places[b]) = parts[b].mass.position_displacement;
    for (const MassCoupling& coupling : parts[b].mass.couplings) {
      const auto a = std::size_t(coupling.other);  // all orders are there
      for (const std::size_t i : {0, 1, 3, 4, 5}) {
        S[i](places[a], places[b]) = coupling.of_other[i];
        if (a != b) S[i](places[b], places[a]) = coupling.of_other_transposed[i];
      }
    }
  }
  for (const std::size_t i : {0, 1}) S[i] = 0.5 * (S[i] + S[i].transpose()).eval();
  S[2] = M - S[0] - S[1];  // M = S_xx + S_yy + S_zz
  return whole;
}

namespace {

/// Rows of the first sector: x of all coordinates of the whole body, then y.
RowsOf rows_of_phases(const std::vector<HarmonicPart>& parts,
                      const std::vector<std::vector<Index>>& places, Index n)
{
  return [&parts, &places, n](const std::vector<int>& dofs) -> MatrixXd {
    MatrixXd rows = MatrixXd::Zero(std::ssize(dofs), 2 * n);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      rows.leftCols(n)(every, places[p]) = parts[p].sector.x(dofs, every);
      rows.rightCols(n)(every, places[p]) = parts[p].sector.y(dofs, every);
    }
    return rows;
  };
}

std::int64_t largest_element(const mesh::Mesh& mesh)
{
  std::int64_t largest = 0;
  for (const mesh::ElementBlock& block : mesh.blocks)
    for (const std::int64_t number : block.numbers) largest = std::max(largest, number);
  return largest;
}

/// All around, sector by sector.
ResultantModes unfolded_forces(const ResultantModes& first, const SectorModel& model,
                               const std::vector<HarmonicPart>& parts,
                               const std::vector<std::vector<Index>>& places)
{
  const int count = model.dofs.count;
  const Index n = first.S.cols() / 2, n_points = first.positions.rows();
  const std::int64_t n_numbers = largest_element(model.mesh);
  ResultantModes whole{.name = first.name,
                       .kinds = first.kinds,
                       .units = first.units,
                       .elements = {},
                       .positions = ResultantModes::Rows(count * n_points, 3),
                       .axes = ResultantModes::Rows(count * n_points, 9),
                       .S = MatrixXd::Zero(count * first.S.rows(), n)};
  for (int sector = 0; sector < count; ++sector) {
    const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, count);
    for (const std::int64_t element : first.elements)
      whole.elements.push_back(element + sector * n_numbers);
    whole.positions.middleRows(sector * n_points, n_points) = first.positions * R.transpose();
    for (Index k = 0; k < 3; ++k) {
      whole.axes.block(sector * n_points, 3 * k, n_points, 3) =
          first.axes.middleCols<3>(3 * k) * R.transpose();
    }
    const auto rows = seqN(sector * first.S.rows(), first.S.rows());
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const double phase = 2.0 * std::numbers::pi * parts[p].order * sector / count;
      whole.S(rows, places[p]) = std::cos(phase) * first.S.leftCols(n)(every, places[p]) -
                                 std::sin(phase) * first.S.rightCols(n)(every, places[p]);
    }
  }
  return whole;
}

}  // namespace

std::vector<ResultantModes> sector_forces(const scene::Scene& scene, const SectorModel& model,
                                          const std::vector<HarmonicPart>& parts, Index n,
                                          Index n_masters)
{
  const auto places = places_of(parts, n_masters);
  std::vector<ResultantModes> forces = section_forces(
      scene.resultants, structure_of(scene), {.mesh = model.mesh, .dofs = model.system.dofs},
      rows_of_phases(parts, places, n));
  for (ResultantModes& of_group : forces)
    of_group = unfolded_forces(of_group, model, parts, places);
  return forces;
}

}  // namespace chladni::cases
