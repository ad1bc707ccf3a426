#pragma once

#include <filesystem>
#include <string>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "report/output.hpp"
#include "squeal/results/results.hpp"

/// The contents of the files as tables for the terminal.
namespace chladni::report {

TextTable describe(const mbs_export::ReducedSystem& reduced);
TextTable describe(const mbs_export::ModalBody& body);
TextTable describe(const squeal::SquealResults& results);

/// "rigid", "constrained" or "interface".
std::string name_of(mbs_export::ModeKind kind);

/// A table of a body's modes: frequency, kind, and what damps each mode.
TextTable list_modes(const mbs_export::ModalBody& body);

/// A text that compares size and error of the selection steps when a tolerance chose the body's
/// modes, and states the choice; empty when the modes were chosen in another way.
std::string describe_selection(const mbs_export::ModalBody& body);

/// Describes any file of Chladni: a reduced system, a modal body or the results of squeal.
std::string describe_file(const std::filesystem::path& path);

}  // namespace chladni::report
