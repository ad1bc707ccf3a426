#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/check_body.hpp"
#include "mbs_export/check_parts.hpp"
#include "mbs_export/orthogonalize.hpp"
#include "mbs_export/rigid_body.hpp"

namespace chladni::mbs_export {
namespace {

using check_parts::bounded, check_parts::expected, check_parts::relative_eigenvalues;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
std::optional<MatrixXd> rigid_basis(const ReducedSystem& reduced)
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
  const std::optional<MatrixXd> B = rigid_basis(reduced);
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

/// K_qq = diag(omega^2), K_mq = 0, and M_qq = I but for MacNeal's method, which has no more mass
/// than its free modes.
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
