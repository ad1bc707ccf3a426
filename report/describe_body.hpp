#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mbs_export/certificate.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"
#include "squeal/results/squeal_results.hpp"

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

/// The certificate of a reduced system as text for the terminal; empty when no error was estimated
/// and no eigenvalue counted.
std::string describe_certificate(const mbs_export::Certificate& certificate);

/// JSON members `condition_Q_dd`, `interface_modes_dropped`, `condition_directions` if known and,
/// when a tolerance chose the modes, `selection` with `tolerance`, `error_of_reduction`,
/// `up_to_Hz`, `loads` and, for `modes_only` and `with_interface_modes`, the steps {added, modes,
/// interface_modes, error}.
std::vector<Json::Member> preparation_json(const mbs_export::ModalBody& body);

}  // namespace chladni::report
