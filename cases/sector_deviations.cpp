#include "cases/sector_deviations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "cases/fe_model.hpp"
#include "cases/sector_model.hpp"
#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "reduce/cyclic/harmonic_coordinates.hpp"
#include "reduce/cyclic/sector.hpp"

namespace chladni::cases {

using cyclic::SparseRows;
using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd;

namespace {

/// What a sector is made of, without the masses and springs that all have.
struct SectorParts {
  std::vector<plate::ShellSection> shells;
  std::vector<plate::PointMass> masses = {};
  std::vector<plate::Spring> springs = {};
};

/// Whether all sectors have the same values in their own places.
bool is_alike_in_sectors(const plate::Profile& profile)
{
  using enum plate::Coordinate;
  if (!profile.formula.empty()) return false;
  return profile.at.empty() || profile.over == radius || profile.over == z;
}

/// The thickness of a deviation that does not say one is that of the perfect sector.
bool has_own_thickness(const scene::Scene& scene, const plate::ShellSection& deviating)
{
  const auto perfect =
      std::ranges::find(scene.sections, deviating.group, &plate::ShellSection::group);
  return !(perfect->thickness == deviating.thickness);
}

bool acts_on(const scene::Deviation& deviation, int sector)
{
  return deviation.sectors.empty() || std::ranges::count(deviation.sectors, sector) > 0;
}

/// The deviations of a sector, and the sector itself where they differ from place to place:
/// sectors of one key deviate alike.
using DeviationKey = std::vector<int>;

DeviationKey key_of(const scene::Scene& scene, int sector)
{
  DeviationKey key;
  bool is_local = false;
  for (int i = 0; i < std::ssize(scene.deviations); ++i) {
    const scene::Deviation& deviation = scene.deviations[std::size_t(i)];
    if (!acts_on(deviation, sector)) continue;
    key.push_back(i);
    is_local = is_local || (deviation.section && has_own_thickness(scene, *deviation.section) &&
                            !is_alike_in_sectors(deviation.section->thickness));
  }
  if (is_local) key.push_back(-1 - sector);
  return key;
}

SectorParts parts_of(const scene::Scene& scene, int sector, int count)
{
  SectorParts parts{.shells = scene.sections};
  for (const scene::Deviation& deviation : scene.deviations) {
    if (!acts_on(deviation, sector)) continue;
    if (deviation.mass) parts.masses.push_back(*deviation.mass);
    if (deviation.spring) parts.springs.push_back(*deviation.spring);
    if (!deviation.section) continue;
    plate::ShellSection& own =
        *std::ranges::find(parts.shells, deviation.section->group, &plate::ShellSection::group);
    own = *deviation.section;
    if (has_own_thickness(scene, own) && !is_alike_in_sectors(own.thickness))
      own.thickness.turned = 2.0 * std::numbers::pi * sector / count;
  }
  return parts;
}

plate::Structure structure_with(const scene::Scene& scene, const SectorParts& parts)
{
  return {.shells = parts.shells,
          .beams = scene.beams,
          .solids = scene.solids,
          .masses = parts.masses,
          .springs = parts.springs};
}

/// K, M and C of the sector, and what its mass needs.
struct AssembledParts {
  SparseRows K, M, C, H;
  std::array<SparseRows, 6> S = {};  ///< as MassIntegrals::products, without zz
  double mass = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  MatrixXd displacement = {};
};

constexpr std::array<std::size_t, 5> products = {0, 1, 3, 4, 5};

AssembledParts assembled(const scene::Scene& scene, const SectorModel& model,
                         const SectorParts& parts)
{
  const plate::Structure structure = structure_with(scene, parts);
  const plate::System system =
      plate::assemble(model.mesh, structure, model.system.dofs, PETSC_COMM_SELF);
  AssembledParts found{.K = cyclic::sparse_rows(system.K),
                       .M = cyclic::sparse_rows(system.M),
                       .C = SparseRows(model.dofs.n_dofs(), model.dofs.n_dofs()),
                       .H = SparseRows(model.dofs.n_dofs(), model.dofs.n_dofs())};
  if (system.C != nullptr) found.C = cyclic::sparse_rows(system.C);
  if (system.H != nullptr) found.H = cyclic::sparse_rows(system.H);
  if (!scene.mass_integrals) return found;
  const plate::MassModel mass =
      plate::mass_model(model.mesh, structure, model.system.dofs, PETSC_COMM_SELF);
  std::vector<plate::Axes> axes;
  for (const std::size_t i : products) axes.push_back(mbs_export::product_axes[i]);
  const auto [moments, S] = plate::inertia_integrals(mass, axes);
  for (std::size_t i = 0; i < products.size(); ++i)
    found.S[products[i]] = cyclic::sparse_rows(S[i]);
  found.mass = moments.mass;
  found.first = moments.first;
  found.second = moments.second;
  found.displacement = linear::replicate(moments.displacement);
  return found;
}

SparseRows difference(const SparseRows& A, const SparseRows& B)
{
  SparseRows rows = A - B;
  rows.prune([](Index, Index, double value) { return value != 0.0; });
  return rows;
}

AssembledParts difference(const AssembledParts& a, const AssembledParts& b)
{
  AssembledParts d{.K = difference(a.K, b.K),
                   .M = difference(a.M, b.M),
                   .C = difference(a.C, b.C),
                   .H = difference(a.H, b.H),
                   .mass = a.mass - b.mass,
                   .first = a.first - b.first,
                   .second = a.second - b.second,
                   .displacement = a.displacement - b.displacement};
  for (const std::size_t i : products)
    if (a.S[i].size() > 0) d.S[i] = difference(a.S[i], b.S[i]);
  return d;
}

void add_rows(const SparseRows& A, std::set<int>& rows)
{
  for (int row = 0; row < A.outerSize(); ++row)
    if (SparseRows::InnerIterator(A, row)) rows.insert(row);
}

/// The rows and columns of a symmetric pattern that are not empty; of C and S the same.
SparseRows compressed(const SparseRows& A, const std::vector<int>& rows)
{
  std::vector<int> place(std::size_t(A.cols()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[std::size_t(rows[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (const int row : rows)
    for (SparseRows::InnerIterator it(A, row); it; ++it)
      entries.emplace_back(place[std::size_t(row)], place[std::size_t(it.index())], it.value());
  SparseRows small(std::ssize(rows), std::ssize(rows));
  small.setFromTriplets(entries.begin(), entries.end());
  return small;
}

DeviatingSector compressed(const AssembledParts& d, int sector, const std::vector<int>& rows)
{
  DeviatingSector deviating{.sector = sector,
                            .K = compressed(d.K, rows),
                            .M = compressed(d.M, rows),
                            .C = compressed(d.C, rows),
                            .H = compressed(d.H, rows),
                            .mass = std::nullopt};
  if (d.displacement.size() == 0 || d.M.nonZeros() == 0) return deviating;
  deviating.mass = {.mass = d.mass,
                    .first = d.first,
                    .second = d.second,
                    .displacement = d.displacement(rows, every),
                    .S = {}};
  for (const std::size_t i : products) deviating.mass->S[i] = compressed(d.S[i], rows);
  return deviating;
}

}  // namespace

SectorDeviations sector_deviations(const scene::Scene& scene, const SectorModel& model)
{
  SectorDeviations deviations;
  if (scene.deviations.empty()) return deviations;
  check_deviations(scene, model);
  const int count = model.dofs.count;
  const AssembledParts perfect = assembled(scene, model, {.shells = scene.sections});
  std::map<DeviationKey, AssembledParts> known;
  std::vector<std::pair<int, DeviationKey>> keys;
  std::set<int> rows;
  for (int sector = 0; sector < count; ++sector) {
    DeviationKey key = key_of(scene, sector);
    if (key.empty()) continue;
    if (!known.contains(key)) {
      known.emplace(key,
                    difference(assembled(scene, model, parts_of(scene, sector, count)), perfect));
      for (const SparseRows* A : {&known[key].K, &known[key].M, &known[key].C, &known[key].H})
        add_rows(*A, rows);
    }
    keys.emplace_back(sector, std::move(key));
  }
  deviations.rows.assign(rows.begin(), rows.end());
  for (const auto& [sector, key] : keys)
    deviations.sectors.push_back(compressed(known.at(key), sector, deviations.rows));
  return deviations;
}

namespace {

/// The motion of the rows in sector j, in its axes.
MatrixXd motion_of(int sector, int count, const std::vector<HarmonicPart>& parts,
                   const std::vector<std::vector<Index>>& places, Index n)
{
  MatrixXd U = MatrixXd::Zero(parts.front().deviating.x.rows(), n);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double phase = 2.0 * std::numbers::pi * parts[p].order * sector / count;
    U(every, places[p]) =
        std::cos(phase) * parts[p].deviating.x - std::sin(phase) * parts[p].deviating.y;
  }
  return U;
}

MatrixXd form_in(const SparseRows& A, const MatrixXd& U)
{
  const MatrixXd AU = A * U;
  return linear::inner_product(U, AU);
}

MatrixXd symmetric_form_in(const SparseRows& A, const MatrixXd& U)
{
  const MatrixXd form = form_in(A, U);
  return 0.5 * (form + form.transpose());
}

/// Of a form that the perfect body may not have at all.
void add_damping(MatrixXd& whole, const SparseRows& A, const MatrixXd& U)
{
  if (A.nonZeros() == 0) return;
  if (whole.size() == 0) whole = MatrixXd::Zero(U.cols(), U.cols());
  whole += symmetric_form_in(A, U);
}

/// S_kl in the global axes, of all k and l but z and z.
MatrixXd turned_product(const std::array<MatrixXd, 6>& own, const Matrix3d& R, std::size_t kl)
{
  const auto [k, l] = mbs_export::product_axes[kl];
  MatrixXd sum = MatrixXd::Zero(own[0].rows(), own[0].cols());
  for (const std::size_t i : products) {
    const auto [p, q] = mbs_export::product_axes[i];
    if (const double w = R(k, p) * R(l, q); w != 0.0) sum += w * own[i];
    if (const double w = R(k, q) * R(l, p); p != q && w != 0.0) sum += w * own[i].transpose();
  }
  return sum;
}

/// @param dM  of the deviation in the coordinates
void add_mass(mbs_export::MassIntegrals& whole, const DeviatingMass& mass, const MatrixXd& U,
              const MatrixXd& dM, const Matrix3d& R)
{
  whole.mass += mass.mass;
  whole.first += R * mass.first;
  whole.second += R * mass.second * R.transpose();
  const MatrixXd moments = mass.displacement.transpose() * U;  // [12 x n]
  whole.displacement += R * moments.topRows<3>();
  for (Index j = 0; j < U.cols(); ++j) {
    const Matrix3d own = moments.col(j).tail<9>().reshaped(3, 3).transpose();
    const Matrix3d turned = R * own * R.transpose();
    whole.position_displacement.col(j) += turned.transpose().reshaped();
  }
  std::array<MatrixXd, 6> own;
  for (const std::size_t i : products) own[i] = form_in(mass.S[i], U);
  std::array<MatrixXd, 6> S;
  for (const std::size_t i : products) S[i] = turned_product(own, R, i);
  for (const std::size_t i : {0, 1}) S[i] = 0.5 * (S[i] + S[i].transpose()).eval();
  S[2] = dM - S[0] - S[1];
  for (std::size_t i = 0; i < S.size(); ++i) whole.products[i] += S[i];
}

/// Of a form that is semidefinite, symmetric to the last bit.
MatrixXd form_in(const MatrixXd& A, const MatrixXd& T)
{
  const MatrixXd form = T.transpose() * (A * T);
  return 0.5 * (form + form.transpose());
}

/// The coordinates of constraint modes and fixed-interface modes of the deviating body, as far as
/// the basis of the perfect one has them: u_m the same, q = S u_m + V q'.
struct OwnModes {
  MatrixXd T;
  Eigen::VectorXd omega;
};

[[noreturn]] void refuse_indefinite()
{
  throw Error(
      "sectors: with its deviations the body has no positive stiffness or mass left; deviations "
      "are "
      "small changes, check their signs and units");
}

/// Round-off forgiven: a free body has motions without stiffness.
bool is_semidefinite(const MatrixXd& A)
{
  constexpr double round_off = 1e-9;
  const Eigen::VectorXd unit = A.diagonal().unaryExpr(
      [](double value) { return value > 0.0 ? 1.0 / std::sqrt(value) : 1.0; });
  const MatrixXd scaled = unit.asDiagonal() * A * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> values(scaled, Eigen::EigenvaluesOnly);
  return values.eigenvalues()[0] > -round_off;
}

OwnModes own_modes(const mbs_export::ReducedSystem& whole)
{
  if (!is_semidefinite(whole.K) || !is_semidefinite(whole.M)) refuse_indefinite();
  const Index n_m = whole.n_masters(), n = whole.K.rows(), n_q = n - n_m;
  OwnModes own{.T = MatrixXd::Identity(n, n), .omega = {}};
  if (n_q == 0) return own;
  const MatrixXd K_qq = whole.K.bottomRightCorner(n_q, n_q);
  const Eigen::LLT<MatrixXd> factor(K_qq);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(
      K_qq, whole.M.bottomRightCorner(n_q, n_q));
  if (factor.info() != Eigen::Success || modes.info() != Eigen::Success ||
      modes.eigenvalues()[0] <= 0.0)
    refuse_indefinite();
  own.T.bottomLeftCorner(n_q, n_m) = -factor.solve(whole.K.bottomLeftCorner(n_q, n_m));
  own.T.bottomRightCorner(n_q, n_q) = modes.eigenvectors();
  own.omega = modes.eigenvalues().cwiseSqrt();
  return own;
}

/// What is known of these coordinates is set, whatever round-off made of it.
void take(mbs_export::ReducedSystem& whole, const OwnModes& own)
{
  const Index n_m = whole.n_masters(), n_q = own.omega.size();
  whole.K = form_in(whole.K, own.T);
  whole.M = form_in(whole.M, own.T);
  for (MatrixXd* A : {&whole.C, &whole.H})
    if (A->size() > 0) *A = form_in(*A, own.T);
  whole.K.topRightCorner(n_m, n_q).setZero();
  whole.K.bottomLeftCorner(n_q, n_m).setZero();
  whole.K.bottomRightCorner(n_q, n_q) = own.omega.cwiseAbs2().asDiagonal();
  whole.M.bottomRightCorner(n_q, n_q).setIdentity();
  whole.fixed_interface_frequencies = own.omega;
  whole.ring_motion->displacements *= own.T;
  for (mbs_export::ResultantModes& resultants : whole.resultants) resultants.S *= own.T;
  if (whole.mass_integrals)
    whole.mass_integrals = mbs_export::in_coordinates(*whole.mass_integrals, own.T);
}

}  // namespace

MatrixXd add_deviations(mbs_export::ReducedSystem& whole, const SectorDeviations& deviations,
                        const std::vector<HarmonicPart>& parts, int count)
{
  if (deviations.sectors.empty()) return {};
  const Index n = whole.K.rows();
  const auto places = places_of(parts, whole.n_masters());
  whole.certificate = {};
  whole.sector_harmonics.reset();
  for (const DeviatingSector& deviating : deviations.sectors) {
    const MatrixXd U = motion_of(deviating.sector, count, parts, places, n);
    const MatrixXd dM = symmetric_form_in(deviating.M, U);
    whole.K += symmetric_form_in(deviating.K, U);
    whole.M += dM;
    add_damping(whole.C, deviating.C, U);
    add_damping(whole.H, deviating.H, U);
    if (deviating.mass) {
      add_mass(*whole.mass_integrals, *deviating.mass, U, dM,
               cyclic::turn_of_sector(deviating.sector, count));
    }
  }
  OwnModes own = own_modes(whole);
  take(whole, own);
  return std::move(own.T);
}

}  // namespace chladni::cases
