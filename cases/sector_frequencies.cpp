#include "cases/sector_frequencies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "cases/fe_model.hpp"
#include "cases/mesh_errors.hpp"
#include "cases/possible_sector.hpp"
#include "cases/ranks.hpp"
#include "common/all_ranks.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mesh/sectors.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/drilling.hpp"
#include "reduce/cyclic/harmonic_model.hpp"
#include "reduce/cyclic/sector.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// @param refined  of the whole body or of one sector, as `of` is
SupportedSector sector_on(const scene::Scene& scene, mesh::Mesh refined, int count,
                          const mesh::Mesh& of)
{
  if (of.sectors.count == 1)
    return supported_sector(scene, sector_model(scene, mesh::one_sector(refined, count)));
  mesh::find_sector_edges(refined, count);
  return supported_sector(scene, sector_model(scene, std::move(refined)));
}

/// Root sums of squares over all sectors of the motion of some nodes of one, as `differences` wants
/// them.
/// @return [6 x k]
MatrixXd mode_sizes_at(const mesh::Mesh& mesh, const std::vector<int>& nodes,
                       const ModesOfHarmonic& modes)
{
  MatrixXd squares = MatrixXd::Zero(6, modes.omega.size());
  for (const int node : nodes) {
    const auto& position = mesh.positions[std::size_t(node)];
    const Eigen::Matrix3d R = cyclic::turn(-std::atan2(position[1], position[0]));
    for (const int kind : {0, 3})
      for (const MatrixXd* part : {&modes.x, &modes.y})
        squares.middleRows<3>(kind) += (R * part->middleRows<3>(6 * node + kind)).cwiseAbs2();
  }
  return (modes.weight * squares).cwiseSqrt();
}

/// The shares of modes of one mesh in those of another: by displacements of nodes that both have,
/// whatever their phase, and by frequencies, which tell modes apart that these nodes do not.
MatrixXd shares_of(const SupportedSector& one, const ModesOfHarmonic& known,
                   const SupportedSector& other, const ModesOfHarmonic& found)
{
  constexpr double apart = 0.05;  // of the frequency
  std::map<std::int64_t, Index> with_number;
  for (int i = 0; i < other.model.mesh.n_nodes(); ++i)
    with_number[other.model.mesh.node_numbers[std::size_t(i)]] = i;
  std::vector<Index> rows, other_rows;
  for (Index i = 0; i < one.model.mesh.n_nodes(); ++i) {
    const auto it = with_number.find(one.model.mesh.node_numbers[std::size_t(i)]);
    if (it == with_number.end()) continue;
    for (Index c = 0; c < 3; ++c) {
      rows.push_back(6 * i + c);
      other_rows.push_back(6 * it->second + c);
    }
  }
  using Complex = std::complex<double>;
  const auto field = [](const ModesOfHarmonic& modes, const std::vector<Index>& at) {
    Eigen::MatrixXcd u = modes.x(at, every).cast<Complex>();
    u.imag() = modes.y(at, every);
    return (u * u.colwise().norm().cwiseMax(1e-300).cwiseInverse().asDiagonal()).eval();
  };
  MatrixXd shares =
      MatrixXd::Zero(known.omega.size(), std::max(known.omega.size(), found.omega.size()));
  shares.leftCols(found.omega.size()) =
      (field(known, rows).adjoint() * field(found, other_rows)).cwiseAbs2();
  for (Index i = 0; i < known.omega.size(); ++i) {
    for (Index j = 0; j < found.omega.size(); ++j) {
      const double distance = std::log(found.omega[j] / known.omega[i]) / apart;
      shares(i, j) = (shares(i, j) + 1e-9) / (1.0 + distance * distance);
    }
  }
  return shares;
}

/// Names of the interface, and the mesh whose nodes count.
struct InterfaceOf {
  const mesh::Mesh& given;
  const std::vector<std::string>& names;

  /// Those nodes of a sector that the mesh has too, each of the body once.
  std::vector<int> nodes(const mesh::Mesh& sector) const
  {
    std::set<int> next;  // of the sector further on
    for (const auto& [low, high] : sector.sectors.pairs) next.insert(high);
    std::vector<int> common;
    for (const mesh::Group& group : given.groups) {
      if (std::ranges::find(names, group.name) == names.end()) continue;
      std::set<std::int64_t> numbers;
      for (const int node : group.nodes) numbers.insert(given.node_numbers[std::size_t(node)]);
      for (const int node : mesh::find_group(sector, group.name).nodes)
        if (!next.contains(node) && numbers.contains(sector.node_numbers[std::size_t(node)]))
          common.push_back(node);
    }
    return common;
  }
};

