#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmu/modal_model.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export::formats {

/// A DOF of an attachment node and its name in the variables of an FMU.
struct FmuDof {
  std::string node;  ///< "hub", "track[17]", "node[4711]"; quoted where FMI requires it
  int component;     ///< 0 to 5
};

/// A body as the model of an FMU.
struct FmuBody {
  std::vector<FmuDof> dofs;  ///< rows of the model's Phi
  fmu::ModalModel model;
  int n_still = 0;  ///< number of DOFs left out because the body does not move there
};

/// The model of a body with the DOFs of some sets, or of all attachment nodes if no set is named,
/// in which the body moves.
/// @throws chladni::Error naming a set that does not exist, and when no DOF is left.
FmuBody fmu_body(const ModalBody& body, const std::vector<std::string>& sets);

/// A variable of modelDescription.xml. The variables have the value references 0, 1, ... in their
/// order.
struct FmuVariable {
  std::string name, description;
  enum class Kind { independent, parameter, input, output, state, derivative } kind;
  std::string unit = {};
  double start = 0.0;  ///< for parameters, inputs and states
  std::uint32_t derivative_of = 0;
  /// Value references of the states and inputs that it depends on.
  std::vector<std::uint32_t> depends_on = {};
  bool depends_on_all = false;
};

/// The variables of a body.
std::vector<FmuVariable> fmu_variables(const FmuBody& body);

}  // namespace chladni::mbs_export::formats
