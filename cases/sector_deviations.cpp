#include "cases/sector_deviations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "cases/reduce_steps.hpp"
#include "cases/sector_checks.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "cyclic/sparse_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"

namespace chladni::cases {

namespace {

using cyclic::SparseRows;
using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd;

/// What a sector is made of, without the masses and springs that all have.
struct SectorParts {
  std::vector<plate::ShellSection> shells;
  std::vector<plate::PointMass> masses = {};
  std::vector<plate::Spring> springs = {};
};

/// Whether all sectors have the same values in their own places.
bool is_alike_in_sectors(const plate::Profile& profile)
{
  using enum plate::Coordinate;
  if (!profile.formula.empty()) return false;
  return profile.at.empty() || profile.over == radius || profile.over == z;
}

/// The thickness of a deviation that does not say one is that of the perfect sector.
bool has_own_thickness(const scene::Scene& scene, const plate::ShellSection& deviating)
{
  const auto perfect =
      std::ranges::find(scene.sections, deviating.group, &plate::ShellSection::group);
  return !(perfect->thickness == deviating.thickness);
}

bool acts_on(const scene::Deviation& deviation, int sector)
{
  return deviation.sectors.empty() || std::ranges::count(deviation.sectors, sector) > 0;
}

/// The deviations of a sector, and the sector itself where they differ from place to place:
/// sectors of one key deviate alike.
using DeviationKey = std::vector<int>;

DeviationKey key_of(const scene::Scene& scene, int sector)
{
  DeviationKey key;
  bool is_local = false;
  for (int i = 0; i < std::ssize(scene.deviations); ++i) {
    const scene::Deviation& deviation = scene.deviations[std::size_t(i)];
    if (!acts_on(deviation, sector)) continue;
    key.push_back(i);
    is_local = is_local || (deviation.section && has_own_thickness(scene, *deviation.section) &&
                            !is_alike_in_sectors(deviation.section->thickness));
  }
  if (is_local) key.push_back(-1 - sector);
  return key;
}

SectorParts parts_of(const scene::Scene& scene, int sector, int count)
{
  SectorParts parts{.shells = scene.sections};
  for (const scene::Deviation& deviation : scene.deviations) {
    if (!acts_on(deviation, sector)) continue;
    if (deviation.mass) parts.masses.push_back(*deviation.mass);
    if (deviation.spring) parts.springs.push_back(*deviation.spring);
    if (!deviation.section) continue;
    plate::ShellSection& own =
        *std::ranges::find(parts.shells, deviation.section->group, &plate::ShellSection::group);
    own = *deviation.section;
    if (has_own_thickness(scene, own) && !is_alike_in_sectors(own.thickness))
      own.thickness.turned = 2.0 * std::numbers::pi * sector / count;
  }
  return parts;
}

plate::Structure structure_with(const scene::Scene& scene, const SectorParts& parts)
{
  return {.shells = parts.shells,
          .beams = scene.beams,
          .masses = parts.masses,
          .springs = parts.springs};
}

/// K, M and C of the sector, and what its mass needs.
struct AssembledParts {
  SparseRows K, M, C, H;
  std::array<SparseRows, 6> S = {};  ///< as MassIntegrals::products, without zz
  double mass = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  MatrixXd displacement = {};
};

constexpr std::array<std::size_t, 5> products = {0, 1, 3, 4, 5};

AssembledParts assembled(const scene::Scene& scene, const SectorModel& model,
                         const SectorParts& parts)
{
  const plate::Structure structure = structure_with(scene, parts);
  const plate::System system =
      plate::assemble(model.mesh, structure, model.system.dofs, PETSC_COMM_SELF);
  AssembledParts found{.K = cyclic::sparse_rows(system.K),
                       .M = cyclic::sparse_rows(system.M),
                       .C = SparseRows(model.dofs.n_dofs(), model.dofs.n_dofs()),
                       .H = SparseRows(model.dofs.n_dofs(), model.dofs.n_dofs())};
  if (system.C != nullptr) found.C = cyclic::sparse_rows(system.C);
  if (system.H != nullptr) found.H = cyclic::sparse_rows(system.H);
  if (!scene.mass_integrals) return found;
  const plate::MassModel mass =
      plate::mass_model(model.mesh, structure, model.system.dofs, PETSC_COMM_SELF);
  std::vector<plate::Axes> axes;
  for (const std::size_t i : products) axes.push_back(mbs_export::product_axes[i]);
  const auto [moments, S] = plate::inertia_integrals(mass, axes);
  for (std::size_t i = 0; i < products.size(); ++i)
    found.S[products[i]] = cyclic::sparse_rows(S[i]);
  found.mass = moments.mass;
  found.first = moments.first;
  found.second = moments.second;
  found.displacement = linear::replicate(moments.displacement);
  return found;
}

SparseRows difference(const SparseRows& A, const SparseRows& B)
{
  SparseRows rows = A - B;
  rows.prune([](Index, Index, double value) { return value != 0.0; });
  return rows;
}

AssembledParts difference(const AssembledParts& a, const AssembledParts& b)
{
  AssembledParts d{.K = difference(a.K, b.K),
                   .M = difference(a.M, b.M),
                   .C = difference(a.C, b.C),
                   .H = difference(a.H, b.H),
                   .mass = a.mass - b.mass,
                   .first = a.first - b.first,
                   .second = a.second - b.second,
                   .displacement = a.displacement - b.displacement};
  for (const std::size_t i : products)
    if (a.S[i].size() > 0) d.S[i] = difference(a.S[i], b.S[i]);
  return d;
}

void add_rows(const SparseRows& A, std::set<int>& rows)
{
  for (int row = 0; row < A.outerSize(); ++row)
    if (SparseRows::InnerIterator(A, row)) rows.insert(row);
}

/// The rows and columns of a symmetric pattern that are not empty; of C and S the same.
SparseRows compressed(const SparseRows& A, const std::vector<int>& rows)
{
  std::vector<int> place(std::size_t(A.cols()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[std::size_t(rows[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (const int row : rows)
    for (SparseRows::InnerIterator it(A, row); it; ++it)
      entries.emplace_back(place[std::size_t(row)], place[std::size_t(it.index())], it.value());
  SparseRows small(std::ssize(rows), std::ssize(rows));
  small.setFromTriplets(entries.begin(), entries.end());
  return small;
}

DeviatingSector compressed(const AssembledParts& d, int sector, const std::vector<int>& rows)
{
  DeviatingSector deviating{.sector = sector,
                            .K = compressed(d.K, rows),
                            .M = compressed(d.M, rows),
                            .C = compressed(d.C, rows),
                            .H = compressed(d.H, rows),
                            .mass = std::nullopt};
  if (d.displacement.size() == 0 || d.M.nonZeros() == 0) return deviating;
  deviating.mass = {.mass = d.mass,
                    .first = d.first,
                    .second = d.second,
                    .displacement = d.displacement(rows, every),
                    .S = {}};
  for (const std::size_t i : products) deviating.mass->S[i] = compressed(d.S[i], rows);
  return deviating;
}

}  // namespace

SectorDeviations sector_deviations(const scene::Scene& scene, const SectorModel& model)
{
  SectorDeviations deviations;
  if (scene.deviations.empty()) return deviations;
  check_deviations(scene, model);
  const int count = model.dofs.count;
  const AssembledParts perfect = assembled(scene, model, {.shells = scene.sections});
  std::map<DeviationKey, AssembledParts> known;
  std::vector<std::pair<int, DeviationKey>> keys;
  std::set<int> rows;
  for (int sector = 0; sector < count; ++sector) {
    DeviationKey key = key_of(scene, sector);
    if (key.empty()) continue;
    if (!known.contains(key)) {
      known.emplace(key,
                    difference(assembled(scene, model, parts_of(scene, sector, count)), perfect));
      for (const SparseRows* A : {&known[key].K, &known[key].M, &known[key].C, &known[key].H})
        add_rows(*A, rows);
    }
    keys.emplace_back(sector, std::move(key));
  }
  deviations.rows.assign(rows.begin(), rows.end());
  for (const auto& [sector, key] : keys)
    deviations.sectors.push_back(compressed(known.at(key), sector, deviations.rows));
  return deviations;
}

}  // namespace chladni::cases
