#include "cyclic/harmonic_model.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "common/eigen_every.hpp"
#include "cyclic/exact_pairs.hpp"
#include "cyclic/sparse_rows.hpp"
#include "reduce/basis_rows.hpp"
#include "reduce/held_masters.hpp"
#include "reduce/project_form.hpp"

namespace chladni::cyclic {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

reduce::Body body_of(const SectorMatrices& sector, const HarmonicCoordinates& c)
{
  reduce::Body body{.K = as_matrix(harmonic_form(sector.K, c), Symmetry::symmetric),
                    .M = as_matrix(harmonic_form(sector.M, c), Symmetry::symmetric),
                    .masters = {}};
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

/// Modes in exact pairs, and matrices that commute with J to the last bit.
void make_pairs(HarmonicModel& model)
{
  const HarmonicCoordinates& c = model.coordinates;
  const Index n_m = model.n_masters(), n_modes = model.omega.size();
  model.W = MatrixXd::Identity(n_modes, n_modes);
  if (c.has_one_phase()) return;
  if (n_modes > 0) {
    const petsc::Matrix MJ =
        as_matrix(times_quarter_turn(sparse_rows(model.body.M), c), Symmetry::none);
    const MatrixXd form = reduce::project_form(model.basis, reduce::split(MJ, model.body.dofs))(
        model.places, model.places);
    ExactPairs pairs = exact_pairs(model.omega, form.bottomRightCorner(n_modes, n_modes));
    model.W = std::move(pairs.W);
    model.omega = std::move(pairs.omega);
  }
  const QuarterTurn J = quarter_turn(c, model.omega.size());
  for (MatrixXd* A : {&model.K, &model.M, &model.C})
    if (A->size() > 0) *A = commuting(in_pairs(*A, n_m, model.W), J);
}

/// Fixed-interface modes below a frequency: a few at a time, since a harmonic has few.
int modes_below(double cutoff_Hz, const reduce::FactoredBody& body)
{
  const double cutoff = 2.0 * std::numbers::pi * cutoff_Hz;
  PetscInt n_slaves = 0;
  petsc::check(MatGetSize(body.K_blocks.ss, &n_slaves, nullptr));
  for (int asked = 4;; asked *= 2) {
    const int most = std::min(asked, static_cast<int>(n_slaves));
    const std::vector<double> omega =
        reduce::fixed_interface_modes(body.K_ss, body.M_blocks.ss, {.modes = most}).omega;
    if (omega.back() >= cutoff || std::ssize(omega) >= n_slaves)
      return static_cast<int>(std::ranges::lower_bound(omega, cutoff) - omega.begin());
  }
}

/// Modes that only the certificate needed: it says that the harmonic has nothing below them.
void leave_out_modes(HarmonicModel& model)
{
  const Index n_m = model.n_masters();
  for (MatrixXd* A : {&model.K, &model.M, &model.C})
    if (A->size() > 0) *A = A->topLeftCorner(n_m, n_m).eval();
  model.W = MatrixXd(model.W.rows(), 0);
  model.omega.resize(0);
}

}  // namespace

HarmonicModel reduce_harmonic(const SectorMatrices& sector, HarmonicCoordinates coordinates,
                              const reduce::ReductionOptions& options, const IsHeld& is_held,
                              reduce::PhaseListener& phases)
{
  phases.begin("harmonic matrices");
  reduce::Body whole = body_of(sector, coordinates);
  std::vector<PetscInt> held;
  for (const Master& master : coordinates.masters)
    if (is_held(master)) held.push_back(master.coordinate);
  const reduce::HeldMasters support(whole.masters, std::move(held));
  reduce::FactoredBody body = reduce::factored(std::move(whole), options, phases);
  const int n_below = options.basis.cutoff_Hz ? modes_below(*options.basis.cutoff_Hz, body) : -1;
  const bool beyond = n_below == 0;
  reduce::ReductionOptions chosen = options;
  if (n_below >= 0) {
    chosen.basis.cutoff_Hz.reset();
    chosen.basis.modes = std::max(n_below, 1);
  }
  reduce::Reduction reduction = reduce::reduction(body, chosen, support, phases);
  std::vector<int> places = reduce::coordinate_places(body.masters, reduction.model);
  HarmonicModel model{.coordinates = std::move(coordinates),
                      .K = reduction.model.K(places, places),
                      .M = reduction.model.M(places, places),
                      .C = {},
                      .omega = Eigen::Map<const VectorXd>(reduction.model.omega.data(),
                                                          std::ssize(reduction.model.omega)),
                      .certificate = std::move(reduction.certificate),
                      .body = std::move(body),
                      .basis = std::move(reduction.Q_CB),
                      .places = std::move(places),
                      .W = {}};
  if (sector.C.size() > 0) {
    const petsc::Matrix C =
        as_matrix(harmonic_form(sector.C, model.coordinates), Symmetry::symmetric);
    model.C = reduce::project_form(model.basis, reduce::split(C, model.body.dofs))(model.places,
                                                                                   model.places);
  }
  phases.begin("pairs");
  make_pairs(model);
  phases.end();
  if (beyond) leave_out_modes(model);
  return model;
}

std::vector<double> lowest_held_frequencies(const SectorMatrices& sector,
                                            const HarmonicCoordinates& coordinates, int count,
                                            const reduce::ReductionOptions& options)
{
  reduce::PhaseListener silent;
  const reduce::FactoredBody body = reduce::factored(body_of(sector, coordinates), options, silent);
  PetscInt n_slaves = 0;
  petsc::check(MatGetSize(body.K_blocks.ss, &n_slaves, nullptr));
  reduce::ReduceOptions wanted{.modes = std::min(count, static_cast<int>(n_slaves))};
  return reduce::fixed_interface_modes(body.K_ss, body.M_blocks.ss, wanted).omega;
}

SectorMotion sector_motion(const HarmonicModel& model, std::span<const int> dofs)
{
  const HarmonicCoordinates& c = model.coordinates;
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
  const Index n_m = model.n_masters(), n = n_m + model.W.cols();
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
  return motion;
}

}  // namespace chladni::cyclic