/// The modes of this rank's harmonics on the mesh whose errors are wanted.
struct KnownHarmonics {
  const SupportedSector& sector;
  const std::vector<ModesOfHarmonic>& modes;
};

/// The same modes of a refined sector, in the order of frequencies_of(known).
/// @param solve  for the lowest modes of a harmonic there, more than so many
RefinedModes refined_modes(const KnownHarmonics& known, const SupportedSector& other,
                           const std::function<ModesOfHarmonic(int order, Index n)>& solve,
                           const InterfaceOf& interface)
{
  constexpr Index before = 4, n_numbers = before + 12;
  const mesh::Mesh &mesh = known.sector.model.mesh, &other_mesh = other.model.mesh;
  const std::vector<int> nodes = interface.nodes(mesh), others = interface.nodes(other_mesh);
  const std::vector<double> own = on_all_ranks(PETSC_COMM_WORLD, [&] {
    std::vector<double> lines;
    for (const ModesOfHarmonic& modes : known.modes) {
      const Index k = modes.omega.size();
      if (k == 0) continue;
      const ModesOfHarmonic found = solve(modes.order, k);
      const std::vector<Index> mode_of = by_shapes(shares_of(known.sector, modes, other, found));
      const MatrixXd here = mode_sizes_at(mesh, nodes, modes),
                     there = mode_sizes_at(other_mesh, others, found);
      for (Index i = 0; i < k; ++i) {
        const Index j = mode_of[std::size_t(i)];
        const bool is_there = j < found.omega.size();
        lines.insert(lines.end(), {modes.omega[i], double(modes.multiplicity), double(modes.order),
                                   is_there ? found.omega[j] : 0.0});
        const VectorXd sizes = here.col(i), of_other = is_there ? there.col(j) : here.col(i);
        lines.insert(lines.end(), sizes.begin(), sizes.end());
        lines.insert(lines.end(), of_other.begin(), of_other.end());
      }
    }
    return lines;
  });
  const MatrixXd lines = by_frequency(own, n_numbers);
  return {.omega = lines.col(3),
          .shapes = differences(lines.middleCols(before, 6).transpose(),
                                lines.middleCols(before + 6, 6).transpose())};
}

/// By how much a halving of the elements lowers the frequencies, in the order of
/// frequencies_of(known): each sector takes its forces, and nodes of its cut edges half of theirs.
VectorXd lowering_of(const KnownHarmonics& known, const PointForces& forces)
{
  const mesh::Mesh& mesh = known.sector.model.mesh;
  const double angle = 2.0 * std::numbers::pi / mesh.sectors.count;
  const Eigen::Matrix3d turn = cyclic::turn(angle);
  const auto share = [&](MatrixXd& x, MatrixXd& y, int order) {
    using Complex = std::complex<double>;
    const Complex phase = std::polar(1.0, order * angle);
    for (const auto& [low, high] : mesh.sectors.pairs) {
      for (const Index part : {0, 3}) {
        const Index at = 6 * Index(low) + part, next = 6 * Index(high) + part;
        Eigen::MatrixXcd here = x.middleRows<3>(at).cast<Complex>();
        here.imag() = y.middleRows<3>(at);
        Eigen::MatrixXcd there = x.middleRows<3>(next).cast<Complex>();
        there.imag() = y.middleRows<3>(next);
        here = 0.5 * (here + std::conj(phase) * (turn.transpose().cast<Complex>() * there));
        there = phase * (turn.cast<Complex>() * here);
        x.middleRows<3>(at) = here.real();
        y.middleRows<3>(at) = here.imag();
        x.middleRows<3>(next) = there.real();
        y.middleRows<3>(next) = there.imag();
      }
    }
  };
  const std::vector<double> own = on_all_ranks(PETSC_COMM_WORLD, [&] {
    std::vector<double> lines;
    for (const ModesOfHarmonic& modes : known.modes) {
      if (modes.omega.size() == 0) continue;
      MatrixXd x = forces.in(modes.x, modes.omega), y = forces.in(modes.y, modes.omega);
      share(x, y, modes.order);
      const VectorXd lowered =
          modes.weight * (forces.lowering(x, modes.omega) + forces.lowering(y, modes.omega));
      for (Index i = 0; i < lowered.size(); ++i) {
        lines.insert(lines.end(),
                     {modes.omega[i], double(modes.multiplicity), double(modes.order), lowered[i]});
      }
    }
    return lines;
  });
  return by_frequency(own, 4).col(3);
}

