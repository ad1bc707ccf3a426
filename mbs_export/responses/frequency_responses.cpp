#include "mbs_export/responses/frequency_responses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/body_damping.hpp"
#include "mbs_export/measured/measured_functions.hpp"
#include "mbs_export/responses/measured_beside.hpp"
#include "mbs_export/responses/response_option_error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;

constexpr double two_pi = 2.0 * std::numbers::pi;

/// The rows of displacement or rotation by component: 0, 1.
int kind_of(int component)
{
  return component < 3 ? 0 : 1;
}

/// The largest row of displacements and of rotations, to tell what does not move.
std::array<double, 2> largest_rows(const MatrixXd& motion)
{
  std::array<double, 2> largest{};
  for (Index row = 0; row < motion.rows(); ++row) {
    double& kind = largest[static_cast<std::size_t>(kind_of(static_cast<int>(row % 6)))];
    kind = std::max(kind, motion.row(row).norm());
  }
  return largest;
}

/// What each mode does at some DOFs, [n_dofs x n_modes].
MatrixXd rows_of(const ModalBody& body, const std::vector<ResponseDof>& dofs)
{
  constexpr double at_rest = 1e-9;
  const std::array<double, 2> largest = largest_rows(body.attachment_modes);
  MatrixXd rows = MatrixXd::Zero(std::ssize(dofs), body.n_modes());
  for (Index i = 0; i < rows.rows(); ++i) {
    const ResponseDof& dof = dofs[static_cast<std::size_t>(i)];
    for (const int node : dof.nodes) {
      rows.row(i) += body.attachment_modes.row(6 * node + dof.component) /
                     static_cast<double>(dof.nodes.size());
    }
    const double reference = largest[static_cast<std::size_t>(kind_of(dof.component))];
    if (rows.row(i).norm() > at_rest * reference) continue;
    throw ResponseOptionError(
        dof.key, fmt::format("no mode moves {}: it is held, is no part of the model, or the modes "
                             "that move it were left out",
                             dof.name));
  }
  return rows;
}

/// The damping of a body without the viscous equivalent of H.
MatrixXd viscous_part(const ModalBody& body)
{
  if (body.H.size() == 0) return body.C;
  return body.C - viscous_equivalent(body.H, body.omega);
}

bool is_diagonal(const MatrixXd& A)
{
  return A.size() == 0 || A.isDiagonal(0.0);
}

/// (1 + i eta) diag(k) + i H + i Omega C - Omega^2 I
class DynamicStiffness {
 public:
  DynamicStiffness(const ModalBody& body, double loss_factor)
      : k_(body.omega.array().square()),
        C_(viscous_part(body)),
        H_(body.H),
        loss_factor_(loss_factor),
        is_diagonal_(is_diagonal(C_) && is_diagonal(H_))
  {}

  /// The amplitudes of the modes, [n_modes x n_loads].
  MatrixXcd solve(double Omega, const MatrixXd& B) const
  {
    const VectorXd size = k_.array() + Omega * Omega;
    VectorXcd d = k_ * Complex(1.0, loss_factor_) - VectorXcd::Constant(k_.size(), Omega * Omega);
    if (is_diagonal_) {
      if (C_.size() > 0) d += Complex(0.0, Omega) * C_.diagonal();
      if (H_.size() > 0) d += Complex(0.0, 1.0) * H_.diagonal();
      for (Index i = 0; i < d.size(); ++i)
        if (!(std::abs(d[i]) > resonant * size[i])) refuse_resonance(Omega, i);
      return d.cwiseInverse().asDiagonal() * B.cast<Complex>();
    }
    return solve_coupled(Omega, d, B);
  }

 private:
  static constexpr double resonant = 1e-9;

  [[noreturn]] void refuse_resonance(double Omega, Index mode) const
  {
    throw ResponseOptionError(
        "from_Hz",
        fmt::format("the range holds {:.9g} Hz, an undamped natural frequency (mode {}), where the "
                    "response has no bound; give damping (body.damping, response.loss_factor) or "
                    "other frequencies",
                    Omega / two_pi, mode + 1));
  }

  MatrixXcd solve_coupled(double Omega, const VectorXcd& d, const MatrixXd& B) const
  {
    if (Omega == 0.0 && k_.size() > 0 && k_[0] == 0.0) refuse_resonance(Omega, 0);
    const VectorXd scale = (k_.array() + Omega * Omega).sqrt().inverse();
    MatrixXcd A = MatrixXcd::Zero(k_.size(), k_.size());
    if (C_.size() > 0) A += Complex(0.0, Omega) * C_;
    if (H_.size() > 0) A += Complex(0.0, 1.0) * H_;
    A.diagonal() += d;
    A = scale.asDiagonal() * A * scale.asDiagonal();
    const Eigen::PartialPivLU<MatrixXcd> factor(A);
    Index mode = 0;
    if (!(factor.rcond() > resonant * 1e-3)) {
      (d.cwiseAbs().array() * scale.array().square()).minCoeff(&mode);
      refuse_resonance(Omega, mode);
    }
    return scale.asDiagonal() * factor.solve((scale.asDiagonal() * B).cast<Complex>()).eval();
  }

  VectorXd k_;
  MatrixXd C_;
  const MatrixXd& H_;
  double loss_factor_;
  bool is_diagonal_;
};

