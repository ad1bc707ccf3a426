#include "mbs_export/check_body.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/free_modes.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

using check_parts::bounded, check_parts::expected, check_parts::relative_eigenvalues;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// The nodes of the body with all of their components, as the geometry of a reduced system: rows as
/// those of `attachment_modes`.
ReducedSystem geometry_of(const ModalBody& body)
{
  ReducedSystem geometry{};
  geometry.attachment_nodes = body.attachment_nodes;
  geometry.sets = body.sets;
  const int n_nodes = static_cast<int>(body.attachment_nodes.size());
  for (int node = 0; node < n_nodes; ++node)
    for (int component = 0; component < 6; ++component)
      geometry.masters.push_back({node, component});
  geometry.M = MatrixXd::Zero(Index{6} * n_nodes, 1);  // for its number of rows
  return geometry;
}

void add_counts(std::vector<Check>& checks, const ModalBody& body)
{
  const auto n_zero = static_cast<double>((body.omega.array() == 0.0).count());
  const auto n_rigid = static_cast<double>(std::ranges::count(body.kinds, ModeKind::rigid));
  checks.push_back(expected("rigid modes", n_rigid, n_zero, Verdict::fail,
                            "modes of kind 'rigid' against frequencies of zero"));
  checks.push_back(
      {"free rigid motions", n_rigid <= body.n_free_rigid ? Verdict::pass : Verdict::fail, n_rigid,
       static_cast<double>(body.n_free_rigid), "at most what the supports leave free"});
  const auto n_free = static_cast<double>((body.free_frequencies.array() == 0.0).count());
  checks.push_back(expected("rigid modes when free", n_free, body.n_rigid, Verdict::fail,
                            "zero frequencies of the free body against its count"));
}

/// The i-th frequency on a part of the space and under constraints is not below the free one.
void add_frequencies(std::vector<Check>& checks, const ModalBody& body)
{
  const Index n = std::min(body.omega.size(), body.free_frequencies.size());
  const Eigen::ArrayXd kept = body.omega.head(n), free = body.free_frequencies.head(n);
  double shortfall = n < body.omega.size() ? 1.0 : 0.0;  // more modes than the body has
  for (Index i = 0; i < n; ++i)
    if (kept[i] < free[i]) shortfall = std::max(shortfall, 1.0 - kept[i] / free[i]);
  checks.push_back(bounded("frequencies", shortfall, 1e-6,
                           "none below that of the free body with the same number"));
  checks.push_back(bounded("rigid-body energy", body.preparation.rigid_residual, 1e-6,
                           "of the rigid modes over the first elastic omega^2"));
}

/// Rigid modes are rigid motions, R A, and M-orthonormal: A^T J A = I with the 6 x 6 mass matrix J.
void add_rigid_modes(std::vector<Check>& checks, const ModalBody& body)
{
  const Index n = std::ranges::count(body.kinds, ModeKind::rigid);
  if (n == 0 || body.omega.size() < n) return;
  const MatrixXd Phi = body.attachment_modes.leftCols(n);  // frequencies ascend
  const MatrixXd R = rigid_body_vectors(geometry_of(body), body.centre_of_mass);
  VectorXd carried = VectorXd::Zero(Phi.rows());  // components that no mode moves are not masters
  for (Index row = 0; row < Phi.rows(); ++row)
    carried[row] = body.attachment_modes.row(row).isZero() ? 0.0 : 1.0;
  const MatrixXd R_carried = carried.asDiagonal() * R;
  const MatrixXd A = linear::least_squares(R_carried, Phi);
  const double misfit = (R_carried * A - Phi).norm() / Phi.norm();
  checks.push_back(
      bounded("shape of rigid modes", misfit, 1e-6, "distance from rigid motions of the nodes"));
  if (n != 6) return;  // the others may lack components that the inertia counts
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Zero();
  J.diagonal().head<3>().setConstant(body.mass);
  J.bottomRightCorner<3, 3>() = body.inertia;
  const MatrixXd error = A.transpose() * J * A - MatrixXd::Identity(n, n);
  checks.push_back(bounded("orthogonality of modes", error.cwiseAbs().maxCoeff(), 1e-6,
                           "rigid modes in mass, centre and inertia"));
}

