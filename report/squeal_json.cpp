#include "report/describe_squeal.hpp"

#include <algorithm>
#include <complex>
#include <numbers>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "report/json.hpp"
#include "squeal/results/result_fields.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::report {

namespace {

/// "pad_velocity_m_s" of the name and the unit of a field.
std::string key_of(const std::string& name, std::string unit)
{
  if (unit.empty() || unit == "1" || unit == "own") return name;
  std::ranges::replace(unit, '/', '_');
  return name + '_' + unit;
}

/// All that a file stores of a struct; null what is absent or empty, and 0 or 1 what is so or not.
template <class T>
Json stored_json(const T& x)
{
  if constexpr (files::Stored<T>) {
    std::vector<Json::Member> members;
    files::for_each_field<T>([&](const auto& field) {
      members.emplace_back(*field.key ? field.key : key_of(field.name, field.unit),
                           stored_json(x.*field.member));
    });
    return Json::object(members);
  } else if constexpr (std::is_same_v<T, std::optional<double>>) {
    return optional_json(x);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return x.empty() ? Json() : Json(x);
  } else if constexpr (std::is_arithmetic_v<T>) {
    return double(x);
  } else {
    std::vector<Json> elements;
    for (const auto& element : x) elements.push_back(stored_json(element));
    return Json::array(elements);
  }
}

Json eigenvalues_json(const squeal::EigenvalueMap& map)
{
  std::vector<Json> speeds;
  for (Eigen::Index i = 0; i < map.speeds.size(); ++i) {
    std::vector<Json> lambda;
    for (const std::complex<double>& value : map.lambda.row(i))
      lambda.push_back(Json::array({value.real(), value.imag()}));
    std::vector<Json::Member> at{{"speed_rad_s", map.speeds[i]}, {"lambda", Json::array(lambda)}};
    if (map.angles.size() > 0)
      at.emplace_back("angle_deg", map.angles[i] * 180.0 / std::numbers::pi);
    speeds.push_back(Json::object(at));
  }
  return Json::array(speeds);
}

Json growth_json(const std::vector<squeal::Growth>& growths)
{
  std::vector<Json> speeds;
  for (const squeal::Growth& growth : growths) {
    speeds.push_back(
        Json::object({{"speed_rad_s", growth.speed},
                      {"growth_1_s", squeal::told_rate(growth)},
                      {"measured_growth_1_s", growth.rate},
                      {"eigenvalue_growth_1_s",
                       growth.eigenvalue_rate ? Json(*growth.eigenvalue_rate) : Json()}}));
  }
  return Json::array(speeds);
}

Json limit_cycle_json(const squeal::LimitCycle& cycle)
{
  return Json::object({{"speed_rad_s", cycle.speed},
                       {"frequency_Hz", cycle.frequency_Hz},
                       {"pad_velocity_m_s", cycle.pad_velocity},
                       {"pad_displacement_m", cycle.pad_displacement},
                       {"drift", cycle.drift},
                       {"settled", cycle.settled ? 1 : 0}});
}

Json direct_json(const squeal::DirectLimitCycle& cycle)
{
  const squeal::CycleStability stability = squeal::stability_of(cycle);
  std::vector<Json> multipliers;
  for (const std::complex<double>& value : cycle.multipliers)
    multipliers.push_back(Json::array({value.real(), value.imag()}));
  return Json::object({{"speed_rad_s", cycle.speed},
                       {"frequency_Hz", cycle.frequency_Hz},
                       {"pad_velocity_m_s", cycle.pad_velocity},
                       {"pad_displacement_m", cycle.pad_displacement},
                       {"friction_work_J", cycle.energy.friction.sum()},
                       {"normal_work_J", cycle.energy.normal.sum()},
                       {"damping_work_J", cycle.energy.damping},
                       {"frequency_errors_Hz", stored_json(cycle.errors.frequency_Hz)},
                       {"pad_velocity_errors_m_s", stored_json(cycle.errors.pad_velocity)},
                       {"pad_displacement_errors_m", stored_json(cycle.errors.pad_displacement)},
                       {"stable", stability == squeal::CycleStability::stable ? 1 : 0},
                       {"stability", squeal::name_of(stability)},
                       {"multipliers", Json::array(multipliers)},
                       {"multiplier_error", optional_json(cycle.multiplier_error)},
                       {"n_contact_evaluations", double(cycle.n_contact_evaluations)},
                       {"way", cycle.way.empty() ? Json() : Json(cycle.way)}});
}

Json branch_point_json(const squeal::BranchPoint& point)
{
  return Json::object({{"speed_rad_s", point.speed},
                       {"frequency_Hz", point.frequency_Hz},
                       {"pad_velocity_m_s", point.pad_velocity},
                       {"pad_displacement_m", point.pad_displacement},
                       {"largest_multiplier", point.largest_multiplier},
                       {"multiplier_error", optional_json(point.multiplier_error)},
                       {"stability", squeal::name_of(squeal::stability_of(point))}});
}

Json branch_json(const squeal::LimitCycleBranch& branch)
{
  std::vector<Json> points;
  for (const squeal::BranchPoint& point : branch.points) points.push_back(branch_point_json(point));
  return Json::array(points);
}

/// The index of its first point, from 0.
Json second_part_json(const squeal::LimitCycleBranch& branch)
{
  return branch.second_part ? Json(static_cast<int>(*branch.second_part)) : Json();
}

/// Where the branch begins, and where it goes on.
Json origin_json(const squeal::LimitCycleBranch& branch)
{
  const auto& origin = branch.origin;
  return Json::object({{"hopf_speed_rad_s", origin ? Json(origin->speed) : Json()},
                       {"hopf_frequency_Hz", origin ? Json(origin->frequency_Hz) : Json()},
                       {"first", origin ? branch_point_json(origin->first) : Json()},
                       {"note", branch.note.empty() ? Json() : Json(branch.note)},
                       {"second_part_from", second_part_json(branch)}});
}

/// Something of two points, as a pair.
Json pair_json(const squeal::StabilityPoint& from, const squeal::StabilityPoint& to,
               double squeal::StabilityPoint::*of)
{
  return Json::array({from.*of, to.*of});
}

/// Stability over a parameter whose key ends in `values`: "speeds_rad_s", "values".
std::vector<Json::Member> stability_json(const squeal::StabilityProfile& profile,
                                         const std::string& values)
{
  using squeal::StabilityPoint;
  std::vector<Json> unstable, growth, frequency_Hz, largest;
  for (const squeal::UnstableInterval& interval : profile.unstable) {
    unstable.push_back(pair_json(interval.from, interval.to, &StabilityPoint::value));
    growth.push_back(pair_json(interval.from, interval.to, &StabilityPoint::growth));
    frequency_Hz.push_back(pair_json(interval.from, interval.to, &StabilityPoint::frequency_Hz));
    largest.push_back(interval.worst.growth);
  }
  return {{"stability", squeal::name_of(squeal::stability_of(profile))},
          {"unstable_" + values, Json::array(unstable)},
          {"unstable_growth_1_s", Json::array(growth)},
          {"unstable_frequency_Hz", Json::array(frequency_Hz)},
          {"unstable_largest_growth_1_s", Json::array(largest)},
          {"searched_" + values, pair_json(profile.from, profile.to, &StabilityPoint::value)},
          {"searched_growth_1_s", pair_json(profile.from, profile.to, &StabilityPoint::growth)},
          {"searched_frequency_Hz",
           pair_json(profile.from, profile.to, &StabilityPoint::frequency_Hz)}};
}

Json critical_values_json(const std::vector<squeal::CriticalValue>& values)
{
  std::vector<Json> searches;
  for (const squeal::CriticalValue& value : values) {
    std::vector<Json::Member> members = {
        {"parameter", value.parameter},
        {"speed_rad_s", value.speed},
        {"value", value.value ? Json(*value.value) : Json()},
        {"frequency_Hz", value.value ? Json(value.frequency_Hz) : Json()}};
    if (value.profile)
      for (Json::Member& member : stability_json(*value.profile, "values"))
        members.push_back(std::move(member));
    searches.push_back(Json::object(members));
  }
  return Json::array(searches);
}

Json rotation_json(const squeal::RotationStability& stability)
{
  std::vector<Json> growth;
  for (Eigen::Index i = 0; i < stability.speeds.size(); ++i) {
    std::vector<Json> lambda;
    for (Eigen::Index j = 0; j < stability.exponents.cols(); ++j) {
      const std::complex<double> value = stability.exponents(i, j);
      lambda.push_back(Json::array({value.real(), value.imag()}));
    }
    const bool frozen = stability.frozen_growth.size() > 0;
    growth.push_back(
        Json::object({{"speed_rad_s", stability.speeds[i]},
                      {"growth_1_s", stability.growth[i]},
                      {"frozen_growth_1_s", frozen ? Json(stability.frozen_growth[i]) : Json()},
                      {"exponents", Json::array(lambda)}}));
  }
  const bool hill = stability.method == "hill";
  return Json::object({{"critical_speed_rad_s", optional_json(stability.critical_speed)},
                       {"method", stability.method.empty() ? "floquet" : stability.method},
                       {"harmonics", hill ? Json(double(stability.harmonics)) : Json()},
                       {"error_1_s", hill ? Json(stability.error) : Json()},
                       {"stability", squeal::name_of(squeal::stability_of(stability))},
                       {"growth", Json::array(growth)}});
}

Json peaks_json(const squeal::Spectrum& spectrum)
{
  std::vector<Json> peaks;
  for (const squeal::Spectrum::Peak& peak : spectrum.peaks) {
    peaks.push_back(
        Json::object({{"frequency_Hz", peak.frequency_Hz}, {"pad_velocity_m_s", peak.amplitude}}));
  }
  return Json::array(peaks);
}

}  // namespace

