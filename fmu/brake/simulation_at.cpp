#include "fmu/brake/brake_file.hpp"
#include "fmu/brake/brake_simulation.hpp"
#include "fmu/component.hpp"

namespace chladni::fmu {

std::unique_ptr<Simulation> simulation_at(const std::string& location, const std::string& token)
{
  BrakeModel model = unpacked_brake(resource(location, brake_file));
  check_token(model.token, token);
  return std::make_unique<BrakeSimulation>(std::move(model));
}

}  // namespace chladni::fmu
