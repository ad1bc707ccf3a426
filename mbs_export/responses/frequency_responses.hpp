#pragma once

#include <Eigen/Core>

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {

/// A unit load that some nodes share equally, or the motion of one node.
struct ResponseDof {
  std::string name;  ///< "tip.z", or "track.z (node 17)" of a set of several nodes
  std::string key;   ///< key of the scene's table [response] that asks for it, "loads[1].dofs"
  int component;     ///< 0 to 5
  std::vector<int> nodes;                          ///< places in NamedNodes::nodes
  std::optional<std::int64_t> measured_node = {};  ///< number of the node in a measurement
};

/// The attachment nodes and sets of a model.
struct NamedNodes {
  const std::vector<AttachmentNode>& nodes;
  const std::vector<AttachmentSet>& sets;
};

/// One load for each component of each place. The nodes of its set share the unit equally, or the
/// node nearest to `near` bears it alone.
/// @throws ResponseOptionError for an unknown or empty set, two nodes equally near, a load that is
///         named twice, and a moment about a drilling axis.
std::vector<ResponseDof> response_loads(const NamedNodes& model,
                                        const std::vector<ResponsePlace>& places);

/// One output for each node and component.
/// @throws ResponseOptionError for an unknown or empty set, two nodes equally near, and an output
///         that is named twice, and one measured node for several nodes. Drilling rotations are
///         allowed.
std::vector<ResponseDof> response_outputs(const NamedNodes& model,
                                          const std::vector<ResponsePlace>& places);

/// The place of a load or an output.
struct ResponsePoint {
  std::string name;
  int component;             ///< 0 to 5
  std::int64_t node;         ///< number in the mesh; 0 if several nodes share a load
  Eigen::Vector3d position;  ///< m; the mean of several nodes
  std::optional<std::int64_t> measured_node = {};  ///< number of the node in a measurement
};

/// A measured response beside the computed one of a load and an output.
struct MeasuredResponse {
  std::string name;   ///< first line of text in the file
  std::int64_t line;  ///< of the file, where it begins
  std::size_t load;
  Eigen::Index output;
  Eigen::VectorXcd H;  ///< [n_f] as that of FrequencyResponses
};

/// Measured responses at the frequencies of the computed ones.
struct MeasuredResponses {
  std::string file;
  std::vector<MeasuredResponse> functions = {};
};

/// Section forces (1 + i eta) S q per unit of each load at all frequencies, for a material with the
/// complex modulus. Viscous damping of the modes does not contribute.
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
  /// Other damping: the type of [body] damping, or "file" of a body.
  std::string damping;
  std::vector<ResponsePoint> loads, outputs;
  /// For each load [n_f x n_outputs]: m or rad per N or N m, divided by s or s^2 as `quantity`
  /// says.
  std::vector<Eigen::MatrixXcd> H;
  std::vector<SectionForceResponses> section_forces = {};
  MeasuredResponses measured = {};
  Provenance provenance = {};
};

/// The frequencies of a range, rad/s, ascending.
Eigen::VectorXd angular_frequencies(const FrequencyRange& range);
/// Those of the measurement, or of the range without one.
Eigen::VectorXd angular_frequencies(const ResponseOptions& options);

/// (i Omega)^p with p = 0 for a receptance, 1 for a mobility, 2 for an accelerance.
std::complex<double> rate_factor(ResponseQuantity quantity, double Omega);

/// The unit of an output for one load: "m/N", "(rad/s)/(N m)", ...
std::string unit_of(ResponseQuantity quantity, const ResponsePoint& output,
                    const ResponsePoint& load);

/// The place of a load or an output in a model.
ResponsePoint point_of(const NamedNodes& model, const ResponseDof& dof);

/// The names "body", "reduced", "fe" of models, and "receptance", "mobility", "accelerance" of
/// quantities.
std::string name_of(ResponseModel model);
std::string name_of(ResponseQuantity quantity);

/// The responses U ((1 + i eta) diag(omega^2) + i H + i Omega C - Omega^2 I)^-1 B of a body, which
/// may hold all modes of a reduced system. H is its structural damping and C excludes the viscous
/// equivalent of H. If C and H couple no modes, each mode responds by itself; otherwise one
/// equation of all modes is solved at each frequency.
/// @throws ResponseOptionError for a place that the body does not have, a load on a DOF that does
///         not move, an unknown group of section forces, and a frequency at which an undamped mode
///         is in resonance: |k - Omega^2 m| < 1e-9 (k + Omega^2 m); and as measured_beside.
FrequencyResponses frequency_responses(const ModalBody& body, const ResponseOptions& options);

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
