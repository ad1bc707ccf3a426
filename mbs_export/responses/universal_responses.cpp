#include "mbs_export/responses/universal_responses.hpp"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <numbers>

#include "common/error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index;

constexpr double two_pi = 2.0 * std::numbers::pi;

/// Specific data types of dataset 58.
constexpr int displacement = 8, velocity = 11, acceleration = 12, excitation_force = 13,
              frequency = 18;

std::string dataset(int number, const std::string& records)
{
  return fmt::format("{:6d}\n{:6d}\n{}{:6d}\n", -1, number, records, -1);
}

std::string units()
{
  constexpr double celsius = 273.15;
  return dataset(164, fmt::format("{:10d}{:<20}{:10d}\n{:25.16E}{:25.16E}{:25.16E}\n{:25.16E}\n", 1,
                                  "SI: m, N", 2, 1.0, 1.0, 1.0, celsius));
}

std::string nodes_of(const FrequencyResponses& responses)
{
  std::map<std::int64_t, Eigen::Vector3d> nodes;
  for (const auto* const points : {&responses.loads, &responses.outputs})
    for (const ResponsePoint& point : *points) nodes.emplace(point.node, point.position);
  std::string records;
  for (const auto& [number, x] : nodes) {
    records += fmt::format("{:10d}{:10d}{:10d}{:10d}\n{:25.16E}{:25.16E}{:25.16E}\n", number, 0, 0,
                           1, x[0], x[1], x[2]);
  }
  return dataset(2411, records);
}

int type_of(ResponseQuantity quantity)
{
  if (quantity == ResponseQuantity::receptance) return displacement;
  return quantity == ResponseQuantity::mobility ? velocity : acceleration;
}

/// What stands along an axis: its data type and two texts.
std::string axis(int type, const std::string& label, const std::string& unit)
{
  return fmt::format("{:10d}{:5d}{:5d}{:5d} {:<20} {:<20}\n", type, 0, 0, 0, label, unit);
}

std::string unit_of_motion(ResponseQuantity quantity, const ResponsePoint& output)
{
  const std::string motion = output.component < 3 ? "m" : "rad";
  if (quantity == ResponseQuantity::receptance) return motion;
  return motion + (quantity == ResponseQuantity::mobility ? "/s" : "/s^2");
}

/// Five lines of words, DOFs, the frequencies and the axes.
std::string header(const FrequencyResponses& responses, const ResponsePoint& output,
                   const ResponsePoint& load, bool is_even)
{
  const Eigen::VectorXd f_Hz = responses.Omega / two_pi;
  std::string text = fmt::format(
      "{:.80}\n{:.80}\nNONE\n{:.80}\n{:.80}\n", output.name + " / " + load.name,
      responses.title.empty() ? "NONE" : responses.title,
      fmt::format("{} of the {} model", name_of(responses.quantity), name_of(responses.model)),
      fmt::format("damping {}, loss factor {:.6g}", responses.damping, responses.loss_factor));
  text +=
      fmt::format("{:5d}{:10d}{:5d}{:10d} {:<10}{:10d}{:4d} {:<10}{:10d}{:4d}\n", 4, 0, 0, 0,
                  "NONE", output.node, output.component + 1, "NONE", load.node, load.component + 1);
  text +=
      fmt::format("{:10d}{:10d}{:10d}{:13.5E}{:13.5E}{:13.5E}\n", 6, f_Hz.size(), is_even ? 1 : 0,
                  is_even ? f_Hz[0] : 0.0, is_even ? f_Hz[1] - f_Hz[0] : 0.0, 0.0);
  text += axis(frequency, "Frequency", "Hz");
  text += axis(type_of(responses.quantity), name_of(responses.quantity),
               unit_of_motion(responses.quantity, output));
  text += axis(excitation_force, load.component < 3 ? "Force" : "Moment",
               load.component < 3 ? "N" : "N m");
  return text + axis(0, "NONE", "NONE");
}

/// Whether the frequencies add from one to the next.
bool is_evenly_spaced(const Eigen::VectorXd& Omega)
{
  const Index n = Omega.size();
  const Eigen::VectorXd even = Eigen::VectorXd::LinSpaced(n, Omega[0], Omega[n - 1]);
  return (Omega - even).cwiseAbs().maxCoeff() < 1e-9 * Omega[n - 1];
}

/// Two complex numbers in a line, or a frequency and one.
std::string values(const FrequencyResponses& responses, const Eigen::VectorXcd& H, bool is_even)
{
  std::string text;
  const auto end = std::back_inserter(text);
  for (Index f = 0; f < H.size(); ++f) {
    if (!is_even) fmt::format_to(end, "{:13.5E}", responses.Omega[f] / two_pi);
    fmt::format_to(end, "{:20.11E}{:20.11E}", H[f].real(), H[f].imag());
    if (!is_even || f % 2 == 1 || f + 1 == H.size()) text += '\n';
  }
  return text;
}

}  // namespace

std::string universal_file_of(const FrequencyResponses& responses)
{
  for (const ResponsePoint& load : responses.loads) {
    if (load.node > 0) continue;
    throw Error(
        fmt::format("the load {} is shared by several nodes, and a universal file names one for "
                    "each function; load the nearest of them (response.loads.near) or a coupling",
                    load.name));
  }
  const bool is_even = is_evenly_spaced(responses.Omega);
  std::string text = units() + nodes_of(responses);
  for (std::size_t l = 0; l < responses.loads.size(); ++l) {
    for (std::size_t o = 0; o < responses.outputs.size(); ++o) {
      text += dataset(58, header(responses, responses.outputs[o], responses.loads[l], is_even) +
                              values(responses, responses.H[l].col(Index(o)), is_even));
    }
  }
  return text;
}

}  // namespace chladni::mbs_export
