#pragma once

#include "common/files/fields.hpp"
#include "squeal/results/squeal_results.hpp"

/// The stored members of the results of a study: name in the file, unit and place; see
/// common/files/fields.hpp. What a struct has and its list lacks is not stored.
namespace chladni::squeal {

using files::Field, files::Presence;

/// Refuse what later code cannot use as times (ascending), as distinct 1-based modes of a body, and
/// where it asks for the largest value.
void check_times(const files::Reader& file, const std::string& name, const std::vector<double>& t);
void check_modes(const files::Reader& file, const std::string& name,
                 const std::vector<int>& numbers);
void check_some(const files::Reader& file, const std::string& name, const Eigen::VectorXd& x);
void check_state(const files::Reader& file, const std::string& name, const Eigen::VectorXd& x);

constexpr auto fields_of(std::type_identity<ErrorBudget>)
{
  using T = ErrorBudget;
  return std::tuple{Field{"mesh", "own", &T::mesh}, Field{"reduction", "own", &T::reduction},
                    Field{"body", "own", &T::body}, Field{"modes_left_out", "own", &T::left_out},
                    Field{"integration", "own", &T::integration}};
}

constexpr auto fields_of(std::type_identity<StabilityPoint>)
{
  using T = StabilityPoint;
  return std::tuple{Field{"values", "own", &T::value}, Field{"growth", "1/s", &T::growth},
                    Field{"frequency", "Hz", &T::frequency_Hz}};
}

constexpr auto fields_of(std::type_identity<UnstableInterval>)
{
  using T = UnstableInterval;
  return std::tuple{Field{"from", "own", &T::from}, Field{"to", "own", &T::to},
                    Field{"worst", "own", &T::worst}};
}

constexpr auto fields_of(std::type_identity<CriticalSpeed>)
{
  using T = CriticalSpeed;
  return std::tuple{Field{"speed", "rad/s", &T::speed}, Field{"frequency", "Hz", &T::frequency_Hz},
                    Field{"newton_steps", "1", &T::n_newton_steps, "", Presence::later},
                    Field{"errors", "rad/s", &T::budget, "", Presence::later}};
}

constexpr auto fields_of(std::type_identity<StabilityMap>)
{
  using T = StabilityMap;
  return std::tuple{Field{"parameter", "", &T::parameter},
                    Field{"values", "own", &T::values, "m", Presence::always, &check_some},
                    Field{"speeds", "rad/s", &T::speeds, "n", Presence::always, &check_some},
                    Field{"growth", "1/s", &T::growth, "m x n"},
                    Field{"frequency", "Hz", &T::frequency_Hz, "m x n"},
                    Field{"method", "", &T::method, "", Presence::if_any},
                    Field{"error", "1/s", &T::error}};
}

constexpr auto fields_of(std::type_identity<ModeFamily>)
{
  using T = ModeFamily;
  return std::tuple{Field{"nodal_diameters", "1", &T::nodal_diameters},
                    Field{"frequency", "Hz", &T::frequency_Hz},
                    Field{"nodal_circles", "1", &T::nodal_circles, "", Presence::later},
                    Field{"in_plane", "1", &T::in_plane, "", Presence::later}};
}

constexpr auto fields_of(std::type_identity<PeriodWork>)
{
  using T = PeriodWork;
  return std::tuple{Field{"friction", "1", &T::friction}, Field{"normal", "1", &T::normal},
                    Field{"damping", "1", &T::damping}};
}

/// Beside Hill's number of harmonics and error, which belong to its exponents.
constexpr auto fields_of(std::type_identity<RotationStability>)
{
  using T = RotationStability;
  return std::tuple{Field{"speeds", "rad/s", &T::speeds, "m", Presence::always, &check_some},
                    Field{"growth", "1/s", &T::growth, "m"},
                    Field{"frequency", "Hz", &T::frequency_Hz, "m"},
                    Field{"critical_speed", "rad/s", &T::critical_speed},
                    Field{"frozen_growth", "1/s", &T::frozen_growth, "m", Presence::if_any},
                    Field{"method", "", &T::method, "", Presence::if_any},
                    Field{"exponents", "1/s + i rad/s", &T::exponents, "m x r", Presence::if_any}};
}

constexpr auto fields_of(std::type_identity<ModeSubset>)
{
  using T = ModeSubset;
  return std::tuple{
      Field{"n_modes", "1", &T::n_modes},
      Field{"highest_frequency", "Hz", &T::highest_Hz, "", Presence::always, nullptr, "highest_Hz"},
      Field{"growth", "1/s", &T::growth},
      Field{"stability", "", &T::stability, "", Presence::if_any},
      Field{"critical_speed", "rad/s", &T::critical_speed},
      Field{"critical_frequency", "Hz", &T::critical_frequency_Hz}};
}

constexpr auto fields_of(std::type_identity<ModeInfluence>)
{
  using T = ModeInfluence;
  return std::tuple{Field{"nodal_diameters", "1", &T::nodal_diameters},
                    Field{"frequency", "Hz", &T::frequency_Hz},
                    Field{"participation", "1", &T::participation},
                    Field{"growth_without", "1/s", &T::growth_without},
                    Field{"critical_speed_without", "rad/s", &T::critical_speed_without}};
}

void are_numbered(std::type_identity<ModeSubset>);
void are_numbered(std::type_identity<ModeInfluence>);

constexpr auto fields_of(std::type_identity<ModeSensitivity>)
{
  using T = ModeSensitivity;
  return std::tuple{Field{"critical_speed", "rad/s", &T::critical_speed},
                    Field{"critical_frequency", "Hz", &T::critical_frequency_Hz},
                    Field{"subsets", "", &T::subsets}, Field{"modes", "", &T::influences}};
}

constexpr auto fields_of(std::type_identity<GradientMotion>)
{
  using T = GradientMotion;
  return std::tuple{Field{"growth", "1/s", &T::growth}, Field{"frequency", "Hz", &T::frequency_Hz}};
}

constexpr auto fields_of(std::type_identity<Envelope>)
{
  using T = Envelope;
  return std::tuple{Field{"t", "s", &T::t, "n", Presence::always, &check_times},
                    Field{"pad_velocity", "m/s", &T::pad_velocity, "n"},
                    Field{"pad_displacement", "m", &T::pad_displacement, "n"}};
}

constexpr auto fields_of(std::type_identity<Windows>)
{
  using T = Windows;
  return std::tuple{Field{"t", "s", &T::t, "n", Presence::always, &check_times},
                    Field{"speed", "rad/s", &T::speed, "n"},
                    Field{"N_up_min", "N", &T::N_up_min, "n"},
                    Field{"N_up_max", "N", &T::N_up_max, "n"},
                    Field{"N_lo_min", "N", &T::N_lo_min, "n"},
                    Field{"N_lo_max", "N", &T::N_lo_max, "n"},
                    Field{"slip_speed_min", "m/s", &T::slip_speed_min, "n"},
                    Field{"open", "1", &T::open, "n"}};
}

constexpr auto fields_of(std::type_identity<History>)
{
  using T = History;
  return std::tuple{Field{"t", "s", &T::t, "n", Presence::always, &check_times},
                    Field{"pad_velocity", "m/s", &T::pad_velocity, "n"},
                    Field{"pad_displacement", "m", &T::pad_displacement, "n"},
                    Field{"N_up", "N", &T::N_up, "n"},
                    Field{"N_lo", "N", &T::N_lo, "n"},
                    Field{"slip_speed", "m/s", &T::slip_speed, "n"}};
}

constexpr auto fields_of(std::type_identity<ContactEvent>)
{
  using T = ContactEvent;
  return std::tuple{Field{"t", "s", &T::t}, Field{"pad", "1", &T::pad},
                    Field{"gains", "1", &T::gains}};
}

/// Beside the band of the history, which is stored within the history.
constexpr auto fields_of(std::type_identity<Transient>)
{
  using T = Transient;
  return std::tuple{Field{"speed", "rad/s", &T::speed},
                    Field{"step", "s", &T::step},
                    Field{"finished", "1", &T::finished},
                    Field{"integrator", "", &T::integrator},
                    Field{"integrator_reason", "", &T::integrator_reason},
                    Field{"steps", "1", &T::n_steps},
                    Field{"warning", "", &T::warning, "", Presence::if_any},
                    Field{"contact_evaluations", "1", &T::n_contact_evaluations},
                    Field{"N_min", "N", &T::N_min},
                    Field{"N_max", "N", &T::N_max},
                    Field{"slip_speed_min", "m/s", &T::slip_speed_min},
                    Field{"t_zero_force", "s", &T::t_zero_force},
                    Field{"growth_rate", "1/s", &T::growth_rate},
                    Field{"events", "", &T::events},
                    Field{"events/count", "1", &T::n_events, "", Presence::later},
                    Field{"envelope", "", &T::envelope},
                    Field{"windows", "", &T::windows, "", Presence::later},
                    Field{"history", "", &T::history},
                    Field{"tail", "", &T::tail}};
}

constexpr auto fields_of(std::type_identity<Growth>)
{
  using T = Growth;
  return std::tuple{Field{"speed", "rad/s", &T::speed}, Field{"rate", "1/s", &T::rate},
                    Field{"eigenvalue_rate", "1/s", &T::eigenvalue_rate},
                    Field{"envelope", "", &T::envelope}};
}

constexpr auto fields_of(std::type_identity<Spectrum::Peak>)
{
  using T = Spectrum::Peak;
  return std::tuple{Field{"frequency", "Hz", &T::frequency_Hz},
                    Field{"amplitude", "m/s", &T::amplitude}};
}

constexpr auto fields_of(std::type_identity<Spectrum>)
{
  using T = Spectrum;
  return std::tuple{Field{"frequency", "Hz", &T::frequency_Hz, "n", Presence::always, &check_some},
                    Field{"amplitude", "m/s", &T::amplitude, "n"}, Field{"peaks", "", &T::peaks}};
}

constexpr auto fields_of(std::type_identity<Spectrogram>)
{
  using T = Spectrogram;
  return std::tuple{
      Field{"t", "s", &T::t, "n_t", Presence::always, &check_some},
      Field{"speed", "rad/s", &T::speed, "n_t"},
      Field{"envelope", "m/s", &T::envelope, "n_t"},
      Field{"frequency", "Hz", &T::frequency_Hz, "n_f", Presence::always, &check_some},
      Field{"amplitude", "m/s", &T::amplitude, "n_t x n_f"},
      Field{"lines/frequency", "Hz", &T::line_Hz, "n_t x n_lines"},
      Field{"lines/amplitude", "m/s", &T::line_amplitude, "n_t x n_lines"}};
}

constexpr auto fields_of(std::type_identity<MotionStatistics::Line>)
{
  using T = MotionStatistics::Line;
  return std::tuple{Field{"frequency", "Hz", &T::frequency_Hz},
                    Field{"amplitude", "m/s", &T::amplitude},
                    Field{"rotations", "1", &T::rotations}};
}

constexpr auto fields_of(std::type_identity<MotionStatistics>)
{
  using T = MotionStatistics;
  return std::tuple{Field{"speed", "rad/s", &T::speed},
                    Field{"from", "s", &T::from},
                    Field{"band", "Hz", &T::band_Hz},
                    Field{"rms_velocity", "m/s", &T::rms_velocity},
                    Field{"peak_velocity", "m/s", &T::peak_velocity},
                    Field{"rms_displacement", "m", &T::rms_displacement},
                    Field{"peak_displacement", "m", &T::peak_displacement},
                    Field{"N_min", "N", &T::N_min},
                    Field{"N_max", "N", &T::N_max},
                    Field{"open", "1", &T::open},
                    Field{"drift", "1", &T::drift},
                    Field{"modulation", "1", &T::modulation},
                    Field{"n_rotations", "1", &T::n_rotations},
                    Field{"settled", "1", &T::settled},
                    Field{"rms_over_angle", "m/s", &T::rms_over_angle, "n_parts", Presence::always,
                          &check_some, "rms_velocity_over_angle_m_s"},
                    Field{"lines", "", &T::lines}};
}

constexpr auto fields_of(std::type_identity<LimitCycle>)
{
  using T = LimitCycle;
  return std::tuple{
      Field{"speed", "rad/s", &T::speed},
      Field{"frequency", "Hz", &T::frequency_Hz},
      Field{"pad_velocity", "m/s", &T::pad_velocity},
      Field{"pad_displacement", "m", &T::pad_displacement},
      Field{"N_min", "N", &T::N_min},
      Field{"N_max", "N", &T::N_max},
      Field{"drift", "1", &T::drift},
      Field{"settled", "1", &T::settled},
      Field{"t_zero_force", "s", &T::t_zero_force},
      Field{"t_99", "s", &T::t_99},
      Field{"mode_numbers", "1", &T::mode_numbers, "", Presence::always, &check_modes},
      Field{"amplitude", "m kg^(1/2)", &T::amplitude}};
}

constexpr auto fields_of(std::type_identity<CycleEnergy>)
{
  using T = CycleEnergy;
  return std::tuple{Field{"friction", "J", &T::friction, "n_pads"},
                    Field{"normal", "J", &T::normal, "n_pads"}, Field{"damping", "J", &T::damping},
                    Field{"heat", "J", &T::heat, "n_pads"}, Field{"stored", "J", &T::stored}};
}

constexpr auto fields_of(std::type_identity<CycleErrors>)
{
  using T = CycleErrors;
  return std::tuple{Field{"frequency", "Hz", &T::frequency_Hz},
                    Field{"pad_velocity", "m/s", &T::pad_velocity},
                    Field{"pad_displacement", "m", &T::pad_displacement}};
}

constexpr auto fields_of(std::type_identity<DirectLimitCycle>)
{
  using T = DirectLimitCycle;
  return std::tuple{
      Field{"speed", "rad/s", &T::speed},
      Field{"frequency", "Hz", &T::frequency_Hz},
      Field{"pad_velocity", "m/s", &T::pad_velocity},
      Field{"pad_displacement", "m", &T::pad_displacement},
      Field{"N_min", "N", &T::N_min},
      Field{"N_max", "N", &T::N_max},
      Field{"slip_speed_min", "m/s", &T::slip_speed_min},
      Field{"x", "m kg^(1/2) / s", &T::x, "size", Presence::always, &check_state},
      Field{"multipliers", "1", &T::multipliers, "size"},
      Field{"multiplier_error", "1", &T::multiplier_error},
      Field{"newton_steps", "1", &T::n_newton_steps},
      Field{"contact_evaluations", "1", &T::n_contact_evaluations},
      Field{"mode_numbers", "1", &T::mode_numbers, "n_modes", Presence::always, &check_modes},
      Field{"amplitude", "m kg^(1/2)", &T::amplitude, "n_modes"},
      Field{"energy", "", &T::energy},
      Field{"way", "", &T::way, "", Presence::if_any},
      Field{"errors", "", &T::errors}};
}

constexpr auto fields_of(std::type_identity<BranchPoint>)
{
  using T = BranchPoint;
  return std::tuple{Field{"speeds", "rad/s", &T::speed},
                    Field{"frequency", "Hz", &T::frequency_Hz},
                    Field{"pad_velocity", "m/s", &T::pad_velocity},
                    Field{"pad_displacement", "m", &T::pad_displacement},
                    Field{"N_min", "N", &T::N_min},
                    Field{"N_max", "N", &T::N_max},
                    Field{"largest_multiplier", "1", &T::largest_multiplier},
                    Field{"multiplier_error", "1", &T::multiplier_error, "", Presence::later}};
}

/// Beside the origin and the second part.
constexpr auto fields_of(std::type_identity<LimitCycleBranch>)
{
  using T = LimitCycleBranch;
  return std::tuple{Field{"", "", &T::points}, Field{"folds", "", &T::folds, "", Presence::if_any},
                    Field{"lost_below", "rad/s", &T::lost_below},
                    Field{"lost_above", "rad/s", &T::lost_above},
                    Field{"note", "", &T::note, "", Presence::if_any}};
}

}  // namespace chladni::squeal
