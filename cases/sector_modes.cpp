#include "cases/sector_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cases/harmonic_groups.hpp"
#include "cases/node_rows.hpp"
#include "cases/ranks.hpp"
#include "common/all_ranks.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "cyclic/harmonic_modes.hpp"
#include "plate/dofs/supports.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
double lowest_of(const std::vector<ModesOfHarmonic>& own)
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
  if (lowest_of(own) > omega) own = of_own_harmonics(sector.model.dofs.count, some);
  leave_out_above(own, std::max(omega, lowest_of(own)));
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
