#pragma once

#include <optional>
#include <vector>

#include "scene/document.hpp"
#include "squeal/assembly_options.hpp"
#include "squeal/friction.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/study_options.hpp"

/// What the readers of [squeal] share, whichever model it asks for.
namespace chladni::scene {

/// `friction` of [squeal] or of a pad: one coefficient, or a table with `kinetic`, `static`,
/// `decay_speed` and `regularisation`, or with measured values in `table`.
squeal::FrictionLaw read_friction(const Table& of);

/// The same for a model that cannot take measured values.
squeal::FrictionLaw read_plain_friction(const Table& squeal);

/// squeal.contact; unilateral when it is missing.
squeal::ContactLaw read_contact(const Table& squeal);

/// The spring of a pad from its keys `stiffness` and `cubic_stiffness`.
squeal::PadSpring read_pad_spring(const Table& pad);

/// [[part]], [[joint]], [[contact]] and what [squeal] says of an assembly
squeal::AssemblyOptions read_assembly(const Table& root);

/// squeal.pads of a flexible disc
std::vector<squeal::PadPair> read_pads(const Table& squeal);

/// Whether the disc between the pads is a modal body: the analyses that need one are there then.
enum class StudyOf { body, model };

/// The keys of [squeal] that say what is to be found out.
squeal::StudyOptions read_study(const Table& squeal, StudyOf of);

/// squeal.limit_cycle_direct; at the speed of the transient unless the scene gives another one.
std::optional<squeal::DirectCase> read_direct(
    const Table& squeal, const std::optional<squeal::TransientCase>& transient);

/// squeal.rotation_stability; by Hill's method when it is missing.
squeal::RotationMethod read_rotation_method(const Table& squeal);

/// squeal.critical
std::vector<squeal::CriticalCase> read_critical(const Table& squeal, StudyOf of);

/// squeal.map
std::optional<squeal::MapCase> read_map(const Table& squeal, StudyOf of);

/// squeal.stability, which is over the speeds of the study unless it says otherwise.
std::optional<squeal::StabilityCase> read_stability(const Table& squeal,
                                                    const squeal::SpeedRange& speeds, StudyOf of);

}  // namespace chladni::scene
