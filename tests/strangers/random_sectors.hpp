#pragma once

#include <cstdint>

#include "checks.hpp"

namespace chladni::strangers {

/// A harmonic of a ring of random sectors about a random axis, reduced by a random method with
/// random masters and support on all ranks of a communicator and, where these are several, on one.
struct SectorTrial {
  std::string words;
  Failures failures;  ///< on the first rank
};
/// @note   Collective.
SectorTrial try_sector(std::uint64_t seed, MPI_Comm comm);

}  // namespace chladni::strangers