/// Nodes of the interface that stand on the axis, which harmonics 0 and 1 know as masters.
std::vector<std::string> names_on_axis(const scene::Scene& scene, const mesh::Mesh& whole)
{
  const double length = mesh::outer_radius(whole);
  std::vector<std::string> names;
  for (const std::string& name : scene.interface_nodes) {
    const auto group = std::ranges::find(whole.groups, name, &mesh::Group::name);
    const bool is_off =
        group != whole.groups.end() && std::ranges::any_of(group->nodes, [&](int node) {
          return !mesh::is_on_axis(whole.positions[std::size_t(node)], length);
        });
    if (!is_off) names.push_back(name);
  }
  return names;
}

/// The DOFs of a body one sector of which has these: nodes on the axis are in all sectors, those of
/// a cut edge in two.
int n_dofs_of_all(const mesh::Mesh& sector, const plate::DofMap& dofs)
{
  const double length = mesh::outer_radius(sector);
  std::set<int> next;
  for (const auto& [low, high] : sector.sectors.pairs) next.insert(high);
  int n = 0;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    const Eigen::Vector3d x = dofs.position(node);
    const bool is_on_axis = mesh::is_on_axis({x[0], x[1], x[2]}, length);
    const int of_sectors = next.contains(node) ? 0 : is_on_axis ? 1 : sector.sectors.count;
    for (const int c : dofs.components())
      if (dofs.dof(node, c)) n += of_sectors;
  }
  return n;
}

}  // namespace

SectorFrequencies::SectorFrequencies(const scene::Scene& scene, const mesh::Mesh& mesh, int count)
    : scene_(scene), mesh_(&mesh), count_(count), interface_(scene.interface_nodes)
{
  constexpr int all = 6;
  scene_.interface_nodes = names_on_axis(scene, mesh);
  scene_.ring_harmonics.clear();
  scene_.body.interface_modes.clear();
  scene_.deviations = {};
  const bool is_whole = mesh.sectors.count == 1;
  const plate::DofMap dofs =
      plate::make_dof_map(mesh, {.couplings = scene.couplings, .components = scene.components},
                          std::vector<int>(mesh.positions.size(), 0), 1);
  plate::check_stiffness_of_all_nodes(mesh, dofs);
  plate::refuse_drilling(mesh, dofs, scene.supports, scene.springs);
  const std::vector<int> held = plate::held_dofs(mesh, dofs, scene.supports);
  const auto free = plate::free_parts(mesh, dofs, held, scene.springs);
  n_rigid_ = plate::n_free_motions(free);
  n_dofs_ = is_whole ? dofs.n_dofs() : n_dofs_of_all(mesh, dofs);
  const bool is_free = n_rigid_ == all && free.size() == 1;
  if (n_rigid_ > 0 && !is_free)
    throw Error(fmt::format("the support leaves {} rigid-body motions of a sector", n_rigid_));
  sector_ = std::make_shared<const SupportedSector>(supported_sector(
      scene_, is_whole ? sector_of(scene_, mesh, count) : sector_model(scene_, mesh)));
}

std::optional<SectorFrequencies> SectorFrequencies::find(const scene::Scene& scene,
                                                         const mesh::Mesh& mesh)
{
  if (mesh.sectors.count > 1) return SectorFrequencies(scene, mesh, mesh.sectors.count);
  if (scene.mesh.sector_search == mesh::SectorSearch::none) return std::nullopt;
  try {
    const int count = mesh::n_repetitions(mesh);
    if (count < least_sectors) return std::nullopt;
    return SectorFrequencies(scene, mesh, count);
  } catch (const Error&) {
    return std::nullopt;
  }
}

VectorXd SectorFrequencies::up_to(double omega, const linear::SolverOptions& solver) const
{
  return frequencies_of(modes_up_to(*sector_, omega, n_rigid_ > 0, solver));
}

