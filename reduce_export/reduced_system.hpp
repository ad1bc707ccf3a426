#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/reduction.hpp"

/// From a reduction, which knows DOFs, to the system that is written, which knows nodes.
namespace chladni::reduce_export {

/// `described` with K, M and the frequencies of a model.
/// @param described  title, nodes, sets and masters, in the order of `reduce::Body::masters`; of a
///                   ring motion the shapes
/// @param places  `reduce::coordinate_places`
mbs_export::ReducedSystem with_model(mbs_export::ReducedSystem described,
                                     const reduce::ReducedModel& model,
                                     const std::vector<int>& places);

/// @param fixed  the names of the support that the reduction was certified under
mbs_export::Certificate certificate_of(const reduce::Certificate& certificate,
                                       std::vector<std::string> fixed);

/// What `mbs_export::write_reduced` writes: `with_model` of the reduction, with its certificate.
/// @param fixed  as of `certificate_of`
mbs_export::ReducedSystem reduced_system(mbs_export::ReducedSystem described,
                                         const reduce::FactoredBody& body,
                                         const reduce::Reduction& reduction,
                                         std::vector<std::string> fixed = {});

/// "Petsc Release Version ...; SLEPc ..." of the libraries that are running.
std::string library_versions();

}  // namespace chladni::reduce_export
