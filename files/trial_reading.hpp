#pragma once

#include <string>

namespace chladni::files {

/// Whether libhdf5 gets through a file that nobody vouches for: a process of its own opens it and
/// reads every attribute and dataset, with memory and time that befit the size of the file.
/// libhdf5 1.10 follows damaged metadata out of its memory, or in circles until no memory is left.
/// @return false when that process was ended for it; what libhdf5 refuses in order is no matter
/// here
bool survives_reading(const std::string& path);

}  // namespace chladni::files
