#include "cyclic/harmonic_model.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "common/eigen_every.hpp"
#include "cyclic/exact_pairs.hpp"
#include "cyclic/sparse_rows.hpp"
#include "cyclic/symmetric_half.hpp"
#include "reduce/basis.hpp"
#include "reduce/basis_rows.hpp"
#include "reduce/held_masters.hpp"
#include "reduce/project_form.hpp"

namespace chladni::cyclic {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace chladni::cyclic
