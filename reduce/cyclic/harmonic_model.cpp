#include "reduce/cyclic/harmonic_model.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "common/eigen_every.hpp"
#include "reduce/basis.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/cyclic/harmonic_coordinates.hpp"
#include "reduce/support.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cyclic {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

reduce::Body body_of(const SectorMatrices& sector, const HarmonicCoordinates& c)
{
  const auto form = [&](const SparseRows& A) {
    return as_matrix(harmonic_form(A, c), Symmetry::symmetric, sector.comm);
  };
  reduce::Body body{
      .K = form(sector.K), .M = form(sector.M), .masters = {}, .may_lack_masters = true};
  for (const Master& master : c.masters) body.masters.push_back(master.coordinate);
  return body;
}

/// What a form is in masters and exact pairs.
MatrixXd in_pairs(const MatrixXd& A, Index n_m, const MatrixXd& W)
{
  MatrixXd paired(n_m + W.cols(), n_m + W.cols());
  paired.topLeftCorner(n_m, n_m) = A.topLeftCorner(n_m, n_m);
  paired.topRightCorner(n_m, W.cols()) = A.topRightCorner(n_m, W.rows()) * W;
  paired.bottomLeftCorner(W.cols(), n_m) = W.transpose() * A.bottomLeftCorner(W.rows(), n_m);
  paired.bottomRightCorner(W.cols(), W.cols()) =
      W.transpose() * A.bottomRightCorner(W.rows(), W.rows()) * W;
  return paired;
}

/// J in the rows of the model: a permutation with signs.
struct QuarterTurn {
  std::vector<int> partner;
  std::vector<double> sign;
};

QuarterTurn quarter_turn(const HarmonicCoordinates& c, Index n_modes)
{
  std::map<int, int> row_of;
  for (const Master& master : c.masters)
    row_of.emplace(master.coordinate, static_cast<int>(row_of.size()));
  QuarterTurn J;
  for (const Master& master : c.masters) {
    const auto i = static_cast<std::size_t>(master.coordinate);
    J.partner.push_back(row_of.at(c.partner[i]));
    J.sign.push_back(c.sign[i]);
  }
  const auto n_m = static_cast<int>(c.masters.size());
  for (int k = 0; k < n_modes; k += 2) {
    J.partner.insert(J.partner.end(), {n_m + k + 1, n_m + k});
    J.sign.insert(J.sign.end(), {-1.0, 1.0});
  }
  return J;
}

/// (A + J^T A J) / 2: what round-off has taken from the symmetry is put back.
MatrixXd commuting(const MatrixXd& A, const QuarterTurn& J)
{
  MatrixXd sum = A;
  for (Index j = 0; j < A.cols(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) {
      const auto r = static_cast<std::size_t>(i), s = static_cast<std::size_t>(j);
      sum(J.partner[r], J.partner[s]) += J.sign[r] * J.sign[s] * A(i, j);
    }
  }
  return 0.5 * sum;
}

/// The whole harmonic of its symmetric half.
void unfold(HarmonicModel& model)
{
  const MasterHalves masters = master_halves(model.coordinates, *model.half);
  for (MatrixXd* A : {&model.K, &model.M, &model.C, &model.H})
    if (A->size() > 0) *A = unfolded_form(*A, masters);
  const Index n = model.omega.size();
  model.W = MatrixXd::Identity(n, n);
  model.omega = model.omega.transpose().replicate<2, 1>().reshaped().eval();
  model.certificate = unfolded_certificate(model.certificate);
  const QuarterTurn J = quarter_turn(model.coordinates, model.omega.size());
  for (MatrixXd* A : {&model.K, &model.M, &model.C, &model.H})
    if (A->size() > 0) *A = commuting(*A, J);
}

