#include "squeal/models/model_brake.hpp"

#include "squeal/models/assembly_brake.hpp"
#include "squeal/models/rigid_disc_brake.hpp"
#include "squeal/models/sliding_brake.hpp"

namespace chladni::squeal {

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
