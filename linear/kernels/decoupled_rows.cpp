#include "linear/kernels/decoupled_rows.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/petsc.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/sparse_matrices.hpp"

namespace chladni::linear {

namespace {

/// Which of n things hang together.
class Unions {
 public:
  explicit Unions(PetscInt n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }

  PetscInt root(PetscInt i)
  {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The lower root remains.
  void unite(PetscInt i, PetscInt j)
  {
    if (parent_[i] == parent_[j]) return;
    const PetscInt a = root(i), b = root(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  PetscInt size() const { return static_cast<PetscInt>(parent_.size()); }

 private:
  std::vector<PetscInt> parent_;
};

/// The rows and columns of a sequential AIJ matrix.
template <typename Visit>
void for_pattern(Mat sequential, const Visit& visit)
{
  PetscInt n = 0;
  const PetscInt *starts = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  petsc::check(MatGetRowIJ(sequential, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts, &columns, &done));
  if (!done) throw Error("decoupled_rows: a matrix is not of type AIJ; convert it with MatConvert");
  for (PetscInt row = 0; row < n; ++row)
    for (PetscInt k = starts[row]; k < starts[row + 1]; ++k) visit(row, columns[k]);
  petsc::check(
      MatRestoreRowIJ(sequential, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts, &columns, &done));
}

/// Entries between rows of this rank and rows of others.
struct Edge {
  PetscInt own, other;  ///< local, global
};

/// Of the rows of this rank, which are looked at.
using Kept = std::vector<char>;

/// Unites the rows of this rank; returns what joins them to others.
std::vector<Edge> unite_own(Mat A, const Kept& is_kept, Unions& rows)
{
  const petsc::Matrix aij = as_aij(A);
  std::vector<Edge> edges;
  const auto unite = [&](PetscInt row, PetscInt column) {
    if (is_kept[row] != 0 && is_kept[column] != 0) rows.unite(row, column);
  };
  PetscBool is_distributed = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)(Mat)aij, MATMPIAIJ, &is_distributed));
  if (!is_distributed) {
    for_pattern(aij, unite);
    return edges;
  }
  Mat own = nullptr, other = nullptr;
  const PetscInt* global = nullptr;
  petsc::check(MatMPIAIJGetSeqAIJ(aij, &own, &other, &global));
  for_pattern(own, unite);
  for_pattern(other, [&](PetscInt row, PetscInt k) {
    if (is_kept[row] != 0) edges.push_back({row, global[k]});
  });
  return edges;
}

constexpr PetscInt no_piece = -1;

/// Sets of rows of this rank, numbered over all ranks.
struct Pieces {
  std::vector<PetscInt> of_row;  ///< [own rows] global number, or `no_piece`
  PetscInt first = 0, n_own = 0, n_all = 0;
};

/// A number for each set; one for all that are small and end on this rank.
Pieces numbered(Unions& rows, const Kept& is_kept, const std::vector<Edge>& edges, MPI_Comm comm)
{
  constexpr PetscInt small = 64;  // parts of the rows of this rank
  std::vector<PetscInt> size(rows.size(), 0), number(rows.size(), -1);
  std::vector<char> goes_on(rows.size(), 0);
  for (PetscInt i = 0; i < rows.size(); ++i) ++size[rows.root(i)];
  for (const Edge& edge : edges) goes_on[rows.root(edge.own)] = 1;
  Pieces pieces;
  PetscInt of_small = -1;
  for (PetscInt i = 0; i < rows.size(); ++i) {
    if (is_kept[i] == 0) {
      pieces.of_row.push_back(no_piece);
      continue;
    }
    const PetscInt root = rows.root(i);
    const bool is_small = goes_on[root] == 0 && size[root] < rows.size() / small;
    PetscInt& its = is_small ? of_small : number[root];
    if (its == -1) its = pieces.n_own++;
    pieces.of_row.push_back(its);
  }
  MPI_Scan(&pieces.n_own, &pieces.first, 1, MPIU_INT, MPI_SUM, comm);
  pieces.first -= pieces.n_own;
  MPI_Allreduce(&pieces.n_own, &pieces.n_all, 1, MPIU_INT, MPI_SUM, comm);
  for (PetscInt& piece : pieces.of_row)
    if (piece != no_piece) piece += pieces.first;
  return pieces;
}

/// Each piece with each of another rank once, two by two.
std::vector<PetscInt> joints(const Pieces& pieces, const std::vector<Edge>& edges, MPI_Comm comm)
{
  std::vector<PetscInt> rows;
  for (const Edge& edge : edges) rows.push_back(edge.other);
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  const std::vector<double> piece_at =
      values_at(rows, {pieces.of_row.begin(), pieces.of_row.end()}, comm);
  std::vector<std::pair<PetscInt, PetscInt>> pairs;
  for (const Edge& edge : edges) {
    const auto place = std::ranges::lower_bound(rows, edge.other) - rows.begin();
    const auto other = static_cast<PetscInt>(piece_at[place]);
    if (other == no_piece) continue;
    pairs.emplace_back(pieces.of_row[edge.own], other);
    if (pairs.size() > 1 && pairs.back() == pairs[pairs.size() - 2]) pairs.pop_back();
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<PetscInt> flat;
  for (const auto& [a, b] : pairs) {
    flat.push_back(a);
    flat.push_back(b);
  }
  return gather_on_all(flat, MPIU_INT, comm);
}

/// Sums and maxima over ranks of the rows in each of n sets.
std::pair<std::vector<double>, std::vector<double>> sizes_of_sets(
    const std::vector<PetscInt>& set_of_row, PetscInt n, MPI_Comm comm)
{
  std::vector<double> own(n, 0.0), sum(n), largest(n);
  for (const PetscInt set : set_of_row)
    if (set != no_piece) own[set] += 1.0;
  MPI_Allreduce(own.data(), sum.data(), static_cast<int>(n), MPI_DOUBLE, MPI_SUM, comm);
  MPI_Allreduce(own.data(), largest.data(), static_cast<int>(n), MPI_DOUBLE, MPI_MAX, comm);
  return {sum, largest};
}

/// Sets that are worth being solved for alone keep a number, in order of size; the last is the
/// rest. Returns how many they are.
PetscInt unite_small_sets(std::vector<PetscInt>& set_of_row, PetscInt n, MPI_Comm comm)
{
  constexpr double good_part = 1.0 / 16.0, uneven = 1.5;
  const auto [sum, largest] = sizes_of_sets(set_of_row, n, comm);
  const double all = std::accumulate(sum.begin(), sum.end(), 0.0);
  std::vector<PetscInt> alone, number(n, -1);
  for (PetscInt set = 0; set < n; ++set) {
    const bool is_even = largest[set] * petsc::size(comm) <= uneven * sum[set];
    if (sum[set] >= good_part * all && is_even) alone.push_back(set);
  }
  std::ranges::stable_sort(alone, [&of = sum](PetscInt a, PetscInt b) { return of[a] > of[b]; });
  auto n_sets = static_cast<PetscInt>(alone.size());
  double kept = 0.0;
  for (PetscInt k = 0; k < n_sets; ++k) {
    number[alone[k]] = k;
    kept += sum[alone[k]];
  }
  for (PetscInt& set : set_of_row)
    if (set != no_piece) set = number[set] == -1 ? n_sets : number[set];
  return kept < all ? n_sets + 1 : n_sets;
}

std::vector<petsc::IndexSet> decoupled(Mat K, Mat M, const Kept& is_kept)
{
  constexpr PetscInt most_pieces = 20000;  // each rank looks at all of them
  const MPI_Comm comm = petsc::communicator(K);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  Unions rows(last - first);
  std::vector<Edge> edges = unite_own(K, is_kept, rows);
  const std::vector<Edge> of_mass = unite_own(M, is_kept, rows);
  edges.insert(edges.end(), of_mass.begin(), of_mass.end());
  const Pieces pieces = numbered(rows, is_kept, edges, comm);
  if (pieces.n_all > most_pieces) return {};
  Unions all(pieces.n_all);
  const std::vector<PetscInt> joined = joints(pieces, edges, comm);
  for (std::size_t k = 0; k < joined.size(); k += 2) all.unite(joined[k], joined[k + 1]);
  std::vector<PetscInt> set_of_row = pieces.of_row;
  for (PetscInt& set : set_of_row)
    if (set != no_piece) set = all.root(set);
  const PetscInt n_sets = unite_small_sets(set_of_row, pieces.n_all, comm);
  if (n_sets < 2) return {};
  std::vector<std::vector<PetscInt>> members(n_sets);
  for (PetscInt i = 0; i < last - first; ++i)
    if (set_of_row[i] != no_piece) members[set_of_row[i]].push_back(first + i);
  std::vector<petsc::IndexSet> sets(n_sets);
  for (PetscInt k = 0; k < n_sets; ++k) {
    petsc::check(ISCreateGeneral(comm, static_cast<PetscInt>(members[k].size()), members[k].data(),
                                 PETSC_COPY_VALUES, sets[k].put()));
  }
  return sets;
}

std::size_t n_own_rows(Mat A)
{
  PetscInt n = 0;
  petsc::check(MatGetLocalSize(A, &n, nullptr));
  return static_cast<std::size_t>(n);
}

}  // namespace

std::vector<petsc::IndexSet> decoupled_rows(Mat K, Mat M)
{
  return decoupled(K, M, Kept(n_own_rows(K), 1));
}

std::vector<petsc::IndexSet> decoupled_rows(Mat K, Mat M, IS rows)
{
  Kept is_kept(n_own_rows(K), 0);
  for (const PetscInt row : petsc::own_rows(rows, K)) is_kept[std::size_t(row)] = 1;
  return decoupled(K, M, is_kept);
}

}  // namespace chladni::linear