/// Modes in exact pairs, and matrices that commute with J to the last bit.
void make_pairs(HarmonicModel& model, const SectorMatrices& sector)
{
  if (model.half) return unfold(model);
  const HarmonicCoordinates& c = model.coordinates;
  const Index n_m = model.n_masters(), n_modes = model.omega.size();
  model.W = MatrixXd::Identity(n_modes, n_modes);
  if (c.has_one_phase()) return;
  if (n_modes > 0) {
    const petsc::Matrix MJ =
        as_matrix(times_quarter_turn(harmonic_form(sector.M, c), c), Symmetry::none, sector.comm);
    const MatrixXd form = reduce::project_form(model.basis, reduce::split(MJ, model.body.dofs))(
        model.places, model.places);
    ExactPairs pairs = exact_pairs(model.omega, form.bottomRightCorner(n_modes, n_modes));
    model.W = std::move(pairs.W);
    model.omega = std::move(pairs.omega);
  }
  const QuarterTurn J = quarter_turn(c, model.omega.size());
  for (MatrixXd* A : {&model.K, &model.M, &model.C, &model.H})
    if (A->size() > 0) *A = commuting(in_pairs(*A, n_m, model.W), J);
}

/// Modes that only the certificate needed: it says that the harmonic has nothing below them.
void leave_out_modes(HarmonicModel& model)
{
  const Index n_m = model.n_masters();
  for (MatrixXd* A : {&model.K, &model.M, &model.C, &model.H})
    if (A->size() > 0) *A = A->topLeftCorner(n_m, n_m).eval();
  model.W = MatrixXd(model.W.rows(), 0);
  model.omega.resize(0);
}

/// Without masters all methods are the same.
reduce::Method method_of(const HarmonicCoordinates& c, const reduce::ReductionOptions& options)
{
  const reduce::Method method = options.basis.method;
  const bool has_choice = !c.masters.empty() || !reduce::has_free_masters(method);
  return has_choice ? method : reduce::Method::craig_bampton;
}

std::vector<PetscInt> held_masters(const HarmonicCoordinates& c, const IsHeld& is_held)
{
  std::vector<PetscInt> held;
  for (const Master& master : c.masters)
    if (is_held(master)) held.push_back(master.coordinate);
  return held;
}

/// The goal of a harmonic; none where no free master is loaded.
std::optional<reduce::ResponseGoal> response_goal(const HarmonicGoal& goal,
                                                  const HarmonicCoordinates& c,
                                                  const IsHeld& is_held)
{
  std::vector<Master> masters = c.masters;
  std::ranges::sort(masters, {}, &Master::coordinate);
  std::vector<int> held;
  bool is_loaded = false;
  for (std::size_t i = 0; i < masters.size(); ++i)
    if (is_held(masters[i]))
      held.push_back(static_cast<int>(i));
    else
      is_loaded = is_loaded || goal.is_loaded(masters[i]);
  if (!is_loaded) return std::nullopt;
  return reduce::ResponseGoal{
      .Omega = goal.Omega,
      .tolerance = goal.tolerance,
      .loads = [loads = goal.loads, masters, held](const reduce::ReducedModel& model) {
        return loads(model, masters, held);
      }};
}

}  // namespace

