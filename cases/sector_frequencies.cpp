#include "cases/sector_frequencies.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "cases/possible_sector.hpp"
#include "cases/ranks.hpp"
#include "cases/refined_errors.hpp"
#include "cases/sector_modes.hpp"
#include "common/all_ranks.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "cyclic/turn.hpp"
#include "mesh/repetition.hpp"
#include "mesh/sectors.hpp"
#include "plate/dofs/drilling.hpp"
#include "plate/dofs/supports.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

SupportedSector sector_on(const scene::Scene& scene, const mesh::Mesh& whole, int count)
{
  return supported_sector(scene, sector_model(scene, mesh::one_sector(whole, count)));
}

/// Root sums of squares over all sectors of the motion of some nodes of one, as `differences` wants
/// them.
/// @return [6 x k]
MatrixXd sizes_at(const mesh::Mesh& mesh, const std::vector<int>& nodes,
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
  const mesh::Mesh& whole;
  const std::vector<std::string>& names;

  /// Those nodes of a sector that the mesh has too, each of the body once.
  std::vector<int> nodes(const mesh::Mesh& sector) const
  {
    std::set<int> next;  // of the sector further on
    for (const auto& [low, high] : sector.sectors.pairs) next.insert(high);
    std::vector<int> common;
    for (const mesh::Group& group : whole.groups) {
      if (std::ranges::find(names, group.name) == names.end()) continue;
      std::set<std::int64_t> numbers;
      for (const int node : group.nodes) numbers.insert(whole.node_numbers[std::size_t(node)]);
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
      const MatrixXd here = sizes_at(mesh, nodes, modes),
                     there = sizes_at(other_mesh, others, found);
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

}  // namespace

std::optional<SectorFrequencies> SectorFrequencies::find(const scene::Scene& scene,
                                                         const mesh::Mesh& whole)
{
  constexpr int all = 6;
  if (scene.mesh.sector_search == mesh::SectorSearch::none) return std::nullopt;
  try {
    const int count = mesh::n_repetitions(whole);
    if (count < least_sectors) return std::nullopt;
    SectorFrequencies found(scene, whole, count);
    found.interface_ = scene.interface_nodes;
    found.scene_.interface_nodes = names_on_axis(scene, whole);
    found.scene_.ring_harmonics.clear();
    found.scene_.body.interface_modes.clear();
    const plate::DofMap dofs =
        plate::make_dof_map(whole, {.couplings = scene.couplings, .components = scene.components},
                            std::vector<int>(whole.positions.size(), 0), 1);
    plate::check_stiffness_of_all_nodes(whole, dofs);
    plate::refuse_drilling(whole, dofs, scene.supports, scene.springs);
    const std::vector<int> held = plate::held_dofs(whole, dofs, scene.supports);
    const auto free = plate::free_parts(whole, dofs, held, scene.springs);
    found.n_rigid_ = plate::n_free_motions(free);
    found.n_dofs_ = dofs.n_dofs();
    const bool is_free = found.n_rigid_ == all && free.size() == 1;
    if (found.n_rigid_ > 0 && !is_free) return std::nullopt;
    found.sector_ = std::make_shared<const SupportedSector>(
        supported_sector(found.scene_, sector_of(found.scene_, whole, count)));
    return found;
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
    *whole_, interface_
  };
  const auto modes_on = [&](const plate::RefinedMesh& refined, Asked) {
    const SupportedSector other = sector_on(scene_, refined.mesh, count_);
    const auto solve = [&](int order, Index n) {
      return elastic_modes(other, order, int(n) + 2, n_rigid_ > 0, solver);
    };
    return refined_modes({*sector_, known}, other, solve, interface);
  };
  MeshErrors found{.omega = frequencies_of(known), .errors = {}, .shape_errors = {}, .finer = {}};
  if (found.omega.size() == 0) return MeshErrors{};
  const bool is_large = sector_->model.dofs.n_dofs() > most_halved;
  try {
    if (is_large && plate::can_rise(*whole_))
      find_by_orders(*whole_, modes_on, found);
    else
      find_by_halves(scene_, *whole_, modes_on, found);
  } catch (const Error&) {  // of a refined mesh, on all ranks alike
    return std::nullopt;
  }
  return found;
}

}  // namespace chladni::cases
