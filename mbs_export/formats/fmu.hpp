#pragma once

#include <string>
#include <vector>

#include "mbs_export/formats/fmu_description.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export::formats {

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
