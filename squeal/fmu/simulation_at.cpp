#include "mbs_export/fmu/component.hpp"
#include "squeal/fmu/brake_simulation.hpp"
#include "squeal/fmu/driven_brake.hpp"

namespace chladni::fmu {

std::unique_ptr<Simulation> simulation_at(const std::string& location, const std::string& token)
{
  brake_fmu::BrakeModel model =
      brake_fmu::unpacked_brake(resource(location, brake_fmu::brake_file));
  check_token(model.token, token);
  return std::make_unique<brake_fmu::BrakeSimulation>(std::move(model));
}

}  // namespace chladni::fmu
