#pragma once

#include <optional>
#include <vector>

#include "scene/document.hpp"
#include "squeal/assembly_options.hpp"
#include "squeal/friction.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/study_options.hpp"

/// Readers that all models of [squeal] share. All throw chladni::Error as the functions of Table.
namespace chladni::scene {

/// Reads `friction` of [squeal] or of a pad: one coefficient, a table with `kinetic`, `static`,
/// `decay_speed` and `regularisation`, or measured values in `table`.
squeal::FrictionLaw read_friction(const Table& of);

/// Reads `friction` for a model that does not support measured values.
squeal::FrictionLaw read_plain_friction(const Table& squeal);

/// Reads contact of [squeal]; unilateral when it is missing.
squeal::ContactLaw read_contact(const Table& squeal);

/// Reads the spring of a pad from its keys `stiffness` and `cubic_stiffness`.
squeal::PadSpring read_pad_spring(const Table& pad);

/// Reads [[part]], [[joint]], [[contact]] and the keys of [squeal] for an assembly.
squeal::AssemblyOptions read_assembly(const Table& root);

/// Reads pads of [squeal] for a flexible disc.
std::vector<squeal::PadPair> read_pads(const Table& squeal);

/// Whether the study has a modal body; some analyses need one.
enum class StudyOf { body, model };

/// Reads the keys of [squeal] that select and configure the analyses.
squeal::StudyOptions read_study(const Table& squeal, StudyOf of);

/// Reads limit_cycle_direct of [squeal]; its speed is that of the transient unless it is given.
std::optional<squeal::DirectCase> read_direct(
    const Table& squeal, const std::optional<squeal::TransientCase>& transient);

/// Reads rotation_stability of [squeal]; Hill's method when it is missing.
squeal::RotationMethod read_rotation_method(const Table& squeal);

/// Reads critical of [squeal].
std::vector<squeal::CriticalCase> read_critical(const Table& squeal, StudyOf of);

/// Reads map of [squeal].
std::optional<squeal::MapCase> read_map(const Table& squeal, StudyOf of);

/// Reads stability of [squeal], which covers the speeds of the study unless it says otherwise.
std::optional<squeal::StabilityCase> read_stability(const Table& squeal,
                                                    const squeal::SpeedRange& speeds, StudyOf of);

}  // namespace chladni::scene
