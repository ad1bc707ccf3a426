#include "linear/kernels/sparse_product.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "common/petsc.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/panel_kernels.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

namespace {

bool are_zero(const double* first, const double* last)
{
  return std::all_of(first, last, [](double x) { return x == 0.0; });
}

}  // namespace

/// What the rows of a sequential matrix have in common.
struct SparseProduct::Pattern {
  PetscObjectState entries;    ///< of which the matrix had these
  std::vector<PetscInt> cuts;  ///< rows at which a square matrix falls apart
  std::vector<char> n_alike;
};

/// The matrix remembers it as long as it has the same entries.
const SparseProduct::Pattern& SparseProduct::pattern_of_own() const
{
  constexpr const char* name = "chladni_pattern";
  const auto object = reinterpret_cast<PetscObject>(own_.matrix);
  PetscObjectState entries = 0;
  petsc::check(MatGetNonzeroState(own_.matrix, &entries));
  const auto* known = petsc::kept_with<Pattern>(object, name);
  if (known != nullptr && known->entries == entries) return *known;
  const Csr A{own_.starts, own_.columns, own_.values};
  auto found = std::make_unique<Pattern>();
  found->entries = entries;
  if (n_rows_ == n_columns_) found->cuts = cuts(A, n_rows_);
  found->n_alike = numbers_alike(A, n_rows_);
  petsc::keep_with(object, name, std::move(found));
  return *petsc::kept_with<Pattern>(object, name);
}

SparseProduct::Rows SparseProduct::borrow(Mat sequential)
{
  Rows rows{.matrix = sequential};
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  petsc::check(
      MatGetRowIJ(sequential, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows.starts, &rows.columns, &done));
  if (!done)
    throw Error("SparseProduct: the matrix is not of type AIJ; convert it with MatConvert");
  petsc::check(MatSeqAIJGetArrayRead(sequential, &rows.values));
  return rows;
}

void SparseProduct::give_back(Rows& rows)
{
  if (rows.matrix == nullptr) return;
  PetscInt n = 0;
  PetscBool done = PETSC_FALSE;
  MatSeqAIJRestoreArrayRead(rows.matrix, &rows.values);
  MatRestoreRowIJ(rows.matrix, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows.starts, &rows.columns, &done);
}

SparseProduct::SparseProduct(Mat A) : A_(as_aij(A)), comm_(petsc::communicator(A))
{
  petsc::check(MatGetLocalSize(A, &n_rows_, &n_columns_));
  PetscBool is_distributed = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)(Mat)A_, MATMPIAIJ, &is_distributed));
  if (is_distributed) {
    Mat own = nullptr, other = nullptr;
    const PetscInt* ghosts = nullptr;
    petsc::check(MatMPIAIJGetSeqAIJ(A_, &own, &other, &ghosts));
    petsc::check(MatGetSize(other, nullptr, &n_ghosts_));
    own_ = borrow(own);
    other_ = borrow(other);
    const PetscInt* ranges = nullptr;
    petsc::check(MatGetOwnershipRangesColumn(A, &ranges));
    plan_exchange({.columns = ghosts, .first = ranges});
  } else {
    own_ = borrow(A_);
  }
  panel_ = aligned_numbers((std::size_t(n_columns_) + n_ghosts_) * wide_panel);
  product_ = aligned_numbers(std::size_t(n_rows_) * wide_panel);
}

SparseProduct::~SparseProduct()
{
  give_back(own_);
  give_back(other_);
}

/// Asks the owners for the ghosts, which ascend and so stand by rank.
void SparseProduct::plan_exchange(const Ghosts& ghosts)
{
  const int n_ranks = petsc::size(comm_);
  const int rank = petsc::rank(comm_);
  send_counts_.resize(n_ranks);
  receive_counts_.resize(n_ranks);
  for (int r = 0; r < n_ranks; ++r) {
    const PetscInt* end = ghosts.columns + n_ghosts_;
    receive_counts_[r] =
        static_cast<int>(std::lower_bound(ghosts.columns, end, ghosts.first[r + 1]) -
                         std::lower_bound(ghosts.columns, end, ghosts.first[r]));
  }
  MPI_Alltoall(receive_counts_.data(), 1, MPI_INT, send_counts_.data(), 1, MPI_INT, comm_);
  const std::vector<int> send_at = offsets(send_counts_), receive_at = offsets(receive_counts_);
  send_rows_.resize(send_at.back());
  MPI_Alltoallv(ghosts.columns, receive_counts_.data(), receive_at.data(), MPIU_INT,
                send_rows_.data(), send_counts_.data(), send_at.data(), MPIU_INT, comm_);
  for (int& row : send_rows_) row -= ghosts.first[rank];
  outbox_.resize(send_rows_.size() * wide_panel);
}

