#include "mbs_export/check_body.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "linear/dense/orthogonal_factor.hpp"
#include "mbs_export/check_parts.hpp"
#include "mbs_export/contact_rings.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/rigid_body.hpp"

namespace chladni::mbs_export {
namespace {

using check_parts::bounded, check_parts::expected;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace chladni::mbs_export
