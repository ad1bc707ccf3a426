#include "plate/assembly/block_rows.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <memory>
#include <optional>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"

namespace chladni::plate {

namespace {

/// A matrix on these rows, which it keeps: a copy of the arrays would cost as much as their sums.
petsc::Matrix matrix_of(SplitRows split, PetscInt n_rows, MPI_Comm comm)
{
  auto kept = std::make_unique<SplitRows>(std::move(split));
  petsc::Matrix A;
  if (petsc::size(comm) == 1)
    petsc::check(MatCreateSeqAIJWithArrays(comm, n_rows, n_rows, kept->start.data(),
                                           kept->column.get(), kept->value.data(), A.put()));
  else
    petsc::check(MatCreateMPIAIJWithSplitArrays(
        comm, n_rows, n_rows, PETSC_DETERMINE, PETSC_DETERMINE, kept->start.data(),
        kept->column.get(), kept->value.data(), kept->other_start.data(), kept->other_column.data(),
        kept->other_value.data(), A.put()));
  petsc::keep_with(reinterpret_cast<PetscObject>(static_cast<Mat>(A)), "chladni_rows",
                   std::move(kept));
  return A;
}

/// Bit n * i + j: some block of the transposed matrix has an entry (i, j).
std::uint64_t components_of(const Eigen::Ref<const Eigen::MatrixXd>& A_e, int n)
{
  std::uint64_t found = 0;
  std::vector<std::uint64_t> bits(static_cast<std::size_t>(A_e.rows()));
  for (Eigen::Index i = 0; i < n; ++i) {
    // Bits of the entries without their signs, of all nodes together: zero where all of them are.
    std::ranges::fill(bits, 0);
    for (Eigen::Index column = i; column < A_e.cols(); column += n) {
      const double* entries = A_e.data() + column * A_e.outerStride();
      for (std::size_t k = 0; k < bits.size(); ++k)
        bits[k] |= std::bit_cast<std::uint64_t>(entries[k]) << 1U;
    }
    for (std::size_t k = 0; k < bits.size(); ++k) {
      const auto j = static_cast<Eigen::Index>(k) % n;
      found |= std::uint64_t{bits[k] != 0} << (n * i + j);
    }
  }
  return found;
}

}  // namespace

BlockPattern block_pattern(int n, PetscInt first, std::vector<std::vector<PetscInt>> neighbours)
{
  BlockPattern pattern{.n = n, .first = first, .start = {0}, .column = {}};
  for (std::vector<PetscInt>& row : neighbours) {
    std::ranges::sort(row);
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.start.push_back(std::ssize(pattern.column));
  }
  return pattern;
}

std::vector<std::ptrdiff_t> block_places(const BlockPattern& pattern,
                                         std::span<const PetscInt> nodes)
{
  std::vector<std::ptrdiff_t> places(nodes.size() * nodes.size(), -1);
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const PetscInt row = nodes[a] - pattern.first;
    if (row < 0 || row >= pattern.n_rows()) continue;
    const auto begin = pattern.column.begin() + pattern.start[row];
    const auto end = pattern.column.begin() + pattern.start[row + 1];
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      const auto it = std::lower_bound(begin, end, nodes[b]);
      assert(it != end && *it == nodes[b]);
      places[a * nodes.size() + b] = it - pattern.column.begin();
    }
  }
  return places;
}

