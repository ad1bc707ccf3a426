#pragma once

#include "mbs_export/responses/frequency_responses.hpp"

namespace chladni::mbs_export {

/// The measured functions between an output and a load of the computed responses, in the quantity
/// of these. A measured node belongs to the place that names it as its `measured_node`, or else to
/// the nearest place within the distance; directions have to agree.
/// @param computed  with quantity, frequencies (those of the measurement), loads and outputs
/// @throws chladni::Error naming the file if no function is between an output and a load, if two
///         measured nodes belong to one place, and if a measured node has axes of its own.
/// @throws ResponseOptionError for 0 Hz where the measured quantity is another than the computed
/// one.
MeasuredResponses measured_beside(const Measurement& measurement,
                                  const FrequencyResponses& computed);

/// Frequency response assurance criterion: |x^H y|^2 / (x^H x y^H y), 1 for functions that differ
/// by a factor, 0 if one of them is zero. Source: Allemang, Sound and Vibration 37 (2003) no.
/// 8, 14.
double response_assurance(const Eigen::VectorXcd& x, const Eigen::VectorXcd& y);

/// sqrt(y^H y / x^H x): how large y is beside x.
double amplitude_ratio(const Eigen::VectorXcd& x, const Eigen::VectorXcd& y);

}  // namespace chladni::mbs_export
