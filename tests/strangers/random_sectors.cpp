#include "random_sectors.hpp"

#include <chladni_cms_cyclic.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dice.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "tests/plugin/random_ring.hpp"

namespace chladni::strangers {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;
using reduce::testing::RandomRing;

struct SectorDraw {
  int count, order;
  Vector3d axis;
  std::vector<int> masters, held;
  Reduction how;
  bool is_hub_divided;  ///< some of its rows are masters (or held) that the turn mixes with others
  unsigned ring;
};

Vector3d draw_axis(Dice& dice)
{
  const int kind = dice.integer(0, 4);
  if (kind <= 1) return (dice.chance(0.5) ? 1.0 : -1.0) * Vector3d::Unit(dice.integer(0, 2));
  if (kind == 2) return {1.0, 1.0, 1.0};
  const Vector3d any(dice.uniform(-1.0, 1.0), dice.uniform(-1.0, 1.0), dice.uniform(-1.0, 1.0));
  return kind == 3 ? Vector3d(Vector3d::UnitZ() + 1e-2 * any) : any;
}

/// Rows of the hub: all, none, or some.
std::vector<int> draw_hub(Dice& dice, const std::vector<int>& of)
{
  if (dice.chance(0.4)) return of;
  std::vector<int> some;
  if (dice.chance(0.2))
    for (const int row : of)
      if (dice.chance(0.5)) some.push_back(row);
  return some;
}

/// Whether an oblique axis mixes rows of the hub that are in a set with others that are not. The
/// hub moves in the first two harmonics.
bool divides_hub(const SectorDraw& drawn, const std::vector<int>& rows)
{
  constexpr double none = 1e-12;
  const auto has = [&](int row) { return std::ranges::find(rows, row) != rows.end(); };
  const auto n_of_hub = std::ranges::count_if(rows, [](int row) { return row < 3; });
  const bool is_oblique = drawn.axis.normalized().cwiseAbs().maxCoeff() < 1.0 - none;
  return is_oblique && drawn.order <= 1 && n_of_hub > 0 && !(has(0) && has(1) && has(2));
}

Reduction draw_how(Dice& dice)
{
  const char* types[] = {CMSGUYAN, CMSCRAIGBAMPTON, CMSMIXED, CMSRUBIN};
  const char* type = types[dice.integer(0, 3)];
  if (type == std::string_view(CMSGUYAN)) return {.type = type};
  return {.type = type, .modes = dice.integer(1, 5)};
}

SectorDraw draw_sector(std::uint64_t seed)
{
  Dice dice(seed);
  SectorDraw drawn{.count = dice.integer(2, 7),
                   .order = 0,
                   .axis = draw_axis(dice),
                   .masters = {},
                   .held = {},
                   .how = draw_how(dice),
                   .is_hub_divided = false,
                   .ring = static_cast<unsigned>(dice.integer(1, 1000000))};
  drawn.order = dice.integer(0, drawn.count / 2);
  drawn.masters = draw_hub(dice, {0, 1, 2});
  const double share = dice.chance(0.1) ? 1.0 : dice.uniform(0.0, 0.5);
  std::vector<int> of_nodes;
  for (int row = 3; row < 3 * (1 + RandomRing::n_own); ++row)
    if (dice.chance(share)) of_nodes.push_back(row);
  const std::vector<int> of_hub = drawn.masters;
  drawn.masters.insert(drawn.masters.end(), of_nodes.begin(), of_nodes.end());
  if (dice.chance(0.5)) {
    drawn.held = draw_hub(dice, of_hub);
    for (const int row : of_nodes)
      if (dice.chance(0.3)) drawn.held.push_back(row);
  }
  drawn.is_hub_divided = divides_hub(drawn, drawn.masters) || divides_hub(drawn, drawn.held);
  return drawn;
}

/// Rows that the first rank gives.
template <class Number>
petsc::IndexSet set_of(const std::vector<Number>& rows, MPI_Comm comm)
{
  petsc::IndexSet set;
  const std::vector<PetscInt> all(rows.begin(), rows.end());
  const auto n = petsc::rank(comm) == 0 ? static_cast<PetscInt>(all.size()) : 0;
  petsc::check(ISCreateGeneral(comm, n, all.data(), PETSC_COPY_VALUES, set.put()));
  return set;
}

std::vector<Entry> entries_of(const MatrixXd& A)
{
  std::vector<Entry> entries;
  for (int i = 0; i < A.rows(); ++i)
    for (int j = 0; j < A.cols(); ++j)
      if (A(i, j) != 0.0) entries.push_back({i, j, A(i, j)});
  return entries;
}

MatrixXd replicated_of(Mat A)
{
  petsc::Matrix dense;
  petsc::check(MatConvert(A, MATDENSE, MAT_INITIAL_MATRIX, dense.put()));
  return linear::replicate(dense);
}

/// An orthonormal basis of what a set of rows leaves free.
MatrixXd free_motions(const MatrixXd& rows)
{
  constexpr double dependent = 1e-10;
  const Index n = rows.cols();
  if (rows.rows() == 0) return MatrixXd::Identity(n, n);
  const MatrixXd G = rows.transpose() * rows;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(G);
  const double largest = std::max(eigen.eigenvalues().maxCoeff(), 1e-300);
  return eigen.eigenvectors().leftCols(
      (eigen.eigenvalues().array() <= dependent * largest).count());
}

/// The matrices of a harmonic, and its coordinates in the rows of the sector.
struct Harmonic {
  MatrixXd K, M, x, y;