/// Metres against radians do no harm, so rows of unit length count where the file knows them.
void add_condition(std::vector<Check>& checks, const ModalBody& body)
{
  const bool unit_rows = body.preparation.condition_directions.has_value();
  Check check = bounded("condition of Q_dd",
                        body.preparation.condition_directions.value_or(body.condition_Q_dd), 1e6,
                        unit_rows ? "rows of unit length; another choice of supports lowers it"
                                  : "in m and rad, which may be all that is wrong with it");
  if (!unit_rows) check.verdict = std::min(check.verdict, Verdict::warn);
  checks.push_back(check);
}

void add_held_displacements(std::vector<Check>& checks, const ModalBody& body)
{
  if (body.fixed.empty()) return;
  const HeldDofs held = held_dofs(geometry_of(body), body.fixed);
  // Where all are held, round-off is all that there is to compare them with.
  if (std::ssize(held.dofs) == body.attachment_modes.rows()) return;
  double largest = 0.0;
  for (const int row : held.dofs)
    largest = std::max(largest, body.attachment_modes.row(row).cwiseAbs().maxCoeff());
  const double scale = body.attachment_modes.cwiseAbs().maxCoeff();
  checks.push_back(bounded("held displacements", scale > 0.0 ? largest / scale : 0.0, 1e-7,
                           "largest one over the largest of all"));
}

void add_supports(std::vector<Check>& checks, const ModalBody& body)
{
  add_held_displacements(checks, body);
  add_condition(checks, body);
}

void add_inertia(std::vector<Check>& checks, const ModalBody& body)
{
  checks.push_back(
      {"mass, kg", body.mass > 0.0 ? Verdict::pass : Verdict::fail, body.mass, 0.0, "more than"});
  // Where components are missing, so is part of the inertia.
  if (body.n_rigid == 6) checks.push_back(check_parts::check_inertia(body.inertia));
}

void add_damping(std::vector<Check>& checks, const ModalBody& body)
{
  for (const auto& [name, A] : {std::pair{"C", &body.C}, std::pair{"H", &body.H}}) {
    if (A->size() == 0) continue;
    checks.push_back(bounded(std::string("symmetry of ") + name, check_parts::asymmetry(*A), 1e-8,
                             "largest |A_ij - A_ji| over sqrt(A_ii A_jj)"));
    const VectorXd c = check_parts::relative_eigenvalues(*A);
    const double negative = c.size() > 0 ? std::max(0.0, -c[0]) : 0.0;
    checks.push_back({std::string("definiteness of ") + name,
                      negative <= 1e-8 ? Verdict::pass : Verdict::warn, negative, 1e-8,
                      "a negative eigenvalue feeds energy into the body"});
  }
}

double difference(const MatrixXd& A, const MatrixXd& B)
{
  if (A.rows() != B.rows() || A.cols() != B.cols()) return 1.0;
  const double scale = std::max(A.cwiseAbs().maxCoeff(), B.cwiseAbs().maxCoeff());
  return scale > 0.0 ? (A - B).cwiseAbs().maxCoeff() / scale : 0.0;
}

/// Friction acts on a disc through its slopes, which are the rotations of the nodes of a ring
/// unless a study takes them from displacements.
Check check_slopes(const ContactRing& ring)
{
  const double rotations = ring.W_r.norm() + ring.W_t.norm();
  const bool missing = rotations == 0.0 && ring.W.norm() > 0.0;
  return {
      "slopes of ring " + ring.name, missing ? Verdict::warn : Verdict::pass, rotations, 0.0,
      "rotations of its nodes; without them [squeal] needs slopes_from or a ring in each plane"};
}

/// The rings that follow from sets, nodes and modes are those of the body.
void add_rings(std::vector<Check>& checks, const ModalBody& body)
{
  const std::vector<ContactRing> rings = contact_rings(geometry_of(body), body.attachment_modes);
  for (const ContactRing& ring : body.rings) {
    const auto same = std::ranges::find(rings, ring.name, &ContactRing::name);
    double error = 1.0;
    if (same != rings.end() && same->nodes == ring.nodes) {
      error = std::max({std::abs(same->radius / ring.radius - 1.0),
                        std::abs(same->height - ring.height) / ring.radius,
                        difference(same->angles, ring.angles), difference(same->W, ring.W),
                        difference(same->W_r, ring.W_r), difference(same->W_t, ring.W_t)});
    }
    checks.push_back(bounded("ring " + ring.name, error, 1e-9,
                             "against positions and modes of its attachment nodes"));
    checks.push_back(check_slopes(ring));
  }
}

}  // namespace