/// The rows of the ghosts behind the own ones.
void SparseProduct::exchange(PetscInt width) const
{
  if (send_counts_.empty()) return;
  for (std::size_t i = 0; i < send_rows_.size(); ++i) {
    std::copy_n(panel_.get() + std::size_t(send_rows_[i]) * width, width,
                outbox_.data() + i * width);
  }
  const std::vector<int> send_at = offsets(send_counts_), receive_at = offsets(receive_counts_);
  const RowType row(width);
  MPI_Alltoallv(outbox_.data(), send_counts_.data(), send_at.data(), row,
                panel_.get() + std::size_t(n_columns_) * width, receive_counts_.data(),
                receive_at.data(), row, comm_);
}

/// All rows where they cannot be cut.
std::vector<SparseProduct::Segment> SparseProduct::segments() const
{
  std::vector<Segment> found{{{0, n_rows_}, {0, n_columns_}}};
  for (const PetscInt i : pattern_of_own().cuts) {
    found.back().rows.last = found.back().columns.last = i;
    found.push_back({{i, n_rows_}, {i, n_rows_}});
  }
  return found;
}

/// Of each column, on this rank.
std::vector<SparseProduct::Mask> SparseProduct::masks(const LocalRows& X) const
{
  std::vector<Mask> masks;
  for (PetscInt j = 0; j < X.n_cols(); ++j) {
    const double* x = X.values() + std::size_t(j) * X.leading_dimension();
    Mask mask = 0;
    for (std::size_t k = 0; k < segments_.size(); ++k) {
      const Segment& s = segments_[k];
      if (!are_zero(x + s.columns.first, x + s.columns.last)) mask |= Mask{1} << k;
    }
    masks.push_back(mask);
  }
  return masks;
}

/// Some columns of Y <- A X.
void SparseProduct::multiply(const LocalRows& X, const Panel& panel, double* Y, PetscInt ldy) const
{
  const Csr own{own_.starts, own_.columns, own_.values};
  const Csr other{other_.starts, other_.columns, other_.values};
  const bool is_distributed = !send_counts_.empty();
  const auto multiply = panel.width == wide_panel ? multiply_wide : multiply_narrow;
  const auto add = panel.width == wide_panel ? add_wide : add_narrow;
  const char* n_alike = pattern_of_own().n_alike.data();
  const auto at = [&](const AlignedNumbers& values, PetscInt row) {
    return values.get() + std::size_t(row) * std::size_t(panel.width);
  };
  const auto is_active = [&](std::size_t k) { return (panel.is_active >> k & 1U) != 0; };
  std::vector<const double*> from(panel.columns.size());
  std::vector<double*> to(panel.columns.size());
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    const RowSpan& rows = segments_[k].columns;
    for (std::size_t c = 0; c < from.size(); ++c)
      from[c] = X.values() + rows.first + std::size_t(panel.columns[c]) * X.leading_dimension();
    if (is_active(k))
      to_panel(from, {.n = rows.size()}, panel.width, at(panel_, rows.first));
    else if (is_distributed)
      std::fill(at(panel_, rows.first), at(panel_, rows.last), 0.0);
  }
  exchange(panel.width);
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    const RowSpan& rows = segments_[k].rows;
    for (std::size_t c = 0; c < to.size(); ++c)
      to[c] = Y + rows.first + std::size_t(panel.columns[c]) * std::size_t(ldy);
    if (!is_active(k) && n_ghosts_ == 0) {
      for (double* column : to) std::fill_n(column, rows.size(), 0.0);
      continue;
    }
    if (is_active(k))
      multiply(own, n_alike, rows, panel_.get(), product_.get());
    else
      std::fill(at(product_, rows.first), at(product_, rows.last), 0.0);
    if (n_ghosts_ > 0) add(other, rows, at(panel_, n_columns_), product_.get());
    to_columns(at(product_, rows.first), panel.width, {.n = rows.size()}, to);
  }
}