  explicit Harmonic(CMS cms)
  {
    Mat K_h = nullptr, M_h = nullptr, X = nullptr, Y = nullptr;
    petsc::check(CMSGetHarmonicOperators(cms, &K_h, &M_h, nullptr));
    petsc::check(CMSGetHarmonicCoordinates(cms, &X, &Y));
    K = replicated_of(K_h);
    M = replicated_of(M_h);
    x = replicated_of(X);
    y = Y == nullptr ? MatrixXd::Zero(x.rows(), x.cols()) : replicated_of(Y);
  }
  /// What rows leave free: of the hub they are those of the first sector, whose motion is x; of
  /// other nodes those of each sector.
  MatrixXd free_of(const std::vector<int>& rows) const
  {
    std::vector<int> own;
    for (const int row : rows)
      if (row >= 3) own.push_back(row);
    MatrixXd held(std::ssize(rows) + std::ssize(own), x.cols());
    held << x(rows, Eigen::all), y(own, Eigen::all);
    return free_motions(held);
  }
};

/// Of K, on the motions Z.
int n_without_energy(const MatrixXd& K)
{
  constexpr double none = 1e-9;
  if (K.rows() == 0) return 0;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(K, Eigen::EigenvaluesOnly);
  return static_cast<int>(
      (eigen.eigenvalues().array() <= none * eigen.eigenvalues().maxCoeff()).count());
}

/// The eigenvalues of the harmonic under its support.
Reference exact_harmonic(const Harmonic& harmonic, const std::vector<int>& held)
{
  const MatrixXd Z = harmonic.free_of(held);
  Reference exact{.pencil = {.name = "harmonic"},
                  .K = Z.transpose() * harmonic.K * Z,
                  .M = Z.transpose() * harmonic.M * Z};
  exact.n_free_rigid = n_without_energy(harmonic.K);
  exact.n_rigid = n_without_energy(exact.K);
  exact.whole = spectrum(exact.K, exact.M, exact.n_rigid);
  return exact;
}

/// Why a reduction is impossible; empty where it is not.
std::string impossible(const Harmonic& harmonic, const SectorDraw& drawn)
{
  const MatrixXd Z = harmonic.free_of(drawn.masters);
  if (Z.cols() == 0) return "leave at least one slave";
  if (drawn.how.type == std::string_view(CMSCRAIGBAMPTON) && Z.cols() < drawn.how.modes)
    return "modes asked of";
  return n_without_energy(Z.transpose() * harmonic.K * Z) > 0 ? "not positive definite" : "";
}

/// What CMS says of a draw, and what is true of it.
struct SectorAnswer {
  Answer answer;
  Reference exact{};
  std::string refusal{};  ///< that is due
};

SectorAnswer reduce_sector(const SectorDraw& drawn, MPI_Comm comm)
{
  const RandomRing ring(drawn.count, drawn.axis, drawn.ring);
  const RandomRing::Matrices sector = ring.sector();
  const Pencil pencil{.name = "sector",
                      .n = 3 * RandomRing::n_sector_nodes,
                      .K = entries_of(sector.K),
                      .M = entries_of(sector.M)};
  const Operators A = operators(pencil, comm);
  petsc::Owned<CMS, CMSDestroy> cms;
  petsc::check(CMSCreate(comm, cms.put()));
  petsc::check(CMSSetOperators(cms, A.K, A.M, nullptr));
  petsc::check(set(cms, drawn.how));
  PetscErrorCode code = CMSSetCyclic(cms, drawn.count, set_of(RandomRing::low(), comm),
                                     set_of(RandomRing::high(), comm), 3, ring.rotation().data());
  if (!code) code = CMSSetHarmonic(cms, drawn.order);
  if (!code) code = CMSSetInterface(cms, set_of(drawn.masters, comm));
  if (!code && !drawn.held.empty()) code = CMSSetHeld(cms, set_of(drawn.held, comm));
  if (!code) code = CMSSolve(cms);
  SectorAnswer found{.answer = answer_of(cms, code)};
  if (drawn.is_hub_divided || drawn.masters.empty()) {
    found.refusal =
        drawn.masters.empty() ? "masters" : "name all of them or none|leave at least one slave";
    return found;
  }
  const Harmonic harmonic(cms);
  found.refusal = impossible(harmonic, drawn);
  if (!code) found.exact = exact_harmonic(harmonic, drawn.held);
  return found;
}

/// What must hold of it.
Failures failures_of_sector(const SectorAnswer& found)
{
  if (!found.refusal.empty())
    return check_refusal({.name = "", .refusal = found.refusal}, found.answer);
  if (found.answer.code) return {{"refused-sector", found.answer.message}};
  Failures failures;
  check_spectrum(found.exact, found.answer, failures);
  return failures;
}

std::string words_of_sector(const SectorDraw& drawn)
{
  return fmt::format(
      "{} sectors about ({:.3g}, {:.3g}, {:.3g}), harmonic {}, masters {}, held {}, {} with {} "
      "modes",
      drawn.count, drawn.axis.x(), drawn.axis.y(), drawn.axis.z(), drawn.order,
      fmt::join(drawn.masters, " "), fmt::join(drawn.held, " "), drawn.how.type, drawn.how.modes);
}

/// The same frequencies on all ranks and on one, but for the rounding that both state.
void compare_ranks(const Answer& all, const Answer& one, Failures& failures)
{
  constexpr double same = 1e-9;
  bool is_same = (all.code == 0) == (one.code == 0) && all.lambda.size() == one.lambda.size();
  for (std::size_t i = 0; is_same && i < all.lambda.size(); ++i) {
    is_same = std::abs(all.lambda[i] - one.lambda[i]) <=
              same * one.lambda.back() + (all.rounding_of(i) + one.rounding_of(i)) * one.lambda[i];
  }
  if (is_same) return;
  failures.push_back(
      {"ranks",
       fmt::format("{} {}; one: {} {}; rounding {:.1e}", all.message, fmt::join(all.lambda, " "),
                   one.message, fmt::join(one.lambda, " "), fmt::join(one.rounding, " "))});
}

}  // namespace

SectorTrial try_sector(std::uint64_t seed, MPI_Comm comm)
{
  const SectorDraw drawn = draw_sector(seed);
  const SectorAnswer found = reduce_sector(drawn, comm);
  SectorTrial trial{.words = words_of_sector(drawn), .failures = {}};
  if (petsc::rank(comm) > 0) return trial;
  trial.failures = failures_of_sector(found);
  if (petsc::size(comm) > 1)
    compare_ranks(found.answer, reduce_sector(drawn, PETSC_COMM_SELF).answer, trial.failures);
  return trial;
}

}  // namespace chladni::strangers
