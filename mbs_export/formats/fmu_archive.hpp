#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mbs_export/fmu/modal_model.hpp"
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

/// The options of an FMU.
struct FmuOptions {
  FmiVersion version = FmiVersion::v2;
  std::vector<std::string> sets;  ///< of attachment nodes; empty: all nodes
  std::string identifier;         ///< letters, digits and _ (see fmu_identifier)
};

/// An FMU, and notes for the user about it.
struct Fmu {
  std::string archive;  ///< the bytes of the .fmu
  std::vector<std::string> notes;
};

/// A model and the other parts of its FMU.
struct FmuParts {
  FmiVersion version;
  std::string identifier, description;  ///< modelDescription.xml
  std::string library;                  ///< of Chladni, as "chladni-fmu.so"
  std::string resource, model;          ///< name of the model's file, and its bytes
};

/// The bytes of the .fmu.
/// @throws chladni::Error when the library of this machine does not exist for the version of FMI or
///         is not installed.
std::string fmu_archive(const FmuParts& parts);

/// A digest of the model and of the names of its variables, which distinguishes one export from
/// another.
std::string fmu_token(const std::string& model, const std::vector<FmuVariable>& variables);

/// A C identifier made from any name.
std::string fmu_identifier(const std::string& name);

/// A body as Functional Mock-up Unit for model exchange and co-simulation. Inputs are forces and
/// moments at its attachment nodes, outputs are displacements, velocities and accelerations, states
/// are modal coordinates. Rigid-body motions that the supports leave free are states like others,
/// valid for small motions.
/// @throws chladni::Error when a set does not exist, and when the library of this machine does not
///         exist for the version of FMI or is not installed.
Fmu fmu(const ModalBody& body, const FmuOptions& options);

}  // namespace chladni::mbs_export::formats
