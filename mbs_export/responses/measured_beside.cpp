#include "mbs_export/responses/measured_beside.hpp"

#include <fmt/format.h>

#include <map>

#include "common/error.hpp"
#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/measured/measured_functions.hpp"
#include "mbs_export/responses/response_option_error.hpp"

namespace chladni::mbs_export {
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
