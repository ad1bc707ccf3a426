#pragma once

#include <string>
#include <vector>

#include "mbs_export/formats/fmu_description.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export::formats {

/// What is to be told to make an FMU.
struct FmuOptions {
  FmiVersion version = FmiVersion::v2;
  std::vector<std::string> sets;  ///< of attachment nodes; all where none is named
  std::string identifier;         ///< letters, digits and _ (see fmu_identifier)
};

/// An FMU, and what is to be told of it.
struct Fmu {
  std::string archive;  ///< the bytes of the .fmu
  std::vector<std::string> notes;
};

/// A model and what it is in an FMU.
struct FmuParts {
  FmiVersion version;
  std::string identifier, description;  ///< modelDescription.xml
  std::string library;                  ///< of Chladni: "chladni-fmu.so"
  std::string resource, model;          ///< the name of the model's file, and its bytes
};

/// The bytes of the .fmu.
/// @throws chladni::Error where this machine's library is none for the version of FMI or is not
///         installed.
std::string fmu_archive(const FmuParts& parts);

/// What tells an export from another one: a digest of the model and of the names of its variables.
std::string fmu_token(const std::string& model, const std::vector<FmuVariable>& variables);

/// A name as C has them, of any name.
std::string fmu_identifier(const std::string& name);

/// A body as Functional Mock-up Unit for model exchange and co-simulation: forces and moments at
/// its attachment nodes in, displacements, velocities and accelerations out, modal coordinates as
/// states. Rigid-body motions that the supports leave free are states as others are: for small
/// motions.
/// @throws chladni::Error when a set is not there, and where this machine's library is none for the
///         version of FMI or is not installed.
Fmu fmu(const ModalBody& body, const FmuOptions& options);

}  // namespace chladni::mbs_export::formats
