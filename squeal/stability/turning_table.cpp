#include "squeal/stability/turning_table.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "squeal/parallel.hpp"
#include "squeal/stability/hill.hpp"
#include "squeal/stability/stability_map.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index;

/// Values that are looked at, at least.
constexpr int n_scanned = 32;

ExponentsAt exponents_over(const FlexibleDisc& brake, const StabilityCase& search)
{
  const auto sample = [](const Hill& hill, double value, double speed) {
    HillExponents motion = hill.exponents(speed);
    const Index n = motion.lambda.size();
    return ExponentSample{value, speed, std::move(motion), Eigen::VectorXd::Zero(n)};
  };
  if (search.over)
    return [&brake, sample, over = *search.over, speed = search.speed](double value) {
      return sample(Hill(brake.disc(), with_parameter(brake.options(), over, value)), value, speed);
    };
  return [sample, hill = Hill(brake.disc(), brake.options())](double speed) {
    return sample(hill, speed, speed);
  };
}

/// So many times as fine as the values that were asked for.
int refinement(int count)
{
  return count < 2 ? 1 : std::max(1, (n_scanned + count - 3) / (count - 1));
}

bool is_within(const std::vector<ExponentSample>& samples, Index j,
               const std::optional<FrequencyBand>& band)
{
  return !band || std::ranges::any_of(samples, [&](const ExponentSample& sample) {
    const double f_Hz = sample.frequency_Hz(j);
    return f_Hz >= band->from_Hz && f_Hz <= band->to_Hz;
  });
}

/// Motion j without its intervals.
StabilityBranch branch_of(const std::vector<ExponentSample>& samples, Index j, int finer)
{
  StabilityBranch branch{};
  branch.lambda.resize((std::ssize(samples) - 1) / finer + 1);
  for (Index i = 0; i < branch.lambda.size(); ++i)
    branch.lambda[i] = samples[static_cast<std::size_t>(finer * i)].motion.lambda[j];
  branch.worst = std::ranges::max_element(samples, {}, [j](const ExponentSample& sample) {
                   return sample.growth(j);
                 })->point(j);
  return branch;
}

/// The least stable motion at a value of the table.
StabilityPoint least_stable(const StabilityTable& table, Index i)
{
  const auto growth = [i](const StabilityBranch& branch) { return branch.lambda[i].real(); };
  const std::complex<double> lambda =
      std::ranges::max_element(table.branches, {}, growth)->lambda[i];
  return {table.values[i], lambda.real(), std::abs(lambda.imag()) / (2.0 * std::numbers::pi)};
}

}  // namespace

TurningMotions::TurningMotions(const FlexibleDisc& brake, const StabilityCase& search)
    : brake_(brake), search_(search)
{
  exponents_ = [this, exponents = exponents_over(brake, search)](double value) {
    ++n_exponents_;
    return exponents(value);
  };
  const int finer = refinement(search.count);
  samples_ = followed_exponents(
      exponents_,
      Eigen::VectorXd::LinSpaced(finer * (search.count - 1) + 1, search.from, search.to));
  branches_.resize(static_cast<std::size_t>(samples_.front().size()));
}

bool TurningMotions::are_of(const FlexibleDisc& brake, const StabilityCase& search) const
{
  return &brake == &brake_ && search.over == search_.over && search.from == search_.from &&
         search.to == search_.to && search.count == search_.count &&
         (!search.over || search.speed == search_.speed);
}

StabilityTable TurningMotions::table(const std::optional<FrequencyBand>& band)
{
  StabilityTable table{
      .parameter = search_.over ? key_of(*search_.over) : "speed",
      .speed = search_.over ? std::optional(search_.speed) : std::nullopt,
      .band = band,
      .values = Eigen::VectorXd::LinSpaced(search_.count, search_.from, search_.to),
      .families = {},
      .branches = {},
      .method = "hill"};
  for (const ExponentSample& sample : samples_)
    table.error = std::max(table.error, sample.motion.error);
  std::vector<Index> which;
  for (Index j = 0; j < samples_.front().size(); ++j)
    if (is_within(samples_, j, band)) which.push_back(j);
  for_each_index(static_cast<int>(which.size()), [&](int k) {
    const Index j = which[static_cast<std::size_t>(k)];
    std::optional<StabilityBranch>& branch = branches_[static_cast<std::size_t>(j)];
    if (branch) return;
    StabilityBranch found = branch_of(samples_, j, refinement(search_.count));
    found.unstable = unstable_intervals(exponents_, samples_, j);
    branch = std::move(found);
  });
  for (const Index j : which)
    table.branches.push_back(branches_[static_cast<std::size_t>(j)].value());
  std::ranges::stable_sort(table.branches, {},
                           [](const StabilityBranch& b) { return b.worst.frequency_Hz; });
  return table;
}

StabilityTable TurningTables::table(const FlexibleDisc& brake, const StabilityCase& search)
{
  const auto are = [&](const TurningMotions& motions) { return motions.are_of(brake, search); };
  const auto known = std::ranges::find_if(motions_, are);
  return (known != motions_.end() ? *known : motions_.emplace_back(brake, search))
      .table(search.band);
}

int TurningTables::n_exponents() const
{
  int n = 0;
  for (const TurningMotions& motions : motions_) n += motions.n_exponents();
  return n;
}

StabilityTable turning_table(const FlexibleDisc& brake, const StabilityCase& search)
{
  return TurningMotions(brake, search).table(search.band);
}

StabilityProfile profile_of(const StabilityTable& table)
{
  StabilityProfile profile{
      least_stable(table, 0), least_stable(table, table.values.size() - 1), {}, table.method};
  std::vector<UnstableInterval> all;
  for (const StabilityBranch& branch : table.branches)
    all.insert(all.end(), branch.unstable.begin(), branch.unstable.end());
  std::ranges::stable_sort(all, {}, [](const UnstableInterval& i) { return i.from.value; });
  for (const UnstableInterval& next : all) {
    if (profile.unstable.empty() || next.from.value > profile.unstable.back().to.value) {
      profile.unstable.push_back(next);
      continue;
    }
    UnstableInterval& joined = profile.unstable.back();
    if (next.to.value > joined.to.value) joined.to = next.to;
    if (next.worst.growth > joined.worst.growth) joined.worst = next.worst;
  }
  return profile;
}

}  // namespace chladni::squeal