/// The section forces of the groups that the scene names, without their values.
std::vector<const ResultantModes*> chosen_resultants(const ModalBody& body,
                                                     const ResponseOptions& options)
{
  std::vector<const ResultantModes*> chosen;
  for (std::size_t i = 0; i < options.section_forces.size(); ++i) {
    const auto found =
        std::ranges::find(body.resultants, options.section_forces[i], &ResultantModes::name);
    if (found == body.resultants.end()) {
      std::vector<std::string> names;
      for (const ResultantModes& one : body.resultants) names.push_back(one.name);
      throw ResponseOptionError(
          fmt::format("section_forces[{}]", i + 1),
          names.empty() ? "the file has no section forces; name the group in reduce.resultants and "
                          "reduce again"
                        : fmt::format("the file has section forces of {}; name the group in "
                                      "reduce.resultants and reduce again",
                                      fmt::join(names, ", ")));
    }
    chosen.push_back(&*found);
  }
  return chosen;
}

/// Room for the responses of some points to each load.
std::vector<MatrixXcd> room(Index n_loads, Index n_f, Index n)
{
  return {static_cast<std::size_t>(n_loads), MatrixXcd(n_f, n)};
}

SectionForceResponses empty_responses(const ResultantModes& from, Index n_loads, Index n_f)
{
  SectionForceResponses responses{.points = from, .r = room(n_loads, n_f, from.S.rows())};
  responses.points.S.resize(0, 0);
  return responses;
}

}  // namespace

VectorXd angular_frequencies(const FrequencyRange& range)
{
  VectorXd Omega(range.count);
  for (Index i = 0; i < Omega.size(); ++i) {
    const double part = double(i) / double(range.count - 1);
    const double f_Hz = range.spacing == Spacing::linear
                            ? range.from_Hz + part * (range.to_Hz - range.from_Hz)
                            : range.from_Hz * std::pow(range.to_Hz / range.from_Hz, part);
    Omega[i] = two_pi * f_Hz;
  }
  Omega[Omega.size() - 1] = two_pi * range.to_Hz;
  return Omega;
}

VectorXd angular_frequencies(const ResponseOptions& options)
{
  if (!options.measurement) return angular_frequencies(options.range);
  return two_pi * options.measurement->functions->f_Hz;
}

Complex rate_factor(ResponseQuantity quantity, double Omega)
{
  if (quantity == ResponseQuantity::mobility) return {0.0, Omega};
  return quantity == ResponseQuantity::accelerance ? -Omega * Omega : 1.0;
}

std::string unit_of(ResponseQuantity quantity, const ResponsePoint& output,
                    const ResponsePoint& load)
{
  const std::string motion = output.component < 3 ? "m" : "rad";
  const std::string force = load.component < 3 ? "N" : "(N m)";
  if (quantity == ResponseQuantity::receptance) return motion + "/" + force;
  const char* rate = quantity == ResponseQuantity::mobility ? "s" : "s^2";
  return fmt::format("({}/{})/{}", motion, rate, force);
}

ResponsePoint point_of(const NamedNodes& model, const ResponseDof& dof)
{
  ResponsePoint point{.name = dof.name,
                      .component = dof.component,
                      .node = 0,
                      .position = {0.0, 0.0, 0.0},
                      .measured_node = dof.measured_node};
  for (const int node : dof.nodes) {
    point.position += model.nodes[static_cast<std::size_t>(node)].position /
                      static_cast<double>(dof.nodes.size());
  }
  if (dof.nodes.size() == 1)
    point.node = model.nodes[static_cast<std::size_t>(dof.nodes.front())].number;
  return point;
}

std::string name_of(ResponseModel model)
{
  if (model == ResponseModel::body) return "body";
  return model == ResponseModel::reduced ? "reduced" : "fe";
}

std::string name_of(ResponseQuantity quantity)
{
  if (quantity == ResponseQuantity::receptance) return "receptance";
  return quantity == ResponseQuantity::mobility ? "mobility" : "accelerance";
}

FrequencyResponses frequency_responses(const ModalBody& body, const ResponseOptions& options)
{
  const NamedNodes model{body.attachment_nodes, body.sets};
  const std::vector<ResponseDof> loads = response_loads(model, options.loads);
  const std::vector<ResponseDof> outputs = response_outputs(model, options.outputs);
  const MatrixXd B = rows_of(body, loads).transpose(), U = rows_of(body, outputs);
  FrequencyResponses found{.title = body.title,
                           .model = options.model,
                           .quantity = options.quantity,
                           .Omega = angular_frequencies(options),
                           .loss_factor = options.loss_factor,
                           .damping = body.C.size() > 0 ? "of the modes" : "none",
                           .loads = {},
                           .outputs = {},
                           .H = {},
                           .provenance = body.provenance};
  for (const ResponseDof& dof : loads) found.loads.push_back(point_of(model, dof));
  for (const ResponseDof& dof : outputs) found.outputs.push_back(point_of(model, dof));
  if (options.measurement) found.measured = measured_beside(*options.measurement, found);
  const Index n_f = found.Omega.size();
  found.H = room(B.cols(), n_f, U.rows());
  const std::vector<const ResultantModes*> resultants = chosen_resultants(body, options);
  for (const ResultantModes* one : resultants)
    found.section_forces.push_back(empty_responses(*one, B.cols(), n_f));
  const Complex complex_modulus(1.0, options.loss_factor);
  const DynamicStiffness D(body, options.loss_factor);
  for (Index f = 0; f < n_f; ++f) {
    const MatrixXcd q = D.solve(found.Omega[f], B);
    const Complex rate = rate_factor(options.quantity, found.Omega[f]);
    for (std::size_t l = 0; l < loads.size(); ++l) {
      found.H[l].row(f) = (rate * (U * q.col(Index(l)))).transpose();
      for (std::size_t j = 0; j < resultants.size(); ++j) {
        found.section_forces[j].r[l].row(f) =
            complex_modulus * (resultants[j]->S * q.col(Index(l))).transpose();
      }
    }
  }
  return found;
}

}  // namespace chladni::mbs_export
