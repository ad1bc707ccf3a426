#include "cases/moving_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <vector>

#include "cases/fe_model.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/inertia.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/assembly/geometric_stiffness.hpp"
#include "plate/assembly/inertia_integrals.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/supported_solutions.hpp"

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd;
using linear::FormSymmetry;

mbs_export::MassIntegrals mass_integrals(const plate::Structure& structure, const FeModel& fe,
                                         const SceneReduction& reduced)
{
  const plate::MassModel model =
      plate::mass_model(fe.mesh, structure, fe.system.dofs, PETSC_COMM_WORLD);
  const plate::MassMoments moments = plate::mass_moments(model);
  const MatrixXd V = reduce::project_vectors(reduced.reduction.Q_CB, reduced.body.dofs,
                                             moments.displacement)(reduced.places, every)
                         .transpose();
  mbs_export::MassIntegrals integrals{.mass = moments.mass,
                                      .first = moments.first,
                                      .second = moments.second,
                                      .displacement = V.topRows<3>(),
                                      .position_displacement = V.bottomRows<9>(),
                                      .products = {}};
  auto& S = integrals.products;
  // Not at once: all of them are larger than M. Of zz: M = S_xx + S_yy + S_zz.
  for (const auto& some : {std::vector<std::size_t>{0, 1, 3}, {4, 5}}) {
    std::vector<plate::Axes> axes;
    for (const std::size_t i : some) axes.push_back(mbs_export::product_axes[i]);
    const std::vector<petsc::Matrix> products = plate::displacement_products(model, axes);
    std::vector<linear::SparseForm> forms;
    for (std::size_t n = 0; n < some.size(); ++n) {
      const bool is_symmetric = axes[n].first == axes[n].second;
      forms.push_back({.A = products[n],
                       .symmetry = is_symmetric ? FormSymmetry::symmetric : FormSymmetry::none});
    }
    const std::vector<MatrixXd> reduced_forms =
        reduce::project_forms(reduced.reduction.Q_CB, reduced.body.dofs, forms);
    for (std::size_t n = 0; n < some.size(); ++n)
      S[some[n]] = reduced_forms[n](reduced.places, reduced.places);
  }
  S[2] = reduced.system.M - S[0] - S[1];
  return integrals;
}

mbs_export::Stiffening stiffening(const scene::Scene& scene, const FeModel& fe,
                                  const SceneReduction& reduced, const StressedStates& stressed)
{
  const plate::Structure structure = structure_of(scene);
  const plate::MassModel model =
      plate::mass_model(fe.mesh, structure, fe.system.dofs, PETSC_COMM_WORLD);
  mbs_export::Stiffening stiffening{.fixed = scene.body.fixed, .loads = stressed.loads, .K = {}};
  for (std::size_t i = 0; i < stressed.loads.size(); ++i) {
    Vec u = nullptr;
    petsc::check(MatDenseGetColumnVecRead(stressed.U, static_cast<PetscInt>(i), &u));
    const petsc::Matrix K =
        plate::geometric_stiffness(model, u, stressed.mass_loads.col(static_cast<Eigen::Index>(i)));
    petsc::check(MatDenseRestoreColumnVecRead(stressed.U, static_cast<PetscInt>(i), &u));
    const Eigen::MatrixXd K_r = projected(reduced, K, linear::FormSymmetry::symmetric);
    stiffening.K.push_back(0.5 * (K_r + K_r.transpose()));
  }
  return stiffening;
}

namespace {

/// The loads that the words of `reduce.stiffening` stand for, in the order of the files.
std::vector<std::string> wanted_loads(const std::vector<std::string>& motions)
{
  static const std::map<std::string, std::vector<int>> parts{{"spin-x", {0}},
                                                             {"spin-y", {1}},
                                                             {"spin-z", {2}},
                                                             {"spin", {0, 1, 2, 3, 4, 5}},
                                                             {"angular-acceleration", {6, 7, 8}},
                                                             {"acceleration", {9, 10, 11}}};
  std::vector<int> numbers;
  for (const std::string& motion : motions)
    numbers.insert(numbers.end(), parts.at(motion).begin(), parts.at(motion).end());
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<std::string> loads;
  for (const int i : numbers)
    loads.push_back(mbs_export::stiffening_loads[static_cast<std::size_t>(i)]);
  return loads;
}

/// What [body] holds in vain is told with its place in the scene.
std::vector<int> held_rows(const scene::Scene& scene, const FeModel& fe)
{
  try {
    return mbs_export::held_dofs(described_system(scene, fe), scene.body.fixed).rows;
  } catch (const mbs_export::BodyOptionError& error) {
    scene::refuse_key(scene, "body." + error.key(), error.why());
  }
}

/// DOFs that the support of the body holds, ascending.
std::vector<int> held_dofs(const scene::Scene& scene, const FeModel& fe)
{
  if (certified_support(scene, fe).size() != scene.body.fixed.size()) {
    throw Error(fmt::format(
        "{}: reduce.stiffening: body.fixed holds nodes of a ring of harmonics; hold nodes whose "
        "DOFs are masters, or take the ring out of interface.rings",
        scene.path));
  }
  std::vector<int> held;
  for (const int row : held_rows(scene, fe))
    held.push_back(fe.attachments.master_dofs[static_cast<std::size_t>(row)]);
  std::ranges::sort(held);
  return held;
}

/// Some rows of a dense matrix, on every rank.
MatrixXd dense_rows(Mat X, const std::vector<int>& rows)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(X, &first, &last));
  const linear::LocalRows local(X);
  MatrixXd found = MatrixXd::Zero(std::ssize(rows), local.n_cols());
  for (Index i = 0; i < found.rows(); ++i) {
    const int row = rows[static_cast<std::size_t>(i)];
    if (row < first || row >= last) continue;
    for (PetscInt j = 0; j < local.n_cols(); ++j) found(i, j) = local(row - first, j);
  }
  linear::sum_over_ranks(linear::values_of(found), petsc::communicator(X));
  return found;
}

