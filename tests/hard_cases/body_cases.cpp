// Mode shifting, mode selection and interface modes where they are badly conditioned.
#include <cmath>

#include "hard_case.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/free_modes.hpp"
#include "mbs_export/held_modes.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/response_error.hpp"
#include "tests/mbs_export/bending_beam.hpp"
#include "tests/mbs_export/wheel.hpp"

namespace chladni::hard_cases {
namespace {

using namespace mbs_export;
using Eigen::MatrixXd, Eigen::VectorXd;

/// Largest relative error of the first `n` frequencies of the held beam against K and M with the
/// held rows struck out.
double held_beam_error(const std::vector<std::string>& fixed, int n)
{
  const ReducedSystem& beam = test::regression_beam();
  BodyOptions options;
  options.fixed = fixed;
  const ModalBody body = make_body(beam, options);
  const HeldDofs held = held_dofs(beam, fixed);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < beam.K.rows(); ++i)
    if (std::ranges::find(held.rows, i) == held.rows.end()) kept.push_back(i);
  const MatrixXd K = beam.K(kept, kept), M = beam.M(kept, kept);
  const VectorXd lambda =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly)
          .eigenvalues();
  const VectorXd exact = lambda.cwiseMax(0.0).cwiseSqrt();
  double worst = 0.0;
  for (int i = 0; i < n; ++i) worst = std::max(worst, relative_error(body.omega[i], exact[i]));
  return worst;
}

/// Receptance of the kept modes and the FRM at Omega over that of all modes, minus 1.
double frm_error(double Omega_0)
{
  BodyOptions options;
  options.fixed = {"A"};
  const ModalBody complete = make_body(test::regression_beam(), options);
  options.keep.count = 2;
  options.interface_modes = {
      {.kind = InterfaceModes::Kind::frm, .at = "B", .components = {4}, .omega0 = Omega_0}};
  const ModalBody body = make_body(test::regression_beam(), options);
  constexpr int theta_B = 10;
  const auto receptance = [&](const ModalBody& of) {
    return (of.attachment_modes.row(theta_B).array().square().transpose() /
            (of.omega.array().square() - Omega_0 * Omega_0))
        .sum();
  };
  return relative_error(receptance(body), receptance(complete));
}

/// |V^T V - I| of response modes that differ by 1e-9 of their length.
double orthogonality_of_nearly_equal_loads()
{
  const VectorXd omega = VectorXd::LinSpaced(200, 10.0, 4e4);
  MatrixXd g(200, 60);
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 200; ++i) g(i, j) = std::cos(0.05 * i) + 1e-9 * std::cos(0.1 * i * j);
  const InterfaceBasis basis = interface_basis(omega, response_modes(omega, g, 5.0));
  return (basis.V.transpose() * basis.V - MatrixXd::Identity(basis.V.cols(), basis.V.cols()))
      .norm();
}

/// Modes of a wheel whose frequencies a cut at any number would part from their twin.
double parted_pairs_of_a_wheel()
{
  BodyOptions options;
  options.fixed = {"hub"};
  const VectorXd omega = make_body(test::wheel(), options).omega;
  double parted = 0.0;
  for (int count = 1; count < omega.size(); ++count) {
    const ModeSelection kept = select_modes(omega, {.count = count, .up_to_Hz = {}, .list = {}});
    const auto last = static_cast<Eigen::Index>(kept.kept.size()) - 1;
    if (last + 1 < omega.size()) parted += relative_error(omega[last], omega[last + 1]) < 1e-4;
  }
  return parted;
}