void SparseProduct::apply(Mat X, Mat Y) const
{
  const LogEvent event(Event::sparse_product);
  const LocalRows x(X);
  if (segments_.empty()) segments_ = segments();
  const std::vector<Mask> here = masks(x);
  std::vector<Mask> anywhere = here;
  if (x.n_cols() <= narrow_panel) {  // one panel
    std::ranges::fill(anywhere, Mask{0});
  } else if (!send_counts_.empty()) {
    MPI_Allreduce(MPI_IN_PLACE, anywhere.data(), static_cast<int>(anywhere.size()), MPI_UINT32_T,
                  MPI_BOR, comm_);
  }
  std::vector<PetscInt> columns(here.size());  // those of the same segments side by side
  std::iota(columns.begin(), columns.end(), 0);
  std::ranges::stable_sort(columns, {}, [&](PetscInt j) { return anywhere[std::size_t(j)]; });
  PetscInt ldy = 0;
  PetscScalar* y = nullptr;
  petsc::check(MatDenseGetLDA(Y, &ldy));
  petsc::check(MatDenseGetArrayWrite(Y, &y));
  for (std::size_t first = 0; first < columns.size();) {
    std::size_t alike = first;
    while (alike < columns.size() && anywhere[columns[alike]] == anywhere[columns[first]]) ++alike;
    alike = std::max(
        alike, std::min(first + narrow_panel, columns.size()));  // the least that a pass takes
    PetscInt width = wide_panel;
    if (alike - first <= narrow_panel) width = narrow_panel;
    const std::size_t n = std::min<std::size_t>(std::size_t(width), alike - first);
    Panel panel{.columns = std::span(columns).subspan(first, n), .width = width, .is_active = 0};
    for (const PetscInt j : panel.columns) panel.is_active |= here[std::size_t(j)];
    multiply(x, panel, y, ldy);
    first += n;
  }
  petsc::check(MatDenseRestoreArrayWrite(Y, &y));
}

petsc::Matrix sparse_product(Mat A, Mat X)
{
  petsc::Matrix AX = uninitialized_dense(A, LocalRows(X).n_cols());
  SparseProduct(A).apply(X, AX);
  return AX;
}

