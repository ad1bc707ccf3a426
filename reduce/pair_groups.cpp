#include "reduce/pair_groups.hpp"

#include <algorithm>
#include <numeric>

#include "linear/kernels/decoupled_rows.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// The rows of this rank, counted from its first.
std::vector<PetscInt> own_rows(IS set, Mat A)
{
  PetscInt first = 0, n = 0;
  const PetscInt* global = nullptr;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  petsc::check(ISGetLocalSize(set, &n));
  petsc::check(ISGetIndices(set, &global));
  std::vector<PetscInt> rows(global, global + n);
  petsc::check(ISRestoreIndices(set, &global));
  for (PetscInt& row : rows) row -= first;
  return rows;
}

/// [coordinates x sets] 1 where a coordinate moves slaves of a set, or its mass is coupled to them.
class MovedSets {
 public:
  MovedSets(const Condensation& system, const std::vector<PairGroup>& sets) : sets_(sets)
  {
    PetscInt n_m = 0;
    petsc::check(MatGetSize(system.Q_CB.Psi, nullptr, &n_m));
    moves_ = MatrixXd::Zero(n_m + system.Q_CB.n_modes(), std::ssize(sets));
    add_columns(system.Q_CB.Psi, 0);
    if (system.Q_CB.modes) add_columns(system.Q_CB.modes->Phi, n_m);
    add_coupled(system.K.sm);
    add_coupled(system.M.sm);
    linear::sum_over_ranks(linear::values_of(moves_), petsc::communicator(system.K.ss));
  }

  /// The only set that a motion moves, or the number of sets if there are more.
  std::size_t only_one(const Eigen::Ref<const Eigen::VectorXd>& x) const
  {
    std::size_t found = sets_.size(), n = 0;
    for (std::size_t k = 0; k < sets_.size(); ++k) {
      const auto moves = moves_.col(static_cast<Eigen::Index>(k)).array() > 0.0;
      if (!(moves && x.array() != 0.0).any()) continue;
      found = k;
      ++n;
    }
    return n == 1 ? found : sets_.size();
  }

 private:
  void add_columns(Mat X, PetscInt first)
  {
    const linear::LocalRows x(X);
    for (std::size_t k = 0; k < sets_.size(); ++k)
      for (PetscInt j = 0; j < x.n_cols(); ++j)
        if (std::ranges::any_of(sets_[k].rows, [&](PetscInt i) { return x(i, j) != 0.0; }))
          moves_(first + j, static_cast<Eigen::Index>(k)) = 1.0;
  }

  void add_coupled(Mat A_sm)
  {
    PetscInt first = 0, last = 0;
    petsc::check(MatGetOwnershipRange(A_sm, &first, &last));
    std::vector<Eigen::Index> set_of(std::size_t(last - first), 0);
    for (std::size_t k = 0; k < sets_.size(); ++k)
      for (const PetscInt row : sets_[k].rows) set_of[row] = static_cast<Eigen::Index>(k);
    linear::for_local_entries(A_sm, [&](PetscInt row, PetscInt column, double value) {
      if (value != 0.0) moves_(column, set_of[row - first]) = 1.0;
    });
  }

  const std::vector<PairGroup>& sets_;
  MatrixXd moves_;
};

}  // namespace

std::vector<PairGroup> pair_groups(const Condensation& system, const ReducedPairs& pairs)
{
  std::vector<PairGroup> groups;
  for (petsc::IndexSet& set : linear::decoupled_rows(system.K.ss, system.M.ss)) {
    std::vector<PetscInt> rows = own_rows(set, system.K.ss);
    groups.push_back({.pairs = {}, .set = std::move(set), .rows = std::move(rows)});
  }
  PairGroup all{.pairs = {}, .set = {}, .rows = {}};
  if (groups.empty()) {
    all.pairs.resize(pairs.lambda.size());
    std::iota(all.pairs.begin(), all.pairs.end(), 0);
  } else {
    const MovedSets sets(system, groups);
    for (PetscInt j = 0; j < pairs.X.cols(); ++j) {
      const std::size_t k = sets.only_one(pairs.X.col(j));
      (k < groups.size() ? groups[k] : all).pairs.push_back(j);
    }
  }
  groups.push_back(std::move(all));
  std::erase_if(groups, [](const PairGroup& group) { return group.pairs.empty(); });
  return groups;
}

}  // namespace chladni::reduce
