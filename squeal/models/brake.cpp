#include "squeal/models/brake.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <numbers>
#include <utility>

#include "squeal/models/assembly_brake.hpp"
#include "squeal/models/parameters.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/models/sliding_masses.hpp"

namespace chladni::squeal {

namespace {

using std::numbers::pi;

/// "frequency of the pair with 3 nodal diameters at 1686.2 Hz"
std::string name_of_mode(int nodal_diameters, double f_Hz)
{
  if (nodal_diameters == 0) return fmt::format("frequency of the mode at {:.6g} Hz", f_Hz);
  return fmt::format("frequency of the pair with {} nodal diameter{} at {:.6g} Hz", nodal_diameters,
                     nodal_diameters == 1 ? "" : "s", f_Hz);
}

}  // namespace

std::vector<BrakeNumber> disc_frequencies(
    const InertialDisc& disc, const std::function<std::unique_ptr<Brake>(InertialDisc)>& brake)
{
  std::vector<BrakeNumber> numbers;
  Eigen::Index size = 1;
  for (Eigen::Index i = 0; i < disc.n_modes(); i += size) {
    const int n = disc.nodal_diameters[static_cast<std::size_t>(i)];
    size = n > 0 ? 2 : 1;
    const double f_Hz = disc.omega[i] / (2.0 * pi);
    numbers.push_back({.key = name_of_mode(n, f_Hz),
                       .unit = "Hz",
                       .value = f_Hz,
                       .step = 0.0,
                       .with = [&disc, brake, i, size](double value_Hz) {
                         InertialDisc changed = disc;
                         changed.omega.segment(i, size).setConstant(2.0 * pi * value_Hz);
                         return brake(std::move(changed));
                       }});
  }
  return numbers;
}

std::unique_ptr<Brake> model_brake(const ModelOptions& options,
                                   std::span<const mbs_export::ModalBody> bodies)
{
  if (const auto* parts = std::get_if<AssemblyOptions>(&options.model))
    return std::make_unique<AssemblyBrake>(*parts, bodies);
  if (const auto* study = std::get_if<RigidDiscStudy>(&options.model))
    return std::make_unique<RigidDiscBrake>(*study);
  if (const auto* masses = std::get_if<TwoMasses>(&options.model))
    return std::make_unique<SlidingBrake>(*masses);
  if (const auto* block = std::get_if<TiltingBlock>(&options.model))
    return std::make_unique<SlidingBrake>(*block);
  return std::make_unique<SlidingBrake>(std::get<Oscillator>(options.model));
}

}  // namespace chladni::squeal
