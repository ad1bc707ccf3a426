#pragma once

#include "mbs_export/hdf5.hpp"
#include "squeal/results.hpp"

namespace chladni::squeal {

/// The group /eigenvalues of a result file.
void write_eigenvalues(mbs_export::hdf5::Writer& file, const EigenvalueMap& map);
EigenvalueMap read_eigenvalues(const mbs_export::hdf5::Reader& file);

/// The groups /critical_values/I of a result file, I = 1, 2, ...
void write_critical_values(mbs_export::hdf5::Writer& file,
                           const std::vector<CriticalValue>& values);
std::vector<CriticalValue> read_critical_values(const mbs_export::hdf5::Reader& file);

/// The group /spectrum of a result file.
void write_spectrum(mbs_export::hdf5::Writer& file, const Spectrum& spectrum);
Spectrum read_spectrum(const mbs_export::hdf5::Reader& file);

/// The group /limit_cycle_direct/energy of a result file.
void write_energy(mbs_export::hdf5::Writer& file, const CycleEnergy& energy);
CycleEnergy read_energy(const mbs_export::hdf5::Reader& file);

/// "N" of a preload, ...
std::string unit_of(const std::string& parameter);

}  // namespace chladni::squeal