std::vector<Check> check_body(const ModalBody& body)
{
  std::vector<Check> checks;
  add_counts(checks, body);
  add_frequencies(checks, body);
  add_rigid_modes(checks, body);
  add_supports(checks, body);
  add_inertia(checks, body);
  add_damping(checks, body);
  if (body.mass_integrals) {
    checks.push_back(check_parts::check_mass_integrals(
        *body.mass_integrals, MatrixXd::Identity(body.n_modes(), body.n_modes())));
  }
  if (body.stiffening) checks.push_back(check_parts::check_stiffening(*body.stiffening));
  add_rings(checks, body);
  return checks;
}

Verdict worst(const std::vector<Check>& checks)
{
  Verdict verdict = Verdict::pass;
  for (const Check& check : checks) verdict = std::max(verdict, check.verdict);
  return verdict;
}

namespace check_parts {

Check bounded(const std::string& name, double value, double limit, const std::string& meaning)
{
  const Verdict verdict = !(value <= limit)      ? Verdict::fail
                          : value > 1e-2 * limit ? Verdict::warn
                                                 : Verdict::pass;
  return {name, verdict, value, limit, meaning};
}

Check expected(const std::string& name, double value, double limit, Verdict otherwise,
               const std::string& meaning)
{
  return {name, value == limit ? Verdict::pass : otherwise, value, limit, meaning};
}

double asymmetry(const MatrixXd& A)
{
  if (A.size() == 0) return 0.0;
  const VectorXd scale = A.diagonal().cwiseAbs().cwiseSqrt();
  const double round_off = 1e-14 * A.cwiseAbs().maxCoeff();
  double largest = 0.0;
  for (Index j = 0; j < A.cols(); ++j)
    for (Index i = 0; i < j; ++i) {
      const double difference = std::abs(A(i, j) - A(j, i));
      if (difference > round_off)
        largest = std::max(largest, difference / (scale[i] * scale[j] + round_off));
    }
  return largest;
}

MatrixXd unit_diagonal(const MatrixXd& A)
{
  const double largest = A.size() > 0 ? std::sqrt(A.diagonal().cwiseAbs().maxCoeff()) : 0.0;
  if (largest == 0.0) return A;
  VectorXd scale = VectorXd::Constant(A.rows(), 1.0 / largest);
  for (Index i = 0; i < A.rows(); ++i)
    if (A(i, i) > 0.0) scale[i] = 1.0 / std::sqrt(A(i, i));
  return scale.asDiagonal() * A * scale.asDiagonal();
}

VectorXd relative_eigenvalues(const MatrixXd& A)
{
  if (A.size() == 0) return {};
  const MatrixXd symmetric = 0.5 * (A + A.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  return largest > 0.0 ? VectorXd(solver.eigenvalues() / largest) : VectorXd();
}

Check check_inertia(const Eigen::Matrix3d& inertia)
{
  const Eigen::Matrix3d symmetric = 0.5 * (inertia + inertia.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric);
  const Eigen::Vector3d& J = solver.eigenvalues();
  const double size = J.cwiseAbs().maxCoeff();
  const double asymmetric = (inertia - symmetric).cwiseAbs().maxCoeff();
  const double excess = std::max({-J[0], J[2] - J[1] - J[0], asymmetric, 0.0});
  return bounded("inertia", size > 0.0 ? excess / size : 1.0, 1e-6,
                 "excess of the largest principal moment over the sum of the others");
}

Check check_mass_integrals(const MassIntegrals& integrals, const MatrixXd& M)
{
  const auto& S = integrals.products;
  const MatrixXd difference = S[0] + S[1] + S[2] - M;
  const Eigen::VectorXd scale = M.diagonal().cwiseMax(1e-14 * M.diagonal().maxCoeff());
  const Eigen::VectorXd s = scale.cwiseSqrt().cwiseInverse();
  return bounded("mass integrals",
                 (s.asDiagonal() * difference * s.asDiagonal()).cwiseAbs().maxCoeff(), 1e-8,
                 "S_xx + S_yy + S_zz against M over sqrt(M_ii M_jj)");
}

Check check_stiffening(const Stiffening& stiffening)
{
  double largest = 0.0;
  for (const MatrixXd& K : stiffening.K) {
    const double size = K.cwiseAbs().maxCoeff();
    if (size != 0.0) largest = std::max(largest, (K - K.transpose()).cwiseAbs().maxCoeff() / size);
  }
  return bounded("geometric stiffness", largest, 1e-10,
                 "largest |A_ij - A_ji| over the largest entry of each matrix");
}

double characteristic_length(const std::vector<AttachmentNode>& nodes)
{
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const AttachmentNode& node : nodes) centre += node.position;
  centre /= static_cast<double>(std::max<std::size_t>(1, nodes.size()));
  double sum = 0.0;
  for (const AttachmentNode& node : nodes) sum += (node.position - centre).squaredNorm();
  const double length =
      std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, nodes.size())));
  return length > 0.0 ? length : 1.0;
}

}  // namespace check_parts

