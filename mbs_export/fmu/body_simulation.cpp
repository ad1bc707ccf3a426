#include "mbs_export/fmu/component.hpp"
#include "mbs_export/fmu/instance.hpp"

namespace chladni::fmu {

std::unique_ptr<Simulation> simulation_at(const std::string& location, const std::string& token)
{
  ModalModel model = unpacked(resource(location, model_file));
  check_token(model.token, token);
  return std::make_unique<Instance>(std::move(model));
}

}  // namespace chladni::fmu