HarmonicModel reduce_harmonic(const SectorMatrices& sector, HarmonicCoordinates coordinates,
                              const reduce::ReductionOptions& options, const IsHeld& is_held,
                              reduce::PhaseListener& phases,
                              const std::optional<HarmonicGoal>& goal)
{
  phases.begin("harmonic matrices");
  std::optional<HarmonicCoordinates> half;
  if (coordinates.symmetric.size() > 0) half = symmetric_half(coordinates);
  const HarmonicCoordinates& solved = half ? *half : coordinates;
  reduce::Body whole = body_of(sector, solved);
  const reduce::HeldMasters support(whole.masters, held_masters(solved, is_held));
  reduce::FactoredBody body = reduce::factored(std::move(whole), options, phases);
  reduce::ReductionOptions chosen = options;
  chosen.basis.method = method_of(solved, options);
  chosen.basis.at_least = 1;  // of which the certificate learns that there are none below
  chosen.basis.may_have_none = true;
  chosen.basis.expected = 4;  // a harmonic has few
  if (goal) chosen.responses = response_goal(*goal, solved, is_held);
  reduce::Reduction reduction = reduce::reduction(body, chosen, support, phases);
  std::vector<int> places = reduce::coordinate_places(body.masters, reduction.model);
  HarmonicModel model{.coordinates = std::move(coordinates),
                      .method = chosen.basis.method,
                      .K = reduction.model.K(places, places),
                      .M = reduction.model.M(places, places),
                      .C = {},
                      .H = {},
                      .omega = Eigen::Map<const VectorXd>(reduction.model.omega.data(),
                                                          std::ssize(reduction.model.omega)),
                      .certificate = std::move(reduction.certificate),
                      .half = std::move(half),
                      .body = std::move(body),
                      .basis = std::move(reduction.Q_CB),
                      .places = std::move(places),
                      .W = {}};
  const auto projected = [&](const SparseRows& A) -> MatrixXd {
    if (A.size() == 0) return {};
    const petsc::Matrix form =
        as_matrix(harmonic_form(A, model.solved()), Symmetry::symmetric, sector.comm);
    return reduce::project_form(model.basis, reduce::split(form, model.body.dofs))(model.places,
                                                                                   model.places);
  };
  model.C = projected(sector.C);
  model.H = projected(sector.H);
  phases.begin("pairs");
  make_pairs(model, sector);
  phases.end();
  const double cutoff = 2.0 * std::numbers::pi * options.basis.cutoff_Hz.value_or(0.0);
  const bool are_fixed_interface = !reduce::has_free_masters(model.method);
  if (are_fixed_interface && cutoff > 0.0 && model.omega.size() > 0 && model.omega[0] >= cutoff)
    leave_out_modes(model);
  return model;
}

std::vector<double> lowest_frequencies(const SectorMatrices& sector,
                                       const HarmonicCoordinates& coordinates, int count,
                                       const reduce::ReductionOptions& options,
                                       const IsHeld& is_held)
{
  const bool is_half = coordinates.symmetric.size() > 0;
  const HarmonicCoordinates solved = is_half ? symmetric_half(coordinates) : coordinates;
  reduce::PhaseListener silent;
  const reduce::FactoredBody body = reduce::factored(body_of(sector, solved), options, silent);
  PetscInt n_slaves = 0;
  petsc::check(MatGetSize(body.K_blocks.ss, &n_slaves, nullptr));
  const int n = is_half ? (count + 1) / 2 : count;
  reduce::ReductionOptions lowest = options;
  lowest.basis = {.method = method_of(solved, options), .modes = std::min<int>(n, n_slaves)};
  const reduce::HeldMasters support(body.masters, held_masters(solved, is_held));
  std::vector<double> omega = reduce::lowest_modes(body, lowest, support);
  if (!is_half) return omega;
  std::vector<double> pairs;
  for (const double value : omega) pairs.insert(pairs.end(), 2, value);
  return pairs;
}

SectorMotion sector_motion(const HarmonicModel& model, std::span<const int> dofs)
{
  const HarmonicCoordinates& c = model.solved();
  std::map<int, Index> row_of;
  for (const int dof : dofs) {
    for (const SparseRows* T : {&c.X, &c.Y})
      for (SparseRows::InnerIterator it(*T, dof); it; ++it) row_of.emplace(int(it.index()), 0);
  }
  std::vector<PetscInt> wanted;
  for (auto& [coordinate, row] : row_of) {
    row = std::ssize(wanted);
    wanted.push_back(coordinate);
  }
  const MatrixXd Q = reduce::basis_rows(model.basis, model.body.dofs, wanted)(every, model.places);
  const Index n_m = std::ssize(c.masters), n = n_m + model.W.cols();
  MatrixXd rows(Q.rows(), n);
  rows << Q.leftCols(n_m), Q.rightCols(model.W.rows()) * model.W;
  SectorMotion motion{.x = MatrixXd::Zero(std::ssize(dofs), n),
                      .y = MatrixXd::Zero(std::ssize(dofs), n)};
  for (Index i = 0; i < std::ssize(dofs); ++i) {
    const int dof = dofs[static_cast<std::size_t>(i)];
    for (SparseRows::InnerIterator it(c.X, dof); it; ++it)
      motion.x.row(i) += it.value() * rows.row(row_of.at(int(it.index())));
    for (SparseRows::InnerIterator it(c.Y, dof); it; ++it)
      motion.y.row(i) += it.value() * rows.row(row_of.at(int(it.index())));
  }
  if (!model.half) return motion;
  return unfolded_motion(motion, master_halves(model.coordinates, c));
}

