#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/reduction.hpp"

/// The step from a reduction, which knows DOFs, to the system that is written, which knows nodes.
namespace chladni::reduce {

/// Adds K, M and the frequencies of a model to `described`.
/// @param described  title, nodes, sets and masters, in the order of `reduce::Body::masters`; a
///                   ring motion has its shapes
/// @param places     `reduce::coordinate_places`
mbs_export::ReducedSystem with_model(mbs_export::ReducedSystem described,
                                     const reduce::ReducedModel& model,
                                     const std::vector<int>& places);

/// The certificate of a reduction in the form of the file.
/// @param fixed  names of the support under which the reduction was certified
mbs_export::Certificate certificate_of(const reduce::Certificate& certificate,
                                       std::vector<std::string> fixed);

/// The system that `mbs_export::write_reduced` writes: `with_model` for the reduction, with its
/// certificate.
/// @param fixed  as for `certificate_of`
mbs_export::ReducedSystem reduced_system(mbs_export::ReducedSystem described,
                                         const reduce::FactoredBody& body,
                                         const reduce::Reduction& reduction,
                                         std::vector<std::string> fixed = {});

/// The versions of the libraries that are running, "Petsc Release Version ...; SLEPc ...".
std::string library_versions();

}  // namespace chladni::reduce