namespace {

/// Whether a product is added to what is there.
enum class Start { zero, there };

/// Asks for what comes behind some numbers that are about to be read, and as much of it.
template <typename Number>
[[gnu::always_inline]] inline void ask_ahead(const Number* numbers, PetscInt n)
{
  constexpr std::size_t distance = 2048, cache_line = 64;  // bytes
  for (std::size_t at = 0; at < std::size_t(n); at += cache_line / sizeof(Number))
    __builtin_prefetch(numbers + distance / sizeof(Number) + at);
}

/// `alike` rows of Y <- A panel, from row i on, which have the same columns: what they multiply is
/// read once.
template <int numbers, PetscInt width, int alike, Start start>
[[gnu::always_inline]] inline void multiply_rows(const Csr& A, PetscInt i, const double* panel,
                                                 double* Y)
{
  constexpr int n_lanes = width / numbers;
  // NOLINTBEGIN(modernize-avoid-c-arrays): sums that stay in registers
  Lane<numbers> sum[alike][n_lanes];
  const PetscScalar* values[alike];
  // NOLINTEND(modernize-avoid-c-arrays)
  double* y = Y + std::size_t(i) * width;
#pragma GCC unroll 8
  for (int r = 0; r < alike; ++r) {
    values[r] = A.values + A.starts[i + r];
#pragma GCC unroll 8
    for (int l = 0; l < n_lanes; ++l)
      if constexpr (start == Start::there)
        load(y + r * width + l * numbers, sum[r][l]);
      else
        sum[r][l] = Lane<numbers>{};
  }
  const PetscInt* columns = A.columns + A.starts[i];
  const PetscInt n = A.starts[i + 1] - A.starts[i];
  ask_ahead(values[0], alike * n);
  ask_ahead(columns, n);
  for (PetscInt k = 0; k < n; ++k) {
    const double* from = panel + std::size_t(columns[k]) * width;
#pragma GCC unroll 8
    for (int l = 0; l < n_lanes; ++l) {
      Lane<numbers> x;
      load(from + l * numbers, x);
#pragma GCC unroll 8
      for (int r = 0; r < alike; ++r) sum[r][l].values += values[r][k] * x.values;
    }
  }
#pragma GCC unroll 8
  for (int r = 0; r < alike; ++r)
#pragma GCC unroll 8
    for (int l = 0; l < n_lanes; ++l) store(sum[r][l], y + r * width + l * numbers);
}

constexpr int most_alike = 3;  // rows at a time: the sums of more have no registers

/// Y <- A panel in some rows, Y row by row like the panel. The entries are asked for ahead. What
/// it needs of the panel the processor asks for soon enough by itself: asking ahead took longer.
/// @param n_alike  [rows of A] how many from this one on have the same columns, up to `most_alike`
template <int numbers, PetscInt width>
[[gnu::always_inline]] inline void multiply_panel(const Csr& A, const char* n_alike,
                                                  const RowSpan& rows, const double* panel,
                                                  double* Y)
{
  for (PetscInt i = rows.first; i < rows.last;) {
    const PetscInt alike = std::min<PetscInt>(n_alike[i], rows.last - i);
    if (alike >= 3)
      multiply_rows<numbers, width, 3, Start::zero>(A, i, panel, Y);
    else if (alike == 2)
      multiply_rows<numbers, width, 2, Start::zero>(A, i, panel, Y);
    else
      multiply_rows<numbers, width, 1, Start::zero>(A, i, panel, Y);
    i += alike;
  }
}

/// Y <- Y + A panel in some rows.
template <int numbers, PetscInt width>
[[gnu::always_inline]] inline void add_panel(const Csr& A, const RowSpan& rows, const double* panel,
                                             double* Y)
{
  for (PetscInt i = rows.first; i < rows.last; ++i)
    multiply_rows<numbers, width, 1, Start::there>(A, i, panel, Y);
}

/// Rows at which a square matrix may be cut: no entry joins those before with the others.
std::vector<char> free_cuts(const Csr& A, PetscInt n)
{
  std::vector<char> is_free(std::size_t(n), 0);
  std::vector<PetscInt> nearest(std::size_t(n), n);  // column of each row
  PetscInt farthest = 0;
  for (PetscInt i = 0; i < n; ++i) {
    is_free[std::size_t(i)] = farthest <= i ? 1 : 0;
    const std::span<const PetscInt> row = A.row(i);
    if (row.empty()) continue;
    const auto [least, most] = std::ranges::minmax(row);
    farthest = std::max(farthest, most + 1);
    nearest[std::size_t(i)] = least;
  }
  for (PetscInt i = n, least = n; i-- > 0;) {
    least = std::min(least, nearest[std::size_t(i)]);
    if (least < i) is_free[std::size_t(i)] = 0;
  }
  return is_free;
}

}  // namespace

void multiply_narrow(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                     double* Y)
{
  on_widest_lanes(
      [=]<int numbers>() { multiply_panel<numbers, narrow_panel>(A, n_alike, rows, panel, Y); });
}

void multiply_wide(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                   double* Y)
{
  on_widest_lanes(
      [=]<int numbers>() { multiply_panel<numbers, wide_panel>(A, n_alike, rows, panel, Y); });
}

void add_narrow(const Csr& A, const RowSpan& rows, const double* panel, double* Y)
{
  on_widest_lanes([=]<int numbers>() { add_panel<numbers, narrow_panel>(A, rows, panel, Y); });
}

void add_wide(const Csr& A, const RowSpan& rows, const double* panel, double* Y)
{
  on_widest_lanes([=]<int numbers>() { add_panel<numbers, wide_panel>(A, rows, panel, Y); });
}

std::vector<PetscInt> cuts(const Csr& A, PetscInt n)
{
  constexpr PetscInt most_pieces = 16;  // bits of a mask are enough for them
  std::vector<PetscInt> rows;
  const PetscInt least = std::max<PetscInt>(n / most_pieces, 1);
  const std::vector<char> is_free = free_cuts(A, n);
  for (PetscInt i = least, last = 0; i + least <= n; ++i) {
    if (is_free[std::size_t(i)] == 0 || i - last < least) continue;
    rows.push_back(i);
    last = i;
  }
  return rows;
}

std::vector<char> numbers_alike(const Csr& A, PetscInt n)
{
  std::vector<char> n_alike(std::size_t(n), 1);
  for (PetscInt i = n - 1; i-- > 0;) {
    const char next = n_alike[std::size_t(i) + 1];
    if (std::ranges::equal(A.row(i), A.row(i + 1)))
      n_alike[std::size_t(i)] = static_cast<char>(next % most_alike + 1);
  }
  return n_alike;
}

}  // namespace chladni::linear