namespace {

constexpr double any_value = std::numeric_limits<double>::quiet_NaN();
constexpr double zero_energy = 1e-9;  // of the largest eigenvalue of K with unit diagonal
constexpr double massless = 1e-12;    // of the largest eigenvalue of M in kg
constexpr double held_motion = 1e-3;  // of the first elastic omega^2: a support, not an error

/// M in kg throughout: rotations by the size of the body, modes by its mass.
MatrixXd mass_in_kg(const ReducedSystem& reduced)
{
  const double mass = rigid_inertia(reduced).mass;
  VectorXd scale = VectorXd::Constant(reduced.M.rows(), mass > 0.0 ? std::sqrt(mass) : 1.0);
  const double length = check_parts::characteristic_length(reduced.attachment_nodes);
  for (Index row = 0; row < reduced.n_masters(); ++row)
    scale[row] = reduced.masters[std::size_t(row)].component < 3 ? 1.0 : 1.0 / length;
  return scale.asDiagonal() * reduced.M * scale.asDiagonal();
}

/// Negative part of the lowest eigenvalue over the largest one.
double indefiniteness(const VectorXd& relative)
{
  return relative.size() > 0 ? std::max(0.0, -relative[0]) : 1.0;
}

/// K in the directions without mass, over its largest entry there: where it vanishes too, the
/// pencil (K, M) is singular.
double stiffness_of_massless(const ReducedSystem& reduced)
{
  const MatrixXd M = mass_in_kg(reduced), K = check_parts::unit_diagonal(reduced.K);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> mass(MatrixXd(0.5 * (M + M.transpose())));
  const Index n = (mass.eigenvalues().array() <= massless * mass.eigenvalues().maxCoeff()).count();
  if (n == 0) return 1.0;
  const MatrixXd Z = mass.eigenvectors().leftCols(n);
  const VectorXd relative = relative_eigenvalues(Z.transpose() * K * Z);
  return relative.size() > 0 ? relative[0] : 0.0;
}

void add_definiteness(std::vector<Check>& checks, const ReducedSystem& reduced)
{
  const VectorXd k = relative_eigenvalues(check_parts::unit_diagonal(reduced.K));
  const VectorXd m = relative_eigenvalues(mass_in_kg(reduced));
  checks.push_back(bounded("definiteness of K", indefiniteness(k), 1e-8,
                           "most negative eigenvalue over the largest, unit diagonal"));
  checks.push_back(bounded("definiteness of M", indefiniteness(m), 1e-8,
                           "most negative eigenvalue over the largest, in kg"));
  const auto n_massless = static_cast<double>((m.array() <= massless).count());
  checks.push_back({"massless directions", Verdict::pass, n_massless, any_value,
                    "allowed where K resists them; the modes cannot carry them"});
  const double stiffness = stiffness_of_massless(reduced);
  checks.push_back({"their stiffness", stiffness > 1e-12 ? Verdict::pass : Verdict::fail, stiffness,
                    1e-12, "at least; zero makes the pencil (K, M) singular"});
  const auto condition = [](const VectorXd& relative, double threshold) {
    const auto above = (relative.array() > threshold).select(relative.array(), 1.0);
    return relative.size() > 0 ? 1.0 / above.minCoeff() : 1.0;
  };
  const auto add_condition = [&](const std::string& name, double value) {
    checks.push_back({name, value <= 1e8 ? Verdict::pass : Verdict::warn, value, 1e8,
                      "of what is not zero; many digits are lost beyond"});
  };
  add_condition("condition of K", condition(k, zero_energy));
  add_condition("condition of M", condition(m, massless));
}

/// A mass-orthonormal basis of the rigid-body motions that the masters can show; nothing when M
/// gives one of them no mass.
std::optional<MatrixXd> orthonormal_rigid_basis(const ReducedSystem& reduced)
{
  MatrixXd R = rigid_body_vectors(reduced, centre_of_nodes(reduced));
  R.rightCols(3) /= check_parts::characteristic_length(reduced.attachment_nodes);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(MatrixXd(R.transpose() * R));
  const Index rank = (gram.eigenvalues().array() > 1e-12 * gram.eigenvalues().maxCoeff()).count();
  const MatrixXd basis = R * gram.eigenvectors().rightCols(rank);
  const Eigen::LLT<MatrixXd> mass(MatrixXd(basis.transpose() * reduced.M * basis));
  if (mass.info() != Eigen::Success) return std::nullopt;
  return MatrixXd(mass.matrixL().solve(basis.transpose()).transpose());
}

/// First elastic omega^2 of the body with its rigid motions made free, rad^2/s^2.
double first_elastic(const ReducedSystem& reduced, const MatrixXd& B)
{
  const MatrixXd P =
      MatrixXd::Identity(reduced.K.rows(), reduced.K.rows()) - B * (B.transpose() * reduced.M);
  const MatrixXd K = P.transpose() * reduced.K * P;
  try {
    const linear::Eigenmodes modes = linear::eigenmodes(0.5 * (K + K.transpose()), reduced.M, B);
    if (modes.lambda.size() > 0) return modes.lambda[0];
  } catch (const Error&) {  // a mechanism; it has a check of its own
  }
  const Eigen::ArrayXd ratio =
      (reduced.M.diagonal().array() > 0.0)
          .select(K.diagonal().array() / reduced.M.diagonal().array(), 0.0);
  return ratio.maxCoeff() > 0.0 ? ratio.maxCoeff() : 1.0;
}

/// The 6 x 6 mass matrix of rigid motions against [m I, -m c~; m c~, J], over m and m times the
/// size of the body.
double rigid_mass_error(const ReducedSystem& reduced, const RigidInertia& rigid)
{
  const Eigen::Vector3d point = centre_of_nodes(reduced), arm = rigid.centre_of_mass - point;
  const auto R = rigid_body_vectors(reduced, point);
  const Eigen::Matrix<double, 6, 6> J = R.transpose() * reduced.M * R;
  const double length = check_parts::characteristic_length(reduced.attachment_nodes);
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (R.col(i).isZero()) continue;
    for (int k = 0; k < 3; ++k) {
      // Unit translation i against translation k, and against rotation k: m (e_k x arm)_i.
      const double first = Eigen::Vector3d::Unit(k).cross(arm)[i];
      const double translation = R.col(k).isZero() ? 0.0 : J(i, k) - (i == k) * rigid.mass;
      const double rotation = R.col(3 + k).isZero() ? 0.0 : J(i, 3 + k) - rigid.mass * first;
      largest = std::max({largest, std::abs(translation), std::abs(rotation) / length});
    }
  }
  return largest / rigid.mass;
}

