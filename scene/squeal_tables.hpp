#pragma once

#include <string>
#include <vector>

#include "scene/document.hpp"
#include "squeal/friction.hpp"
#include "squeal/squeal_options.hpp"

/// What the readers of [squeal] share, whichever model it asks for.
namespace chladni::scene {

/// squeal.speeds
squeal::SpeedRange read_speeds(const Table& squeal);

/// squeal.friction: one coefficient, or a table with `kinetic`, `static`, `decay_speed` and
/// `regularisation`.
squeal::FrictionLaw read_friction(const Table& squeal);

/// squeal.contact; unilateral when it is missing.
squeal::ContactLaw read_contact(const Table& squeal);

/// The spring of a pad from its keys `stiffness` and `cubic_stiffness`.
squeal::PadSpring read_pad_spring(const Table& pad);

/// squeal.pads of a flexible disc
std::vector<squeal::PadPair> read_pads(const Table& squeal);

/// squeal.analyses, each of which must be one of `known` and have the key that it needs.
std::vector<std::string> read_analyses(const Table& squeal, const std::vector<std::string>& known);

/// squeal.transient
std::optional<squeal::TransientCase> read_transient(const Table& squeal);

/// squeal.growth
std::optional<squeal::GrowthCase> read_growth(const Table& squeal);

/// squeal.limit_cycle_direct; at the speed of the transient unless the scene gives another one.
std::optional<squeal::DirectCase> read_direct(
    const Table& squeal, const std::optional<squeal::TransientCase>& transient);

/// squeal.rotation_stability; by Hill's method when it is missing.
squeal::RotationMethod read_rotation_method(const Table& squeal);

/// squeal.critical
std::vector<squeal::CriticalCase> read_critical(const Table& squeal);

/// squeal.map
std::optional<squeal::MapCase> read_map(const Table& squeal);

}  // namespace chladni::scene
