#include "mbs_export/body_options.hpp"

namespace chladni::mbs_export {

std::string name_of(Damping::Type type)
{
  switch (type) {
    case Damping::Type::modal:
      return "modal";
    case Damping::Type::rayleigh:
      return "rayleigh";
    case Damping::Type::matrix:
      return "matrix";
    case Damping::Type::none:
      break;
  }
  return "none";
}

}  // namespace chladni::mbs_export
