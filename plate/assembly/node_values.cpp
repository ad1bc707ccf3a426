#include "plate/assembly/node_values.hpp"

#include <algorithm>

namespace chladni::plate {

namespace {

using Scatter = petsc::Owned<VecScatter, VecScatterDestroy>;

/// The nodes of other ranks in the columns of a pattern, ascending.
std::vector<PetscInt> nodes_of_others(const BlockPattern& pattern)
{
  std::vector<PetscInt> nodes;
  for (const PetscInt node : pattern.column)
    if (node < pattern.first || node >= pattern.first + pattern.n_rows()) nodes.push_back(node);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

NodeValues::NodeValues(const BlockPattern& pattern, std::vector<double> own, MPI_Comm comm)
    : n_(pattern.n), first_(pattern.first), own_(std::move(own))
{
  if (petsc::size(comm) == 1) return;
  other_nodes_ = nodes_of_others(pattern);
  other_.resize(other_nodes_.size() * static_cast<std::size_t>(n_));
  petsc::Vector all, others;
  petsc::IndexSet wanted;
  Scatter scatter;
  petsc::check(VecCreateMPIWithArray(comm, n_, static_cast<PetscInt>(own_.size()), PETSC_DETERMINE,
                                     own_.data(), all.put()));
  petsc::check(VecCreateSeqWithArray(PETSC_COMM_SELF, n_, static_cast<PetscInt>(other_.size()),
                                     other_.data(), others.put()));
  petsc::check(ISCreateBlock(PETSC_COMM_SELF, n_, static_cast<PetscInt>(other_nodes_.size()),
                             other_nodes_.data(), PETSC_USE_POINTER, wanted.put()));
  petsc::check(VecScatterCreate(all, wanted, others, nullptr, scatter.put()));
  petsc::check(VecScatterBegin(scatter, all, others, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterEnd(scatter, all, others, INSERT_VALUES, SCATTER_FORWARD));
}

const double* NodeValues::of(PetscInt node) const
{
  const PetscInt own = node - first_;
  if (own >= 0 && own < std::ssize(own_) / n_) return own_.data() + std::ptrdiff_t(n_) * own;
  const auto place = std::ranges::lower_bound(other_nodes_, node) - other_nodes_.begin();
  return other_.data() + n_ * place;
}

}  // namespace chladni::plate
