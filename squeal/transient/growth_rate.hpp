#pragma once

#include <optional>
#include <string>

#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Slope of the least-squares line through ln(pad velocity) over the second half of the linear
/// phase, which ends when the pad displacement first exceeds `linear_limit` (m). The first half is
/// left to the modes that die out. Absent with less than eight points.
std::optional<double> growth_rate(const Envelope& envelope, double linear_limit);

/// What is told as the growth at a speed: the eigenvalue's where there is one, else the measured
/// one. A short run may show other motions than the least stable one. In 1/s.
double told_rate(const Growth& growth);

/// Whether a growth rate that was measured in a transient belongs to another motion than the least
/// stable one: it differs from the growth of the eigenvalue by more than a tenth of it, and by more
/// than 0.01 1/s.
bool disagree(double measured, double of_eigenvalue);

/// What to say of a transient with such a growth rate; empty when the two agree.
std::string warning_of_growth(double measured, double of_eigenvalue);

}  // namespace chladni::squeal
