#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/hdf5.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// The parts of an ErrorBudget and their names in files.
inline constexpr std::array<std::pair<const char*, std::optional<double> ErrorBudget::*>, 5>
    budget_parts{{{"mesh", &ErrorBudget::mesh},
                  {"reduction", &ErrorBudget::reduction},
                  {"body", &ErrorBudget::body},
                  {"modes_left_out", &ErrorBudget::left_out},
                  {"integration", &ErrorBudget::integration}}};

/// Writes the datasets `stability`, `range/...` and `unstable/...` of a group; see
/// docs/reference/file_formats.md.
/// @param unit  unit of the parameter
void write_profile(files::Writer& file, const std::string& group, const StabilityProfile& profile,
                   const std::string& unit);

/// Reads the datasets of write_profile; absent when the group has none, as in files of earlier
/// versions.
std::optional<StabilityProfile> read_profile(const files::Reader& file, const std::string& group);

/// Writes points as the datasets `values`, `growth` and `frequency` of a group.
/// @param unit  unit of the parameter
void write_points(files::Writer& file, const std::string& group,
                  const std::vector<StabilityPoint>& points, const std::string& unit);
/// Reads the points of a group.
/// @param n  required number of points
std::vector<StabilityPoint> read_points(const files::Reader& file, const std::string& group,
                                        Eigen::Index n);

/// Writes intervals as the points `from`, `to` and `worst` of a group, which is omitted when there
/// are none.
/// @param unit  unit of the parameter
void write_intervals(files::Writer& file, const std::string& group,
                     const std::vector<UnstableInterval>& intervals, const std::string& unit);
/// Reads the intervals of a group; empty when the group is missing.
std::vector<UnstableInterval> read_intervals(const files::Reader& file, const std::string& group);

}  // namespace chladni::squeal
