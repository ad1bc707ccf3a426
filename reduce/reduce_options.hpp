#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace chladni::reduce {

/// With `automatic`, which needs a tolerance, the method is what costs least.
enum class Method { guyan, craig_bampton, mixed_interface, rubin, macneal, automatic };

/// Their names in scenes and options.
constexpr std::string_view name_of(Method method)
{
  constexpr std::array<std::string_view, 6> names{"guyan", "craig-bampton", "mixed-interface",
                                                  "rubin", "macneal",       "auto"};
  return names[static_cast<std::size_t>(method)];
}

/// As few fixed-interface modes as keep the estimated relative error eta^2 of omega^2 of each mode
/// of the supported body up to a frequency below a tolerance; of the mixed interface all modes of
/// the supported body up to that frequency, which have no such error.
struct ModesByTolerance {
  double tolerance;
  double up_to_Hz;
};

/// How many fixed-interface modes, modes of the supported body (mixed interface), or free-interface
/// ones of Rubin and MacNeal, which know no tolerance: exactly one member is set (none for Guyan).
struct ReduceOptions {
  Method method = Method::craig_bampton;
  std::optional<int> modes = {};
  std::optional<double> cutoff_Hz = {};
  std::optional<ModesByTolerance> tolerance = {};
  /// With cutoff_Hz: fixed-interface modes that are kept even where they are above it. Without any,
  /// a cut-off below the first mode is an error.
  int at_least = 0;
  bool may_have_none = false;  ///< with cutoff_Hz: methods with free masters do with statics alone
  int expected = 32;           ///< with cutoff_Hz: how many are looked for at first
  /// The modes that get an error are those below this frequency, however many modes the basis has;
  /// without it those up to the last mode of the basis, or of the tolerance's range.
  std::optional<double> certified_up_to_Hz = {};
};

}  // namespace chladni::reduce
