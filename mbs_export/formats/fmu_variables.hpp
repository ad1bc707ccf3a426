#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmu/modal_model.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export::formats {

/// A degree of freedom of an attachment node, as variables of an FMU name it.
struct FmuDof {
  std::string node;  ///< "hub", "track[17]", "node[4711]"; quoted where FMI wants it
  int component;     ///< 0 to 5
};

/// What a body is in an FMU.
struct FmuBody {
  std::vector<FmuDof> dofs;  ///< rows of the model's Phi
  fmu::ModalModel model;
  int n_still = 0;  ///< degrees of freedom left out, for the body does not move there
};

/// The degrees of freedom of the sets, of all attachment nodes where none is named, that the body
/// moves in.
/// @throws chladni::Error naming a set that is not there, and where nothing is left.
FmuBody fmu_body(const ModalBody& body, const std::vector<std::string>& sets);

/// A variable of modelDescription.xml; in their order they have the value references 0, 1, ...
struct FmuVariable {
  std::string name, description;
  enum class Kind { independent, parameter, input, output, state, derivative } kind;
  std::string unit = {};
  double start = 0.0;  ///< of parameters, inputs and states
  std::uint32_t derivative_of = 0;
  /// Value references of states and inputs; nothing said means all of them
  std::vector<std::uint32_t> depends_on = {};
  bool depends_on_all = false;
};

std::vector<FmuVariable> fmu_variables(const FmuBody& body);

}  // namespace chladni::mbs_export::formats
