#include "mbs_export/responses/frequency_responses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/measured/measured_functions.hpp"
#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXcd,
    Eigen::VectorXd;

namespace {

using Complex = std::complex<double>;

using std::numbers::pi;

/// The rows of displacement or rotation by component: 0, 1.
int kind_of_component(int component)
{
  return component < 3 ? 0 : 1;
}

/// The largest row of displacements and of rotations, to tell what does not move.
std::array<double, 2> largest_rows(const MatrixXd& motion)
{
  std::array<double, 2> largest{};
  for (Index row = 0; row < motion.rows(); ++row) {
    double& kind = largest[static_cast<std::size_t>(kind_of_component(static_cast<int>(row % 6)))];
    kind = std::max(kind, motion.row(row).norm());
  }
  return largest;
}

/// What each mode does at some DOFs, [n_dofs x n_modes].
MatrixXd motion_rows(const ModalBody& body, const std::vector<ResponseDof>& dofs)
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
    const double reference = largest[static_cast<std::size_t>(kind_of_component(dof.component))];
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
                    Omega / (2.0 * pi), mode + 1));
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
    Omega[i] = 2.0 * pi * f_Hz;
  }
  Omega[Omega.size() - 1] = 2.0 * pi * range.to_Hz;
  return Omega;
}

VectorXd angular_frequencies(const ResponseOptions& options)
{
  if (!options.measurement) return angular_frequencies(options.range);
  return 2.0 * pi * options.measurement->functions->f_Hz;
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
  const MatrixXd B = motion_rows(body, loads).transpose(), U = motion_rows(body, outputs);
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

namespace {

/// A place of the scene with the keys that name it.
struct KeyedPlace {
  const ResponsePlace& place;
  std::string key;  ///< "loads[1]"
};

const AttachmentSet& set_of(const NamedNodes& model, const KeyedPlace& asked)
{
  const auto found = std::ranges::find(model.sets, asked.place.at, &AttachmentSet::name);
  if (found == model.sets.end()) {
    std::vector<std::string> names;
    for (const AttachmentSet& set : model.sets) names.push_back(set.name);
    throw ResponseOptionError(
        asked.key + ".at",
        fmt::format("the model has no nodes of this name; there are {}", fmt::join(names, ", ")));
  }
  if (found->nodes.empty()) throw ResponseOptionError(asked.key + ".at", "the set has no nodes");
  return *found;
}

/// The node of a set that is nearest to the place.
int nearest(const NamedNodes& model, const AttachmentSet& set, const KeyedPlace& asked)
{
  const Vector3d x{(*asked.place.near)[0], (*asked.place.near)[1], (*asked.place.near)[2]};
  const auto distance = [&](int node) {
    return (model.nodes[static_cast<std::size_t>(node)].position - x).norm();
  };
  const int best = *std::ranges::min_element(set.nodes, {}, distance);
  constexpr double alike = 1.0 + 1e-6;
  for (const int node : set.nodes) {
    if (node == best || distance(node) > alike * distance(best)) continue;
    throw ResponseOptionError(
        asked.key + ".near",
        fmt::format("nodes {} and {} of \"{}\" are equally near, {:.4g} m; move it towards one",
                    model.nodes[static_cast<std::size_t>(best)].number,
                    model.nodes[static_cast<std::size_t>(node)].number, set.name, distance(best)));
  }
  return best;
}

std::vector<int> asked_nodes(const NamedNodes& model, const KeyedPlace& asked)
{
  const AttachmentSet& set = set_of(model, asked);
  if (!asked.place.near) return set.nodes;
  return {nearest(model, set, asked)};
}

/// "track.z", and which of its nodes where the set has others.
std::string name_of(const NamedNodes& model, const KeyedPlace& asked, int component, int node)
{
  const std::string name = fmt::format("{}.{}", asked.place.at, component_name(component));
  if (set_of(model, asked).nodes.size() == 1) return name;
  return fmt::format("{} (node {})", name, model.nodes[static_cast<std::size_t>(node)].number);
}

/// A moment about the normal of a shell acts on a stiffness that elements invent.
void refuse_drilling_moment(const NamedNodes& model, const ResponseDof& load)
{
  if (load.component < 3) return;
  for (const int node : load.nodes) {
    const AttachmentNode& one = model.nodes[static_cast<std::size_t>(node)];
    constexpr double tilt = 1e-2;  // rad, as is_drilling
    if (std::abs(one.drilling_axis[load.component - 3]) <= tilt) continue;
    throw ResponseOptionError(
        load.key,
        fmt::format("the moment {} turns node {} about the normal of a shell, which only a "
                    "numerical stiffness resists; load a coupling, or another component",
                    load.name, one.number));
  }
}

void refuse_twins(const std::vector<ResponseDof>& dofs)
{
  std::set<std::string> names;
  for (const ResponseDof& dof : dofs)
    if (!names.insert(dof.name).second)
      throw ResponseOptionError(dof.key, fmt::format("{} is asked for twice", dof.name));
}

}  // namespace

std::vector<ResponseDof> response_loads(const NamedNodes& model,
                                        const std::vector<ResponsePlace>& places)
{
  std::vector<ResponseDof> loads;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const KeyedPlace asked{places[i], fmt::format("loads[{}]", i + 1)};
    const std::vector<int> nodes = asked_nodes(model, asked);
    for (const int component : asked.place.components) {
      const std::string name =
          nodes.size() == 1 ? name_of(model, asked, component, nodes.front())
                            : fmt::format("{}.{}", asked.place.at, component_name(component));
      loads.push_back({name, asked.key + ".dofs", component, nodes, asked.place.measured_node});
      refuse_drilling_moment(model, loads.back());
    }
  }
  refuse_twins(loads);
  return loads;
}

