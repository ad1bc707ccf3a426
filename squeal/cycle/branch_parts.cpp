#include "squeal/cycle/branch_parts.hpp"

#include <algorithm>
#include <cmath>

namespace chladni::squeal {
namespace {

/// Relative difference below which two cycles at one speed are the same: each is found to 1e-6, and
/// so are its multipliers, which magnify that near 1.
constexpr double same_cycle = 1e-4;

bool is_same(const BranchPoint& a, const BranchPoint& b)
{
  const auto near = [](double x, double y) { return std::abs(x - y) <= same_cycle * std::abs(y); };
  return a.speed == b.speed && near(a.frequency_Hz, b.frequency_Hz) &&
         near(a.pad_velocity, b.pad_velocity) && near(a.pad_displacement, b.pad_displacement);
}

bool share_a_cycle(const LimitCycleBranch& a, const LimitCycleBranch& b)
{
  return std::ranges::any_of(a.points, [&b](const BranchPoint& x) {
    return std::ranges::any_of(b.points, [&x](const BranchPoint& y) { return is_same(x, y); });
  });
}

}  // namespace

void append(LimitCycleBranch& branch, const LimitCycleBranch& part)
{
  branch.points.insert(branch.points.end(), part.points.begin(), part.points.end());
  branch.folds.insert(branch.folds.end(), part.folds.begin(), part.folds.end());
  if (part.lost_below) branch.lost_below = part.lost_below;
  if (part.lost_above) branch.lost_above = part.lost_above;
}

LimitCycleBranch joined(LimitCycleBranch first, LimitCycleBranch second, const std::string& note)
{
  if (first.points.empty() || !share_a_cycle(first, second)) {
    if (!first.points.empty() && !second.points.empty()) first.second_part = first.points.size();
    append(first, second);
    first.note = note;
    return first;
  }
  if (second.points.size() <= first.points.size()) return first;
  const bool ends_small =
      second.points.back().pad_displacement < second.points.front().pad_displacement;
  if (first.origin && ends_small) {  // at its origin
    std::ranges::reverse(second.points);
    std::ranges::reverse(second.folds);
  }
  second.origin = first.origin;
  return second;
}

}  // namespace chladni::squeal
