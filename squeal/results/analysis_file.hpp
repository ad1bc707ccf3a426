#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Write and read the group /eigenvalues of a result file.
void write_eigenvalues(files::Writer& file, const EigenvalueMap& map);
EigenvalueMap read_eigenvalues(const files::Reader& file);

/// Write and read the groups /critical_values/I of a result file, I = 1, 2, ...
void write_critical_values(files::Writer& file, const std::vector<CriticalValue>& values);
std::vector<CriticalValue> read_critical_values(const files::Reader& file);

/// Write and read the group /spectrum of a result file.
void write_spectrum(files::Writer& file, const Spectrum& spectrum);
Spectrum read_spectrum(const files::Reader& file);

/// Write and read the group /spectrogram of a result file.
void write_spectrogram(files::Writer& file, const Spectrogram& spectrogram);
Spectrogram read_spectrogram(const files::Reader& file);

/// Write and read the group /limit_cycle_direct/energy of a result file.
void write_energy(files::Writer& file, const CycleEnergy& energy);
CycleEnergy read_energy(const files::Reader& file);

/// The unit of a parameter by its key, such as "N" for a preload.
std::string unit_of(const std::string& parameter);

}  // namespace chladni::squeal