void add_mass(std::vector<Check>& checks, const ReducedSystem& reduced, Index n_motions)
{
  const RigidInertia rigid = rigid_inertia(reduced);
  checks.push_back(
      {"mass, kg", rigid.mass > 0.0 ? Verdict::pass : Verdict::fail, rigid.mass, 0.0, "more than"});
  checks.push_back(bounded("mass of rigid motions", rigid_mass_error(reduced, rigid), 1e-6,
                           "the same along all axes, first moment antisymmetric"));
  if (n_motions == 6) checks.push_back(check_parts::check_inertia(rigid.inertia));
}

/// Rigid motions strain nothing: S B against the largest entries of S and of B.
void add_resultants(std::vector<Check>& checks, const ReducedSystem& reduced, const MatrixXd& B)
{
  for (const ResultantModes& resultants : reduced.resultants) {
    const double scale = resultants.S.cwiseAbs().maxCoeff() * B.cwiseAbs().maxCoeff();
    const double largest = (resultants.S * B).cwiseAbs().maxCoeff();
    checks.push_back(bounded("resultants " + resultants.name, scale > 0.0 ? largest / scale : 0.0,
                             1e-8, "of rigid motions, over the largest of all"));
  }
}

/// int phi dm is what a unit translation has of M, and int x dm of the whole body.
double momentum_error(const ReducedSystem& reduced, const RigidInertia& rigid)
{
  const MassIntegrals& integrals = *reduced.mass_integrals;
  const auto R = rigid_body_vectors(reduced, centre_of_nodes(reduced));
  double largest = std::abs(integrals.mass - rigid.mass) / rigid.mass;
  for (int k = 0; k < 3; ++k) {
    if (R.col(k).isZero()) continue;
    const VectorXd row = reduced.M * R.col(k);
    const VectorXd difference = integrals.displacement.row(k).transpose() - row;
    largest = std::max(largest, difference.cwiseAbs().maxCoeff() / row.cwiseAbs().maxCoeff());
  }
  return largest;
}

