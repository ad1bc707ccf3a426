#pragma once

#include <petscksp.h>

namespace chladni::reduce {

/// Keeps MUMPS from printing: its errors come back by MatFactorGetError and are thrown. Options
/// -<prefix>mat_mumps_icntl_1 to _4 still count. Does nothing for other packages.
/// @param pc  whose type and package are set
void quiet_mumps(PC pc);

}  // namespace chladni::reduce
