#pragma once

#include <filesystem>
#include <string>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "report/output.hpp"
#include "squeal/results/results.hpp"

/// What the files hold, as tables for people.
namespace chladni::report {

TextTable describe(const mbs_export::ReducedSystem& reduced);
TextTable describe(const mbs_export::ModalBody& body);
TextTable describe(const squeal::SquealResults& results);

/// "rigid", "constrained" or "interface".
std::string name_of(mbs_export::ModeKind kind);

/// The frequencies of a body's modes with their kinds, and what damps each of them.
TextTable list_modes(const mbs_export::ModalBody& body);

/// Size against error of a selection by tolerance, and what became of it; empty when a body's modes
/// were chosen otherwise.
std::string describe_selection(const mbs_export::ModalBody& body);

/// Says what any file of Chladni holds: a reduced system, a modal body or the results of squeal.
/// @throws chladni::Error when the file is none of these or is damaged.
std::string describe_file(const std::filesystem::path& path);

}  // namespace chladni::report