std::optional<MeshErrors> SectorFrequencies::errors_up_to(double omega,
                                                          const linear::SolverOptions& solver) const
{
  const std::vector<ModesOfHarmonic> known = modes_up_to(*sector_, omega, n_rigid_ > 0, solver);
  const InterfaceOf interface {
    *mesh_, interface_
  };
  const auto modes_on = [&](const plate::RefinedMesh& refined, Asked) {
    const SupportedSector other = sector_on(scene_, refined.mesh, count_, *mesh_);
    const auto solve = [&](int order, Index n) {
      return elastic_modes(other, order, int(n) + 2, n_rigid_ > 0, solver);
    };
    return refined_modes({*sector_, known}, other, solve, interface);
  };
  MeshErrors found{.omega = frequencies_of(known), .errors = {}, .shape_errors = {}, .finer = {}};
  if (found.omega.size() == 0) return MeshErrors{};
  const bool is_large = sector_->model.dofs.n_dofs() > most_halved;
  try {
    if (is_large && plate::can_rise(*mesh_))
      find_by_orders(*mesh_, modes_on, found);
    else
      find_by_halves(scene_, *mesh_, modes_on, found);
  } catch (const Error&) {  // of a refined mesh, on all ranks alike
    if (mesh_->sectors.count > 1) throw;
    return std::nullopt;
  }
  const PointForces forces(scene_, sector_->model.mesh, PETSC_COMM_SELF);
  if (!forces.points().empty()) {
    forces.add_to(found, lowering_of({*sector_, known}, forces),
                  is_large && plate::can_rise(*mesh_));
  }
  return found;
}

namespace {

/// What holds some components about the axis and not those that a turn mixes with them belongs to
/// no harmonic alone.
bool turns(const plate::DofMap& dofs, const std::vector<bool>& is_held)
{
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    for (const int c : {0, 3}) {
      const auto one = dofs.dof(node, c), other = dofs.dof(node, c + 1);
      if (one && other && is_held[std::size_t(*one)] != is_held[std::size_t(*other)]) return false;
    }
  }
  return true;
}

/// x, y and both rotations about them are two motions of the harmonic 1; z and the rotation about
/// it are the harmonic 0's.
int n_rigid_of(int order, bool is_free, bool is_half)
{
  if (!is_free || order > 1) return 0;
  return order == 0 || is_half ? 2 : 4;
}

/// All elastic modes of a harmonic up to a frequency, and one above where there is one.
ModesOfHarmonic modes_beyond(const SupportedSector& sector, int order, double omega, bool is_free,
                             const linear::SolverOptions& solver)
{
  for (int n = 6;; n *= 2) {
    ModesOfHarmonic modes = elastic_modes(sector, order, n, is_free, solver);
    const Index found = modes.omega.size();
    if (found < n || modes.omega[found - 1] > omega) return modes;
  }
}

/// Most harmonics of a range of frequencies have no mode in it.
bool lie_above(const SupportedSector& sector, int order, double omega)
{
  return cyclic::all_modes_lie_above(sector.matrices,
                                     cyclic::harmonic_coordinates(sector.model.dofs, order),
                                     sector.is_held, omega);
}

/// Of each harmonic of this rank.
template <class Work>
auto of_own_harmonics(int count, const Work& work)
{
  const HarmonicGroups groups(cyclic::n_harmonics(count), std::nullopt);
  return on_all_ranks(PETSC_COMM_WORLD, [&] {
    std::vector<ModesOfHarmonic> own;
    if (groups.speaks())
      for (const int order : groups.own()) own.push_back(work(order));
    return own;
  });
}

/// The lowest frequency of all ranks, rad/s.
double lowest_of_harmonics(const std::vector<ModesOfHarmonic>& own)
{
  double least = std::numeric_limits<double>::infinity();
  for (const ModesOfHarmonic& modes : own)
    if (modes.omega.size() > 0) least = std::min(least, modes.omega[0]);
  return -largest_of_ranks(-least);
}

void leave_out_above(std::vector<ModesOfHarmonic>& own, double omega)
{
  for (ModesOfHarmonic& modes : own) {
    const Index k = (modes.omega.array() <= omega).count();
    modes.omega.conservativeResize(k);
    modes.x.conservativeResize(Eigen::NoChange, k);
    modes.y.conservativeResize(Eigen::NoChange, k);
  }
}