/// X S, with the rows of `like`.
petsc::Matrix combined(Mat X, const MatrixXd& S, Mat like)
{
  petsc::Matrix product = linear::uninitialized_dense(like, S.cols());
  petsc::check(MatZeroEntries(product));
  linear::add_product(1.0, X, S, product);
  return product;
}

/// Rigid motions that a support leaves.
struct FreeMotions {
  MatrixXd S;             ///< [6 x r] combinations of plate::rigid_motions
  petsc::Matrix R;        ///< [n_DOFs x r] dense
  std::vector<int> pins;  ///< r DOFs that would hold them
};

/// Combinations S [6 x r] of rigid motions that move masters but not the held ones.
/// @param R_m  [n_m x 6] of the masters, in which a rotation and a translation are comparable
MatrixXd motions_left(const MatrixXd& R_m, const std::vector<int>& held_rows)
{
  constexpr double round_off = 1e-9;
  const Eigen::JacobiSVD<MatrixXd> seen(R_m, Eigen::ComputeThinV);
  const Eigen::VectorXd& sizes = seen.singularValues();
  const Index n_seen = (sizes.array() > round_off * sizes[0]).count();
  const MatrixXd V = seen.matrixV().leftCols(n_seen);
  if (held_rows.empty()) return V;
  const MatrixXd held = R_m(held_rows, every) * V;
  const Eigen::JacobiSVD<MatrixXd> resisted(held, Eigen::ComputeFullV);
  const Index n_held = (resisted.singularValues().array() > round_off * sizes[0]).count();
  return V * resisted.matrixV().rightCols(n_seen - n_held);
}

FreeMotions free_motions(const FeModel& fe, const std::vector<int>& held)
{
  const std::vector<int>& masters = fe.attachments.master_dofs;
  const petsc::Matrix R = plate::rigid_motions(fe.system);
  MatrixXd R_m = dense_rows(R, masters);
  std::vector<int> held_rows;
  for (std::size_t row = 0; row < masters.size(); ++row)
    if (std::ranges::binary_search(held, masters[row])) held_rows.push_back(static_cast<int>(row));
  // Rotations about the centre of the nodes, so that all of the body moves by about 1.
  const double length = std::max(R_m.rightCols(3).cwiseAbs().maxCoeff(), 1e-300);
  Eigen::Vector<double, 6> scale = Eigen::Vector<double, 6>::Ones();
  scale.tail<3>() /= length;
  R_m = R_m * scale.asDiagonal();
  const MatrixXd left = motions_left(R_m, held_rows);
  if (left.cols() == 0) return {};
  // The rows that hold these best; a rotation, which may be one about a shell's normal, last.
  MatrixXd by_rows = (R_m * left).transpose();
  for (Index i = 0; i < by_rows.cols(); ++i)
    if (fe.attachments.masters[std::size_t(i)].component >= 3) by_rows.col(i) *= 1e-2 * length;
  const Eigen::ColPivHouseholderQR<MatrixXd> pivots(by_rows);
  FreeMotions motions{.S = scale.asDiagonal() * left, .R = {}, .pins = {}};
  motions.R = combined(R, motions.S, R);
  for (Index i = 0; i < left.cols(); ++i) {
    motions.pins.push_back(
        masters[static_cast<std::size_t>(pivots.colsPermutation().indices()[i])]);
  }
  return motions;
}

