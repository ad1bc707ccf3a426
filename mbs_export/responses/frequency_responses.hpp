#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/responses/response_dofs.hpp"
#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {

/// Where a load acts or an output is taken.
struct ResponsePoint {
  std::string name;
  int component;             ///< 0 to 5
  std::int64_t node;         ///< number of the mesh; 0 where several nodes share a load
  Eigen::Vector3d position;  ///< m; the mean of several nodes
};

/// Section forces (1 + i eta) S q for each unit of load, at all frequencies: those of a material
/// with the complex modulus. Viscous damping of the modes has no share in them.
struct SectionForceResponses {
  ResultantModes points;  ///< kinds, units and places; S is empty
  std::vector<Eigen::MatrixXcd>
      r;  ///< of each load [n_f x n_points n_kinds], kinds of a point in turn
};

/// Steady responses u(t) = Re(H exp(i Omega t)) to harmonic unit loads.
struct FrequencyResponses {
  std::string title;
  ResponseModel model;
  ResponseQuantity quantity;
  Eigen::VectorXd Omega;     ///< [n_f] rad/s, ascending
  double loss_factor = 0.0;  ///< eta of K (1 + i eta)
  std::string damping;       ///< what else damps: the type of [body] damping, "file" of a body
  std::vector<ResponsePoint> loads, outputs;
  /// Of each load [n_f x n_outputs]: m or rad per N or N m, over s or s^2 as `quantity` says.
  std::vector<Eigen::MatrixXcd> H;
  std::vector<SectionForceResponses> section_forces = {};
  Provenance provenance = {};
};

/// The frequencies of a range, rad/s, ascending.
Eigen::VectorXd angular_frequencies(const FrequencyRange& range);

/// (i Omega)^p: p = 0 of a receptance, 1 of a mobility, 2 of an accelerance.
std::complex<double> rate_factor(ResponseQuantity quantity, double Omega);

/// "m/N", "(rad/s)/(N m)", ...: the unit of an output for one load.
std::string unit_of(ResponseQuantity quantity, const ResponsePoint& output,
                    const ResponsePoint& load);

ResponsePoint point_of(const NamedNodes& model, const ResponseDof& dof);

/// "body", "reduced", "fe"; "receptance", "mobility", "accelerance".
std::string name_of(ResponseModel model);
std::string name_of(ResponseQuantity quantity);

/// U ((1 + i eta) diag(omega^2) + i H + i Omega C - Omega^2 I)^-1 B of a body, which may hold all
/// modes of a reduced system, H its structural damping and C without the viscous equivalent of it.
/// Without a coupling by C and H each mode responds by itself; else one
/// equation of all modes is solved at each frequency.
/// @throws ResponseOptionError for a place that the body does not have, a load on what does not
///         move, an unknown group of section forces, and a frequency at which an undamped mode is
///         in resonance: |k - Omega^2 m| < 1e-9 (k + Omega^2 m).
FrequencyResponses frequency_responses(const ModalBody& body, const ResponseOptions& options);

}  // namespace chladni::mbs_export