namespace {

/// The end of the modes whose frequency is that of mode `first` to round-off.
Index end_of_cluster(const VectorXd& omega, Index first)
{
  constexpr double close = 1e-6;  // relative; eigenvalues are found to 1e-12 and better
  Index end = first + 1;
  while (end < omega.size() && omega[end] - omega[end - 1] < close * omega[end]) ++end;
  return end;
}

/// v without its parts along the first columns of Q, twice for round-off.
VectorXd orthogonalised(VectorXd v, const MatrixXd& Q, Index n)
{
  for (int pass = 0; pass < 2; ++pass) v -= Q.leftCols(n) * (Q.leftCols(n).transpose() * v);
  return v;
}

/// The unit vector that is furthest from the first columns of Q.
VectorXd next_direction(const MatrixXd& Q, Index n)
{
  Index furthest = 0;
  (VectorXd::Ones(Q.rows()) - Q.leftCols(n).rowwise().squaredNorm()).maxCoeff(&furthest);
  return orthogonalised(VectorXd::Unit(Q.rows(), furthest), Q, n).normalized();
}

/// Orthonormal columns v, S v, v', S v', ...
MatrixXd pairs_of_cluster(const MatrixXd& S)
{
  constexpr double closed = 0.99;  // S v is as long as v where the partner is in the cluster
  MatrixXd Q = MatrixXd::Zero(S.rows(), S.rows());
  Index n = 0;
  while (n + 2 <= S.rows()) {
    const VectorXd v = next_direction(Q, n);
    Q.col(n) = v;
    const VectorXd partner = orthogonalised(S * v, Q, n + 1);
    if (!(partner.norm() > closed)) break;
    Q.col(n + 1) = partner.normalized();
    n += 2;
  }
  return Q.leftCols(n);
}

}  // namespace

ExactPairs exact_pairs(const VectorXd& omega, const MatrixXd& S)
{
  const Index n = omega.size();
  ExactPairs pairs{.W = MatrixXd::Zero(n, n), .omega = VectorXd(n)};
  Index n_paired = 0;
  for (Index first = 0; first < n;) {
    const Index end = end_of_cluster(omega, first), width = end - first;
    const MatrixXd Q = pairs_of_cluster(S.block(first, first, width, width));
    pairs.W.block(first, n_paired, width, Q.cols()) = Q;
    for (Index k = 0; k < Q.cols(); k += 2) {
      const VectorXd lambda = omega.segment(first, width).cwiseAbs2();
      const double mean = 0.5 * (Q.middleCols(k, 2).cwiseAbs2().transpose() * lambda).sum();
      pairs.omega.segment<2>(n_paired + k).setConstant(std::sqrt(mean));
    }
    n_paired += Q.cols();
    first = end;
  }
  pairs.W.conservativeResize(n, n_paired);
  pairs.omega.conservativeResize(n_paired);
  return pairs;
}

