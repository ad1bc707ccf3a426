#include "squeal/parameter_options.hpp"

#include <fmt/format.h>

#include "common/error.hpp"

namespace chladni::squeal {

void set_parameter(double* at, MapParameter parameter, double value)
{
  if (!at) {
    throw Error(fmt::format(
        "[squeal] \"{}\" cannot vary: the brake has no such key; give it a value in the "
        "scene, or vary another one",
        parameter.name));
  }
  *at = value;
}

}  // namespace chladni::squeal
