#pragma once

#include <optional>
#include <string>

#include "files/hdf5.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// The frequency content of a history as text: "band-limited to 11400 Hz, 30000 samples in a
/// second".
std::string spoken(const Band& band);

/// Write and read the dataset of a number that may be absent.
void write_optional(files::Writer& file, const std::string& name, const std::optional<double>& x,
                    const std::string& unit);
std::optional<double> read_optional(const files::Reader& file, const std::string& name);

/// Write and read an envelope in the group `group` of a result file.
void write_envelope(files::Writer& file, const std::string& group, const Envelope& envelope);
Envelope read_envelope(const files::Reader& file, const std::string& group);

/// Write and read the group /transient of a result file.
void write_transient(files::Writer& file, const Transient& run);
Transient read_transient(const files::Reader& file);

}  // namespace chladni::squeal
