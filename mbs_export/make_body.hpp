#pragma once

#include "mbs_export/body_options.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// The modal body of a reduced system: free modes are orthogonalised, displacements are held by
/// mode shifting, the modes of the held body are computed, some of them are kept, and interface
/// modes represent the others. M_m = I and K_m = diag(omega^2), since modes and interface modes are
/// orthogonal. A body that is not held, or not completely (`n_free_rigid`), keeps its rigid-body
/// motions.
/// @throws chladni::Error for a set, component or mode that does not exist, for displacements that
///         cannot be held together, and for damping that does not fit.
ModalBody make_body(const ReducedSystem& reduced, const BodyOptions& options);

}  // namespace chladni::mbs_export