void BlockRows::widen(std::uint64_t components)
{
  const int n = pattern_.n;
  for (int i = 0; i < n; ++i) components |= std::uint64_t{1} << (n + 1) * i;
  std::vector<int> held, place;  // place in the new ones of each that was held
  for (int c = 0; c < n * n; ++c) {
    if (((components_ | components) >> c & 1) == 0) continue;
    if ((components_ >> c & 1) != 0) place.push_back(static_cast<int>(held.size()));
    held.push_back(c);
  }
  if (held.size() == held_.size()) return;
  const auto is_full = [&](PetscInt node) {
    return std::ranges::binary_search(pattern_.full, node);
  };
  std::vector<std::ptrdiff_t> offset{0};
  for (PetscInt row = 0; row < pattern_.n_rows(); ++row) {
    const bool whole_row = is_full(pattern_.first + row);
    for (std::ptrdiff_t k = pattern_.start[row]; k < pattern_.start[row + 1]; ++k) {
      const bool all = whole_row || is_full(pattern_.column[k]);
      offset.push_back(offset.back() + (all ? std::ptrdiff_t(n) * n : std::ssize(held)));
    }
  }
  std::vector<double> values(static_cast<std::size_t>(offset.back()), 0.0);
  for (std::ptrdiff_t k = 0; k + 1 < std::ssize(offset_); ++k) {
    const double* from = values_.data() + offset_[k];
    double* to = values.data() + offset[k];
    if (holds_all(k)) {
      std::copy(from, from + std::ptrdiff_t(n) * n, to);
      continue;
    }
    for (std::size_t s = 0; s < place.size(); ++s) to[place[s]] = from[s];
  }
  components_ |= components;
  held_ = std::move(held);
  offset_ = std::move(offset);
  values_ = std::move(values);
}

void BlockRows::make_room(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places)
{
  if ((components_of(A_e, pattern_.n) & ~components_) == 0 && !offset_.empty()) return;
  if (offset_.empty()) widen(0);
  const int n = pattern_.n;
  const Eigen::Index n_nodes = A_e.rows() / n;
  std::uint64_t components = 0;
  for (Eigen::Index a = 0; a < n_nodes; ++a) {
    for (Eigen::Index b = 0; b < n_nodes; ++b) {
      const std::ptrdiff_t place = places[static_cast<std::size_t>(a * n_nodes + b)];
      if (place >= 0 && !holds_all(place))
        components |= components_of(A_e.block(n * b, n * a, n, n), n);
    }
  }
  if ((components & ~components_) != 0) widen(components);
}

void BlockRows::add(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places)
{
  const int n = pattern_.n;
  const Eigen::Index n_nodes = A_e.rows() / n;
  make_room(A_e, places);
  // A column of the transposed block is a row, and contiguous.
  std::vector<Eigen::Index> distance(held_.size());
  for (std::size_t s = 0; s < held_.size(); ++s)
    distance[s] = held_[s] / n * A_e.outerStride() + held_[s] % n;
  for (Eigen::Index a = 0; a < n_nodes; ++a) {
    for (Eigen::Index b = 0; b < n_nodes; ++b) {
      const std::ptrdiff_t place = places[static_cast<std::size_t>(a * n_nodes + b)];
      if (place < 0) continue;
      double* block = values_.data() + offset_[place];
      if (holds_all(place)) {
        Eigen::Map<Eigen::MatrixXd>(block, n, n) += A_e.block(n * b, n * a, n, n);
        continue;
      }
      const double* source = &A_e(n * b, n * a);
      for (std::size_t s = 0; s < distance.size(); ++s) block[s] += source[distance[s]];
    }
  }
}

petsc::Matrix BlockRows::to_matrix(MPI_Comm comm)
{
  return to_symmetric_matrix(comm, 0.0, Rows::as_they_are);
}

petsc::Matrix BlockRows::to_symmetric_matrix(MPI_Comm comm, double negligible, Rows rows)
{
  widen(0);  // a matrix without elements has its diagonal, too
  const HeldBlocks blocks{pattern_, held_, offset_};
  std::optional<NodeValues> scales;
  if (negligible > 0.0) scales.emplace(pattern_, diagonal_scales(blocks, values_), comm);
  const Sieve sieve{.negligible = negligible, .scales = scales ? &*scales : nullptr};
  std::vector<BlockEntries> entries =
      on_all_ranks(comm, [&] { return sifted(blocks, sieve, values_); });
  if (rows == Rows::alike) {
    std::uint64_t room = pattern_.n_rows() > 0 ? components_ : ~std::uint64_t{0};
    MPI_Allreduce(MPI_IN_PLACE, &room, 1, MPI_UINT64_T, MPI_BAND, comm);
    make_rows_alike(pattern_, entries, room, comm);
  }
  SplitRows split =
      on_all_ranks(comm, [&] { return split_rows(blocks, std::move(values_), entries); });
  petsc::Matrix A = matrix_of(std::move(split), pattern_.n * pattern_.n_rows(), comm);
  petsc::check(MatSetBlockSize(A, pattern_.n));
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  petsc::check(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return A;
}

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
