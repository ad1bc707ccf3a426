#pragma once

#include <string>
#include <vector>

#include "mbs_export/formats/fmu_variables.hpp"

namespace chladni::mbs_export::formats {

enum class FmiVersion { v2, v3 };

/// The contents of a modelDescription.xml besides its variables.
struct FmuDescription {
  std::string name;        ///< of the model, as shown to users
  std::string identifier;  ///< of its library, a C identifier
  std::string token;
  bool has_directional_derivatives = true;
};

/// The modelDescription.xml of a model for model exchange and co-simulation.
/// Source: Modelica Association, Functional Mock-up Interface 2.0.4, section 2.2, and 3.0, section
/// 2.4.
std::string fmu_description(const std::vector<FmuVariable>& variables,
                            const FmuDescription& description, FmiVersion version);

}  // namespace chladni::mbs_export::formats
