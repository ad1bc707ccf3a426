#pragma once

#include <optional>
#include <string>
#include <vector>

namespace chladni::mbs_export {

/// Largest relative error of the frequency responses at the loaded attachment DOFs, over a range.
struct Tolerance {
  double error;     ///< 0 < error < 1
  double up_to_Hz;  ///< the range is 0 to here
};

/// Which constrained modes the body keeps: exactly one member is set; none means all.
struct KeptModes {
  std::optional<int> count;
  std::optional<double> up_to_Hz;
  std::optional<std::vector<int>> list;  ///< 1-based, in ascending order of frequency
  /// As few modes and interface modes as meet it; `interface_modes` then name loads to choose from.
  std::optional<Tolerance> tolerance = {};
};

/// IRM (at = set, omega0 = 0) or FRM of one set of loaded attachment nodes.
struct InterfaceModes {
  enum class Kind { irm, frm };
  /// Where the response is sought: among the neglected modes, or in the FE model at the time of the
  /// reduction, which makes room for it in the reduced system.
  enum class Space { reduced, full };
  Kind kind;
  std::string at;                ///< name of an attachment set
  std::vector<int> components;   ///< loaded components 0..5 of each of its nodes
  std::optional<double> omega0;  ///< rad/s; absent = half the first elastic free frequency
  Space space = Space::reduced;
};

/// Damping of the body in its final coordinates.
struct Damping {
  enum class Type { none, modal, rayleigh, matrix };
  Type type = Type::none;
  std::vector<double> ratios =
      {};  ///< modal: one for all modes, one for each, or as many as `at_Hz`
  std::vector<double> at_Hz = {};  ///< modal: ascending; linear between; empty: not by frequency
  double alpha = 0.0;              ///< Rayleigh, 1/s
  double beta = 0.0;               ///< Rayleigh, s
};

/// "none", "modal", "rayleigh", "matrix".
std::string name_of(Damping::Type type);

/// The scene's [body].
struct BodyOptions {
  std::vector<std::string> fixed;  ///< "SET" (whole nodes) or "SET.x|y|z|rx|ry|rz"
  KeptModes keep;
  std::vector<InterfaceModes> interface_modes;
  Damping damping;
};

}  // namespace chladni::mbs_export