std::vector<ResponseDof> response_outputs(const NamedNodes& model,
                                          const std::vector<ResponsePlace>& places)
{
  std::vector<ResponseDof> outputs;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const KeyedPlace asked{places[i], fmt::format("outputs[{}]", i + 1)};
    const std::vector<int> nodes = asked_nodes(model, asked);
    if (asked.place.measured_node && nodes.size() > 1) {
      throw ResponseOptionError(
          asked.key + ".measured_node",
          fmt::format("\"{}\" has {} nodes, and one node was measured; choose "
                      "the nearest by `near`",
                      asked.place.at, nodes.size()));
    }
    for (const int node : nodes)
      for (const int component : asked.place.components) {
        outputs.push_back({name_of(model, asked, component, node),
                           asked.key + ".dofs",
                           component,
                           {node},
                           asked.place.measured_node});
      }
  }
  refuse_twins(outputs);
  return outputs;
}

namespace {

/// The loads or the outputs, and the measured nodes that belong to them.
class MeasuredPoints {
 public:
  MeasuredPoints(const Measurement& measurement, const std::vector<ResponsePoint>& points)
      : measured_(*measurement.functions), distance_(measurement.distance), points_(points)
  {}

  /// The place among the points to which a measured DOF belongs, if there is one.
  std::optional<std::size_t> of(const MeasuredDof& dof)
  {
    std::optional<std::size_t> point = named(dof);
    if (!point) point = nearest(dof);
    if (!point) return std::nullopt;
    const auto place = measured_.nodes.find(dof.node);
    if (place != measured_.nodes.end() && !place->second.is_in_global_axes) {
      throw Error(fmt::format(
          "{}: node {} has a coordinate system of its own; write its functions in the axes of the "
          "model",
          measured_.file, dof.node));
    }
    const auto [other, is_new] = owners_.emplace(*point, dof.node);
    if (is_new || other->second == dof.node) return point;
    throw Error(
        fmt::format("{}: the measured nodes {} and {} both belong to {}; give a smaller "
                    "--distance, or name the "
                    "node by `measured_node`",
                    measured_.file, other->second, dof.node, points_[*point].name));
  }

 private:
  std::optional<std::size_t> named(const MeasuredDof& dof) const
  {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (points_[i].measured_node == dof.node && points_[i].component == dof.component) return i;
    return std::nullopt;
  }

  /// Of the points of one node that name none of the measurement.
  std::optional<std::size_t> nearest(const MeasuredDof& dof) const
  {
    const auto place = measured_.nodes.find(dof.node);
    if (!distance_ || place == measured_.nodes.end()) return std::nullopt;
    std::optional<std::size_t> best;
    double least = *distance_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const ResponsePoint& point = points_[i];
      const double gap = (point.position - place->second.position).norm();
      const bool is_one_node = point.node != 0;
      const bool is_candidate =
          point.component == dof.component && is_one_node && !point.measured_node;
      if (!is_candidate || gap > least) continue;
      best = i;
      least = gap;
    }
    return best;
  }