namespace {

/// Those in which the modes are solved.
HarmonicCoordinates solved_coordinates(const HarmonicCoordinates& c)
{
  return c.symmetric.size() > 0 ? symmetric_half(c) : c;
}

/// Coordinates that move a held DOF.
std::vector<int> held_coordinates(const HarmonicCoordinates& c, const std::vector<bool>& is_held)
{
  std::vector<bool> moves(std::size_t(c.n()), false);
  for (const SparseRows* T : {&c.X, &c.Y}) {
    for (Index dof = 0; dof < T->rows(); ++dof) {
      if (!is_held[std::size_t(dof)]) continue;
      for (SparseRows::InnerIterator it(*T, dof); it; ++it) moves[std::size_t(it.index())] = true;
    }
  }
  std::vector<int> held;
  for (int i = 0; i < c.n(); ++i)
    if (moves[std::size_t(i)]) held.push_back(i);
  return held;
}

/// The lower triangle without some rows and columns.
Eigen::SparseMatrix<double> lower_without(const SparseRows& A, const std::vector<int>& left_out)
{
  std::vector<int> place(std::size_t(A.rows()), 0);
  for (const int i : left_out) place[std::size_t(i)] = -1;
  int n = 0;
  for (int& i : place)
    if (i == 0) i = n++;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(std::size_t(A.nonZeros()) / 2 + std::size_t(n));
  for (int i = 0; i < A.outerSize(); ++i) {
    if (place[std::size_t(i)] < 0) continue;
    for (SparseRows::InnerIterator a(A, i); a && a.index() <= i; ++a)
      if (const int j = place[std::size_t(a.index())]; j >= 0)
        entries.emplace_back(place[std::size_t(i)], j, a.value());
  }
  Eigen::SparseMatrix<double> lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

MatrixXd first_columns(Mat X, Index n)
{
  PetscInt n_rows = 0, stride = 0;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetSize(X, &n_rows, nullptr));
  petsc::check(MatDenseGetLDA(X, &stride));
  petsc::check(MatDenseGetArrayRead(X, &values));
  MatrixXd columns =
      Eigen::Map<const MatrixXd, 0, Eigen::OuterStride<>>(values, n_rows, n, {stride});
  petsc::check(MatDenseRestoreArrayRead(X, &values));
  return columns;
}

}  // namespace

HarmonicModes harmonic_modes(const SectorMatrices& sector, const HarmonicCoordinates& coordinates,
                             const std::vector<bool>& is_held, const HarmonicModesOptions& options)
{
  const bool is_half = coordinates.symmetric.size() > 0;
  const HarmonicCoordinates c = solved_coordinates(coordinates);
  const std::vector<int> held = held_coordinates(c, is_held);
  HarmonicModes modes{.omega = {},
                      .multiplicity = is_half ? 2 : 1,
                      .motion = {.x = MatrixXd(c.X.rows(), 0), .y = MatrixXd(c.X.rows(), 0)}};
  const int most = (c.n() - static_cast<int>(held.size())) / 3, n = std::min(options.n_modes, most);
  if (n == 0) return modes;
  const petsc::Matrix K = as_matrix(harmonic_form(sector.K, c), Symmetry::symmetric),
                      M = as_matrix(harmonic_form(sector.M, c), Symmetry::symmetric);
  const reduce::NaturalModes found = reduce::natural_modes(
      K, M, reduce::free_dofs(K, held),
      {.n_modes = n, .n_rigid = std::min(options.n_rigid, n), .solver = options.solver});
  const MatrixXd X = first_columns(found.X, n);
  modes.omega.resize(n);
  for (int i = 0; i < n; ++i) {
    modes.omega[i] =
        i < options.n_rigid ? 0.0 : std::sqrt(std::max(found.lambda[std::size_t(i)], 0.0));
  }
  modes.motion = {.x = c.X * X, .y = c.Y * X};
  return modes;
}

bool all_modes_lie_above(const SectorMatrices& sector, const HarmonicCoordinates& coordinates,
                         const std::vector<bool>& is_held, double omega)
{
  constexpr double margin = 1e-6;
  const HarmonicCoordinates c = solved_coordinates(coordinates);
  const double end = omega * (1.0 + margin);
  const SparseRows shifted = harmonic_form(sector.K, c) - end * end * harmonic_form(sector.M, c);
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(
      lower_without(shifted, held_coordinates(c, is_held)));
  return factor.info() == Eigen::Success;
}

}  // namespace chladni::cyclic