void add_mass_integrals(std::vector<Check>& checks, const ReducedSystem& reduced)
{
  if (!reduced.mass_integrals) return;
  checks.push_back(check_parts::check_mass_integrals(*reduced.mass_integrals, reduced.M));
  const RigidInertia rigid = rigid_inertia(reduced);
  if (!(rigid.mass > 0.0)) return;
  checks.push_back(bounded("momentum of coordinates", momentum_error(reduced, rigid), 1e-8,
                           "integrals over the mass against M times unit translations"));
}

/// Motions that K does not resist but by rounding, which those that are expected to be free tell:
/// plates on springs that are softer by many orders of magnitude are sound.
Index n_without_energy(const ReducedSystem& reduced, Index n_expected)
{
  constexpr double least = 1e-13, above_rounding = 30.0;
  const VectorXd k = relative_eigenvalues(check_parts::unit_diagonal(reduced.K));
  const Index n = std::min(n_expected, k.size());
  const double rounding = n > 0 ? k.head(n).cwiseAbs().maxCoeff() : 0.0;
  return (k.array() < std::clamp(above_rounding * rounding, least, zero_energy)).count();
}

void add_rigid_motions(std::vector<Check>& checks, const ReducedSystem& reduced)
{
  const std::optional<MatrixXd> B = orthonormal_rigid_basis(reduced);
  if (!B) {
    checks.push_back({"mass, kg", Verdict::fail, rigid_inertia(reduced).mass, 0.0,
                      "M gives a rigid-body motion no mass"});
    return;
  }
  const MatrixXd energy = B->transpose() * reduced.K * *B;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
      MatrixXd(0.5 * (energy + energy.transpose())));
  const Eigen::ArrayXd ratio = solver.eigenvalues().array().abs() / first_elastic(reduced, *B);
  const Index n_held = (ratio > held_motion).count();
  checks.push_back(bounded("rigid-body energy", (ratio > held_motion).select(0.0, ratio).maxCoeff(),
                           1e-6, "K against rigid motion over the first elastic omega^2"));
  checks.push_back(expected("grounding", static_cast<double>(n_held), 0.0, Verdict::warn,
                            "rigid motions that K resists: held to ground, or masters missing"));
  const Index n_expected = B->cols() - n_held;
  checks.push_back(expected("rigid modes",
                            static_cast<double>(n_without_energy(reduced, n_expected)),
                            static_cast<double>(n_expected), Verdict::fail,
                            "zero-energy motions; more than expected are mechanisms"));
  if (n_held == 0) add_mass(checks, reduced, B->cols());
  add_resultants(checks, reduced, *B);
}