  const MeasuredFunctions& measured_;
  std::optional<double> distance_;
  const std::vector<ResponsePoint>& points_;
  std::map<std::size_t, std::int64_t> owners_ = {};  ///< measured nodes of the points
};

std::string text_of(const MeasuredFunctions& measured, const MeasuredDof& dof)
{
  const std::string text = fmt::format("node {} {}", dof.node, component_name(dof.component));
  const auto place = measured.nodes.find(dof.node);
  if (place == measured.nodes.end()) return text;
  const Eigen::Vector3d& x = place->second.position;
  return fmt::format("{} at ({:.4g}, {:.4g}, {:.4g}) m", text, x[0], x[1], x[2]);
}

std::string text_of(const ResponsePoint& point)
{
  const Eigen::Vector3d& x = point.position;
  return fmt::format("{} at ({:.4g}, {:.4g}, {:.4g}) m", point.name, x[0], x[1], x[2]);
}

[[noreturn]] void refuse_strangers(const Measurement& measurement,
                                   const FrequencyResponses& computed)
{
  const MeasuredFunctions& measured = *measurement.functions;
  const MeasuredFunction& one = measured.functions.front();
  std::string advice = "say of each load and output its `measured_node`";
  if (!measured.nodes.empty())
    advice += measurement.distance ? ", or give a larger --distance" : ", or give --distance";
  throw Error(fmt::format(
      "{}: none of its {} frequency responses is between an output and a load of [response]. The "
      "first is of {} for a load at {}; the scene has the output {} and the load {}. Are the units "
      "of length and the axes those of the model? Otherwise {}",
      measured.file, measured.functions.size(), text_of(measured, one.output),
      text_of(measured, one.load), text_of(computed.outputs.front()),
      text_of(computed.loads.front()), advice));
}

/// Factors that make a measured quantity the computed one, at each frequency.
Eigen::VectorXcd rates(const MeasuredFunction& one, const FrequencyResponses& computed)
{
  Eigen::VectorXcd rate = Eigen::VectorXcd::Ones(computed.Omega.size());
  const ResponseQuantity measured = one.quantity.value_or(computed.quantity);
  if (measured == computed.quantity) return rate;
  if (computed.Omega[0] == 0.0) {
    throw ResponseOptionError("from_Hz",
                              fmt::format("must be above 0: at rest the measured {} tells no {}",
                                          name_of(measured), name_of(computed.quantity)));
  }
  for (Eigen::Index f = 0; f < rate.size(); ++f) {
    rate[f] = rate_factor(computed.quantity, computed.Omega[f]) /
              rate_factor(measured, computed.Omega[f]);
  }
  return rate;
}

}  // namespace

MeasuredResponses measured_beside(const Measurement& measurement,
                                  const FrequencyResponses& computed)
{
  const MeasuredFunctions& measured = *measurement.functions;
  MeasuredResponses beside{.file = measured.file};
  MeasuredPoints loads(measurement, computed.loads), outputs(measurement, computed.outputs);
  for (const MeasuredFunction& one : measured.functions) {
    const auto load = loads.of(one.load), output = outputs.of(one.output);
    if (!load || !output) continue;
    beside.functions.push_back({.name = one.name,
                                .line = static_cast<std::int64_t>(one.line),
                                .load = *load,
                                .output = static_cast<Eigen::Index>(*output),
                                .H = rates(one, computed).cwiseProduct(one.H)});
  }
  if (beside.functions.empty()) refuse_strangers(measurement, computed);
  return beside;
}

double response_assurance(const Eigen::VectorXcd& x, const Eigen::VectorXcd& y)
{
  // Each over its norm, so that no square leaves the range of numbers.
  const double size = x.stableNorm() * y.stableNorm();
  if (!(size > 0.0)) return 0.0;
  return std::norm(x.stableNormalized().dot(y.stableNormalized()));
}

double amplitude_ratio(const Eigen::VectorXcd& x, const Eigen::VectorXcd& y)
{
  return y.stableNorm() / x.stableNorm();
}

}  // namespace chladni::mbs_export