/// F <- F - M R q of the load on a body that it accelerates by R q, q = (R^T M R)^-1 R^T F; a
/// motion without inertia, as that of a line about itself, stays at rest.
/// @return q [r x n_loads]
MatrixXd balance(Mat F, Mat M, Mat R)
{
  constexpr double round_off = 1e-12;
  const petsc::Matrix M_R = linear::uninitialized_dense(M, linear::LocalRows(R).n_cols());
  linear::SparseProduct(M).apply(R, M_R);
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> inertia;
  inertia.setThreshold(round_off);
  inertia.compute(linear::inner_product(R, M_R));
  MatrixXd q = inertia.solve(linear::inner_product(R, F));
  linear::add_product(-1.0, M_R, q, F);
  return q;
}

/// [12 x n_loads]
MatrixXd mass_loads(const std::vector<std::string>& loads)
{
  MatrixXd factors(12, std::ssize(loads));
  for (Index i = 0; i < factors.cols(); ++i)
    factors.col(i) = mass_load(loads[static_cast<std::size_t>(i)]);
  return factors;
}

/// Of mass loads [12 x n_loads].
petsc::Matrix loads_on(const scene::Scene& scene, const FeModel& fe, const MatrixXd& loads)
{
  const plate::Structure structure = structure_of(scene);
  const plate::MassModel model =
      plate::mass_model(fe.mesh, structure, fe.system.dofs, PETSC_COMM_WORLD);
  return combined(plate::mass_moments(model).displacement, loads, fe.system.K);
}

/// Lets the loads accelerate the body in these motions: their inertia becomes a part of the loads.
void accelerate(const FeModel& fe, const FreeMotions& motions, Mat F, StressedStates& stressed)
{
  const MatrixXd accelerations = motions.S * balance(F, fe.system.M, motions.R);
  const Eigen::Vector3d centre = plate::centre_of_nodes(fe.system.dofs);
  for (Index i = 0; i < accelerations.cols(); ++i)
    stressed.mass_loads.col(i) += inertial_load(accelerations.col(i), centre);
}

}  // namespace

Eigen::Vector<double, 12> mass_load(const std::string& load)
{
  const auto& all = mbs_export::stiffening_loads;
  const auto i = std::ranges::find(all, load) - all.begin();
  Eigen::Vector<double, 12> factors = Eigen::Vector<double, 12>::Zero();
  const auto position_along = [&](int k, int l) -> double& { return factors[3 + 3 * k + l]; };
  if (i < 6) {  // -omega x (omega x x) = (omega . omega) x - (omega . x) omega
    const auto [k, l] = mbs_export::product_axes[static_cast<std::size_t>(i)];
    if (k == l)
      for (const int other : {(k + 1) % 3, (k + 2) % 3}) position_along(other, other) = 1.0;
    else
      position_along(k, l) = position_along(l, k) = -1.0;
  } else if (i < 9) {  // -e x x
    const int c = static_cast<int>(i - 6), a = (c + 1) % 3, b = (c + 2) % 3;
    position_along(a, b) = -1.0;
    position_along(b, a) = 1.0;
  } else {
    factors[i - 9] = -1.0;
  }
  return factors;
}

Eigen::Vector<double, 12> inertial_load(const Eigen::Vector<double, 6>& acceleration,
                                        const Eigen::Vector3d& centre)
{
  const Eigen::Vector3d alpha = acceleration.tail<3>();
  Eigen::Vector<double, 12> load;
  load.head<3>() = alpha.cross(centre) - acceleration.head<3>();
  for (int k = 0; k < 3; ++k) load.segment<3>(3 + 3 * k) = -alpha.cross(Eigen::Vector3d::Unit(k));
  return load;
}

StressedStates stressed_states(const scene::Scene& scene, const FeModel& fe,
                               const linear::SolverOptions& options, Phases& phases)
{
  if (scene.stiffening.empty()) return {};
  phases.begin("stress of inertia");
  StressedStates stressed{.loads = wanted_loads(scene.stiffening), .mass_loads = {}, .U = {}};
  stressed.mass_loads = mass_loads(stressed.loads);
  std::vector<int> held = held_dofs(scene, fe);
  const petsc::Matrix F = loads_on(scene, fe, stressed.mass_loads);
  if (geometry_tells_motions(scene, fe)) {
    const FreeMotions motions = free_motions(fe, held);
    if (!motions.pins.empty()) {
      accelerate(fe, motions, F, stressed);
      held.insert(held.end(), motions.pins.begin(), motions.pins.end());
      std::ranges::sort(held);
    }
  }
  try {
    stressed.U =
        reduce::static_solutions(fe.system.K, F, reduce::free_dofs(fe.system.K, held), options);
  } catch (const linear::FreeMotion& motion) {
    throw Error(fmt::format(
        "{}: reduce.stiffening: the body can move under body.fixed = [{}], so that no static "
        "stress belongs to the loads ({}); hold it in [body] fixed",
        scene.path, fmt::join(scene.body.fixed, ", "), motion.what()));
  }
  phases.end();
  return stressed;
}

}  // namespace chladni::cases
