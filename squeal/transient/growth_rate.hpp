#pragma once

#include <optional>
#include <string>

#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Growth rate: slope of the least-squares line through ln(pad velocity) over the second half of
/// the linear phase, which ends when the pad displacement first exceeds `linear_limit` (m). The
/// first half is left out because decaying modes are still present. Absent for fewer than eight
/// points.
/// @return 1/s
std::optional<double> growth_rate(const Envelope& envelope, double linear_limit);

/// The growth rate to report, 1/s: that of the eigenvalue if known, else the measured one. A short
/// transient may show other motions than the least stable one.
double told_rate(const Growth& growth);

/// Whether a growth rate measured in a transient belongs to another motion than the least stable
/// one: it differs from that of the eigenvalue by more than a tenth and by more than 0.01 1/s.
bool disagree(double measured, double of_eigenvalue);

/// A warning about a transient with such a growth rate; empty when the rates agree.
std::string warning_of_growth(double measured, double of_eigenvalue);

}  // namespace chladni::squeal