/// A support that a mirror changes leaves nothing of it.
void keep_mirror_of_support(cyclic::SectorDofs& dofs, const std::vector<bool>& is_held)
{
  if (!dofs.mirror) return;
  const std::size_t n_c = dofs.components.size();
  for (std::size_t block = 0; block < dofs.mirror->image.size(); ++block) {
    const auto image = std::size_t(dofs.mirror->image[block]);
    for (std::size_t i = 0; i < n_c; ++i) {
      if (is_held[block * n_c + i] == is_held[image * n_c + i]) continue;
      dofs.mirror.reset();
      return;
    }
  }
}

}  // namespace

SupportedSector supported_sector(const scene::Scene& scene, SectorModel model)
{
  SupportedSector sector{.model = std::move(model), .matrices = {}, .is_held = {}};
  const plate::DofMap& dofs = sector.model.system.dofs;
  sector.matrices = matrices_of(sector.model, PETSC_COMM_SELF);
  sector.matrices.C = sector.matrices.H = {};
  sector.model.dofs.mirror = mirror_of(sector.model, sector.matrices);
  sector.is_held.assign(std::size_t(dofs.n_dofs()), false);
  for (const int dof : plate::held_dofs(sector.model.mesh, dofs, scene.supports))
    sector.is_held[std::size_t(dof)] = true;
  if (!turns(dofs, sector.is_held)) throw Error("sectors: the support does not turn with them");
  keep_mirror_of_support(sector.model.dofs, sector.is_held);
  return sector;
}

ModesOfHarmonic elastic_modes(const SupportedSector& sector, int order, int n, bool is_free,
                              const linear::SolverOptions& solver)
{
  const cyclic::HarmonicCoordinates c = cyclic::harmonic_coordinates(sector.model.dofs, order);
  const int n_rigid = n_rigid_of(order, is_free, c.symmetric.size() > 0);
  const cyclic::HarmonicModes modes =
      cyclic::harmonic_modes(sector.matrices, c, sector.is_held,
                             {.n_modes = n + n_rigid, .n_rigid = n_rigid, .solver = solver});
  std::vector<int> nodes(std::size_t(sector.model.mesh.n_nodes()));
  std::iota(nodes.begin(), nodes.end(), 0);
  const Index k = std::max<Index>(modes.omega.size() - n_rigid, 0);
  const auto motion = [&](const MatrixXd& U) {
    return node_rows(nodes, sector.model.system.dofs,
                     [&](const std::vector<int>& dofs) { return U(dofs, Eigen::lastN(k)).eval(); });
  };
  return {.order = order,
          .omega = modes.omega.tail(k),
          .multiplicity = modes.multiplicity,
          .weight = c.weight,
          .x = motion(modes.motion.x),
          .y = motion(modes.motion.y)};
}

std::vector<ModesOfHarmonic> modes_up_to(const SupportedSector& sector, double omega, bool is_free,
                                         const linear::SolverOptions& solver)
{
  const auto some = [&](int order) { return modes_beyond(sector, order, omega, is_free, solver); };
  std::vector<ModesOfHarmonic> own = of_own_harmonics(sector.model.dofs.count, [&](int order) {
    return lie_above(sector, order, omega) ? ModesOfHarmonic{.order = order} : some(order);
  });
  // The lowest of all harmonics is asked for even where it lies above.
  if (lowest_of_harmonics(own) > omega) own = of_own_harmonics(sector.model.dofs.count, some);
  leave_out_above(own, std::max(omega, lowest_of_harmonics(own)));
  return own;
}

MatrixXd by_frequency(const std::vector<double>& own, Index n_columns)
{
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<double> all = joined(own);
  const Eigen::Map<const Rows> lines(all.data(), std::ssize(all) / n_columns, n_columns);
  std::vector<Index> order;
  for (Index i = 0; i < lines.rows(); ++i) order.insert(order.end(), std::size_t(lines(i, 1)), i);
  std::ranges::stable_sort(order, {}, [&](Index i) { return std::pair(lines(i, 0), lines(i, 2)); });
  return lines(order, every);
}

VectorXd frequencies_of(const std::vector<ModesOfHarmonic>& own)
{
  std::vector<double> lines;
  for (const ModesOfHarmonic& modes : own)
    for (const double omega : modes.omega)
      lines.insert(lines.end(), {omega, double(modes.multiplicity), double(modes.order)});
  return by_frequency(lines, 3).col(0);
}

}  // namespace chladni::cases