/// Frequencies of a body held by DOFs of a stiff wheel and those of one held by others that mean
/// the same: the choice of the dependent modes must not matter.
double invariance_of_dependent_modes()
{
  const ReducedSystem wheel = test::wheel();
  const FreeModes modes = orthogonalize(wheel);
  const HeldDofs held = held_dofs(wheel, {"hub", "rim.z"});
  const ModeShift shift = shift_modes(modes, held);
  const ConstrainedModes by_shift = constrained_modes(shift);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < wheel.K.rows(); ++i)
    if (std::ranges::find(held.rows, i) == held.rows.end()) kept.push_back(i);
  const VectorXd lambda = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(
                              wheel.K(kept, kept), wheel.M(kept, kept), Eigen::EigenvaluesOnly)
                              .eigenvalues();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < by_shift.omega.size(); ++i)
    worst = std::max(worst, relative_error(by_shift.omega[i], std::sqrt(lambda[i])));
  return worst;
}

constexpr double omega_1_free = 22.3732854528785649;  // rad/s of the free beam

}  // namespace

std::vector<HardCase> body_cases()
{
  const std::string area = "preprocessing";
  const std::string frequencies = "relative error of the frequencies";
  return {
      {area, "beam held at both ends and in the middle, 6 displacements of 2 rigid modes",
       "four elastic modes must give way: badly conditioned Q_dd", frequencies, 1e-6,
       [] {
         return held_beam_error({"A", "B", "C"}, 60);
       }},
      {area, "beam held at a slope alone", "one rigid motion held, one left free",
       frequencies + " above the rigid one", 1e-6,
       [] {
         BodyOptions options;
         options.fixed = {"A.ry"};
         const ModalBody body = make_body(test::regression_beam(), options);
         // Free at both ends but for the slope: the symmetric modes of a free beam of length 2.
         return body.n_free_rigid == 1 ? relative_error(body.omega[1], omega_1_free / 4.0) : 1.0;
       }},
      {area, "clamped beam with modes 105 and 106 as dependent ones",
       "cond(Q_dd) of 3e6 and stiff modes: rounding would be 4e-3 of the first frequency",
       "words missing in the refusal", 0.0,
       [] {
         const ReducedSystem& beam = test::regression_beam();
         return words_missing(
             [&] {
               shift_modes(orthogonalize(beam), held_dofs(beam, {"A"}), {104, 105});
             },
             {"104, 105", "rounded"});
       }},
      {area, "beam held at both ends with modes 3 and 5 as dependent ones",
       "both are symmetric: Q_dd is singular", "words missing in the refusal", 0.0,
       [] {
         const ReducedSystem& beam = test::regression_beam();
         return words_missing(
             [&] {
               shift_modes(orthogonalize(beam), held_dofs(beam, {"A.z", "C.z"}), {2, 4});
             },
             {"cond(Q_dd)", "2, 4", "C.z"});
       }},
      {area, "wheel held at its hub and at all heights of its rim",
       "18 displacements of which the rigid modes can give 6", frequencies, 1e-8,
       invariance_of_dependent_modes},
      {area, "FRM at Omega_0 within 1e-6 of a kept frequency",
       "the response is dominated by the kept mode: 6 digits cancel",
       "relative error of the receptance at Omega_0", 1e-8,
       [] { return frm_error(3.51601 * (1.0 + 1e-6)); }},
      {area, "FRM exactly on a neglected frequency", "the response is infinite",
       "words missing in the refusal", 0.0,
       [] {
         const VectorXd omega{{2.0, 5.0, 9.0}};
         return words_missing([&] { response_modes(omega, MatrixXd::Ones(3, 1), 5.0); },
                              {"omega0", "take omega0 = "});
       }},
      {area, "60 response modes that differ by 1e-9", "numerically one single vector",
       "|V^T V - I|", 1e-12, orthogonality_of_nearly_equal_loads},
      {area, "every cut through the modes of a wheel",
       "all bending modes are double: half a pair breaks the symmetry", "pairs parted", 0.0,
       parted_pairs_of_a_wheel},
      {area, "body held at a set that does not exist", "a misprint in the scene",
       "words missing in the refusal", 0.0,
       [] {
         BodyOptions options;
         options.fixed = {"hubb"};
         return words_missing([&] { make_body(test::wheel(), options); }, {"hubb", "hub", "rim"});
       }},
  };
}

}  // namespace chladni::hard_cases
