#include "plugin/harmonic_problem.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "common/all_ranks.hpp"
#include "common/index_sets.hpp"

namespace chladni::plugin {

namespace {

/// With the name of the function whose arguments are at fault.
void check_sectors(const cyclic::MatchingRows& rows, PetscInt order, PetscInt n_rows)
{
  try {
    cyclic::check_matching_rows(rows, n_rows);
  } catch (const Error& error) {
    throw Error(fmt::format("CMSSetCyclic: {}", error.what()));
  }
  if (order < 0 || order > rows.count / 2) {
    throw Error(
        fmt::format("CMSSetHarmonic: harmonic {} of {} sectors; give 0 to {}, -cms_harmonic", order,
                    rows.count, rows.count / 2));
  }
}

petsc::Matrix symmetric_operator(Mat A, const cyclic::SectorHarmonic& harmonic)
{
  petsc::Matrix form = cyclic::harmonic_operator(A, harmonic);
  petsc::check(MatSetOption(form, MAT_SYMMETRIC, PETSC_TRUE));
  return form;
}

}  // namespace

std::vector<PetscInt> all_indices(IS set)
{
  petsc::IndexSet gathered;
  petsc::check(ISAllGather(set, gathered.put()));
  return petsc::own_indices(gathered);
}

HarmonicProblem harmonic_problem(const Sectors& sectors, PetscInt order, const Operators& sector)
{
  cyclic::MatchingRows rows{.count = sectors.count,
                            .low = all_indices(sectors.low),
                            .high = all_indices(sectors.high),
                            .R = sectors.R};
  PetscInt n_rows = 0;
  petsc::check(MatGetSize(sector.K, &n_rows, nullptr));
  check_sectors(rows, order, n_rows);
  HarmonicProblem problem{
      .harmonic = cyclic::sector_harmonic(std::move(rows), static_cast<int>(order), sector.K),
      .operators = {}};
  problem.operators.K = symmetric_operator(sector.K, problem.harmonic);
  problem.operators.M = symmetric_operator(sector.M, problem.harmonic);
  problem.operators.velocity.is_symmetric = sector.velocity.is_symmetric;
  if (sector.velocity.C)
    problem.operators.velocity.C = cyclic::harmonic_operator(sector.velocity.C, problem.harmonic);
  return problem;
}

HarmonicMasters harmonic_masters(const cyclic::SectorCoordinates& coordinates,
                                 const std::vector<PetscInt>& masters)
{
  HarmonicMasters kept;
  for (const PetscInt row : masters) {
    if (const PetscInt low = coordinates.followed_by(row); low >= 0) {
      throw Error(fmt::format(
          "CMSSetInterface: master {} is in the high edge; give row {} of the low edge, "
          "which it follows",
          row, low));
    }
    for (const PetscInt other : coordinates.alike(row)) {
      if (std::ranges::find(masters, other) != masters.end()) continue;
      throw Error(fmt::format(
          "CMSSetInterface, CMSSetHeld: row {} is of a node that all sectors share, whose rows {} "
          "the rotation turns into each other; name all of them or none: row {} is missing",
          row, fmt::join(coordinates.alike(row), ", "), other));
    }
  }
  for (PetscInt phase = 0; phase < 2; ++phase) {
    for (std::size_t i = 0; i < masters.size(); ++i) {
      if (coordinates.n_of(masters[i]) <= phase) continue;
      kept.coordinates.push_back(coordinates.first(masters[i]) + phase);
      kept.rows.push_back(masters[i]);
      kept.phases.push_back(phase);
      kept.places.push_back(static_cast<PetscInt>(i));
    }
  }
  return kept;
}

}  // namespace chladni::plugin