/// K_qq = diag(omega^2), K_mq = 0, and M_qq = I but for files of version 0.2 by MacNeal's method,
/// which had no more mass than its free modes.
void add_fixed_interface_modes(std::vector<Check>& checks, const ReducedSystem& reduced)
{
  const VectorXd& omega = reduced.fixed_interface_frequencies;
  const Index n_m = reduced.n_masters(), n = omega.size();
  if (n == 0) return;
  const VectorXd s = omega.cwiseInverse();
  const MatrixXd K_qq = s.asDiagonal() * reduced.K.bottomRightCorner(n, n) * s.asDiagonal();
  const MatrixXd K_mq = reduced.K.topRightCorner(n_m, n) * s.asDiagonal();
  const MatrixXd I = MatrixXd::Identity(n, n);
  const double stiffness = n_m > 0 ? std::sqrt(reduced.K.diagonal().head(n_m).maxCoeff()) : 0.0;
  const double error = std::max((K_qq - I).cwiseAbs().maxCoeff(),
                                stiffness > 0.0 ? K_mq.cwiseAbs().maxCoeff() / stiffness : 0.0);
  checks.push_back(bounded("fixed-interface modes", error, 1e-8,
                           "their stiffness is omega^2, and none to the masters"));
  const MatrixXd M_qq = reduced.M.bottomRightCorner(n, n);
  Check mass = bounded("mass of these modes", (M_qq - I).cwiseAbs().maxCoeff(), 1e-8,
                       "1 for each; less of some after MacNeal's method");
  // What is missing may be MacNeal's doing, what is too much may not.
  const VectorXd excess = relative_eigenvalues(I - M_qq);
  if (mass.verdict == Verdict::fail && excess.size() > 0 && excess[0] > -1e-8)
    mass.verdict = Verdict::warn;
  checks.push_back(mass);
}

void add_free_modes(std::vector<Check>& checks, const ReducedSystem& reduced)
{
  const std::string name = "orthogonality of modes";
  try {
    const FreeModes modes = orthogonalize(reduced);
    const MatrixXd I = MatrixXd::Identity(modes.omega.size(), modes.omega.size());
    const MatrixXd error = modes.Q_e.transpose() * reduced.M * modes.Q_e - I;
    checks.push_back(bounded(name, error.cwiseAbs().maxCoeff(), 1e-8,
                             "largest entry of Q_e^T M Q_e - I of the free modes"));
  } catch (const Error& error) {
    checks.push_back({name, Verdict::fail, any_value, 1e-8, error.what()});
  }
}

/// The amplitude of a harmonic is what the displacements have of its shape: F^T (F u_m + ...) =
/// u_m.
void add_ring_motion(std::vector<Check>& checks, const ReducedSystem& reduced)
{
  if (!reduced.ring_motion) return;
  MatrixXd amplitudes =
      reduced.ring_motion->shapes.transpose() * reduced.ring_motion->displacements;
  amplitudes.leftCols(reduced.n_masters()).diagonal().array() -= 1.0;
  checks.push_back(bounded("harmonics of rings", amplitudes.cwiseAbs().maxCoeff(), 1e-8,
                           "shapes in the displacements of the nodes against the coordinates"));
}

}  // namespace

std::vector<Check> check_reduced(const ReducedSystem& reduced)
{
  std::vector<Check> checks;
  const std::string meaning = "largest |A_ij - A_ji| over sqrt(A_ii A_jj)";
  for (const auto& [name, A] :
       {std::pair{"symmetry of K", &reduced.K}, std::pair{"symmetry of M", &reduced.M},
        std::pair{"symmetry of C", &reduced.C}, std::pair{"symmetry of H", &reduced.H}})
    if (A->size() > 0) checks.push_back(bounded(name, check_parts::asymmetry(*A), 1e-8, meaning));
  add_definiteness(checks, reduced);
  add_rigid_motions(checks, reduced);
  add_fixed_interface_modes(checks, reduced);
  add_free_modes(checks, reduced);
  add_mass_integrals(checks, reduced);
  if (reduced.stiffening) checks.push_back(check_parts::check_stiffening(*reduced.stiffening));
  add_ring_motion(checks, reduced);
  return checks;
}

}  // namespace chladni::mbs_export