std::vector<Json::Member> results_json(const squeal::SquealResults& results)
{
  std::vector<Json::Member> members{
      {"missing", Json::array({results.missing.begin(), results.missing.end()})},
      {"failure", results.failure ? Json(*results.failure) : Json()}};
  if (results.eigenvalues)
    members.emplace_back("eigenvalues", eigenvalues_json(*results.eigenvalues));
  if (results.frozen_eigenvalues) {
    members.emplace_back("eigenvalues_of", results.eigenvalues->of);
    members.emplace_back("frozen_eigenvalues", eigenvalues_json(*results.frozen_eigenvalues));
  }
  if (results.searched_critical_speed) {
    const auto& critical = results.critical_speed;
    members.emplace_back("critical_speed_rad_s", critical ? Json(critical->speed) : Json());
    members.emplace_back("critical_frequency_Hz", critical ? Json(critical->frequency_Hz) : Json());
    if (critical && !critical->budget.is_empty())
      members.emplace_back("critical_speed_errors_rad_s", budget_json(critical->budget));
    if (results.speed_stability)
      for (Json::Member& member : stability_json(*results.speed_stability, "speeds_rad_s"))
        members.push_back(std::move(member));
    if (results.speed_stability && !results.speed_stability->method.empty())
      members.emplace_back("critical_speed_method", results.speed_stability->method);
  }
  if (results.stability_table)
    members.emplace_back("stability_table", stability_table_json(*results.stability_table));
  if (results.rotation_stability)
    members.emplace_back("rotation_stability", rotation_json(*results.rotation_stability));
  if (!results.critical_values.empty())
    members.emplace_back("critical_values", critical_values_json(results.critical_values));
  if (results.spectrum) members.emplace_back("spectrum_peaks", peaks_json(*results.spectrum));
  if (results.mode_sensitivity)
    members.emplace_back("mode_sensitivity", stored_json(*results.mode_sensitivity));
  if (results.gradients) members.emplace_back("gradients", gradients_json(*results.gradients));
  if (!results.growth.empty()) members.emplace_back("growth", growth_json(results.growth));
  if (results.transient) {
    const auto& rate = results.transient->growth_rate;
    members.emplace_back("transient_growth_1_s", rate ? Json(*rate) : Json());
    members.emplace_back("integrator", results.transient->integrator);
    const std::string& warning = results.transient->warning;
    members.emplace_back("transient_warning", warning.empty() ? Json() : Json(warning));
  }
  if (results.motion_statistics)
    members.emplace_back("motion_statistics", stored_json(*results.motion_statistics));
  if (results.limit_cycle)
    members.emplace_back("limit_cycle", limit_cycle_json(*results.limit_cycle));
  if (results.limit_cycle_direct)
    members.emplace_back("limit_cycle_direct", direct_json(*results.limit_cycle_direct));
  if (results.limit_cycle_branch) {
    members.emplace_back("limit_cycle_branch", branch_json(*results.limit_cycle_branch));
    members.emplace_back("limit_cycle_branch_origin", origin_json(*results.limit_cycle_branch));
  }
  return members;
}

}  // namespace chladni::report
