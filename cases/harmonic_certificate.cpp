#include "cases/harmonic_certificate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::VectorXd;

/// The counts of all harmonics as one. Where no harmonic misses a mode, all together have as many
/// as the model has below the lowest of their limits.
/// @param lambda  of the model, all of a part
mbs_export::ModeCount whole_count(
    const std::vector<HarmonicPart>& parts, reduce::EigenvalueCount reduce::Certificate::*which,
    const std::function<std::vector<double>(const HarmonicPart&)>& lambda)
{
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  mbs_export::ModeCount sum;
  for (const HarmonicPart& part : parts) {
    const reduce::EigenvalueCount& count = part.certificate.*which;
    if (!(count.sigma > 0.0)) return {};
    least = std::min(least, count.sigma);
    largest = std::max(largest, count.sigma);
    sum.expected += count.expected;
    sum.found += count.found;
  }
  sum.up_to = std::sqrt(largest);
  if (sum.missing() > 0) return sum;
  sum = {.up_to = std::sqrt(least), .expected = 0, .found = 0};
  for (const HarmonicPart& part : parts) {
    const double sigma = (part.certificate.*which).sigma;
    const auto is_above = [&](double value) { return value >= least && value < sigma; };
    sum.found += (part.certificate.*which).found -
                 static_cast<int>(std::ranges::count_if(lambda(part), is_above));
  }
  sum.expected = sum.found;
  return sum;
}

/// Up to which eigenvalue no harmonic misses one; 0 where one was not counted.
double complete_up_to(const std::vector<HarmonicPart>& parts)
{
  double least = std::numeric_limits<double>::infinity();
  for (const HarmonicPart& part : parts) {
    const reduce::EigenvalueCount& complete = part.certificate.complete;
    least = std::min(least, complete.expected == complete.found ? complete.sigma : 0.0);
  }
  return least;
}

}  // namespace

void add_responses(mbs_export::Certificate& whole, const std::vector<HarmonicPart>& parts,
                   const std::vector<std::string>& loads)
{
  mbs_export::ResponseCheck check{.up_to = 0.0, .error = 0.0, .loads = loads};
  for (const HarmonicPart& part : parts) {
    const reduce::ResponseCertificate& responses = part.certificate.responses;
    if (!(responses.Omega > 0.0)) continue;
    check.up_to = responses.Omega;
    check.error = std::max(check.error, responses.error);
  }
  if (check.up_to > 0.0) whole.responses = check;
}

mbs_export::Certificate whole_certificate(const std::vector<HarmonicPart>& parts,
                                          const std::vector<std::string>& fixed, double lambda_max)
{
  struct Entry {
    double lambda, eta2, estimate, rounding, bound;
  };
  std::vector<Entry> entries;
  mbs_export::Certificate whole;
  whole.fixed = fixed;
  bool has_errors = true;
  for (const HarmonicPart& part : parts) {
    const reduce::Certificate& c = part.certificate;
    whole.n_rigid += c.n_zero;
    whole.rigid_residual = std::max(whole.rigid_residual, c.zero_energy);
    whole.condition = std::max(whole.condition, c.condition);
    has_errors = has_errors && c.eta2.size() == c.lambda.size();
    for (std::size_t i = 0; has_errors && i < c.lambda.size(); ++i) {
      if (c.lambda[i] > lambda_max) continue;
      entries.push_back({c.lambda[i], c.eta2[i], c.estimates[i],
                         i < c.rounding.size() ? c.rounding[i] : 0.0,
                         i < c.bounds.size() ? c.bounds[i] : -1.0});
    }
  }
  if (!has_errors) entries.clear();  // MacNeal's
  std::ranges::stable_sort(entries, {}, &Entry::lambda);
  const auto column = [&](double Entry::*member, std::size_t n) {
    VectorXd values(static_cast<Index>(n));
    for (std::size_t i = 0; i < n; ++i) values[static_cast<Index>(i)] = entries[i].*member;
    return values;
  };
  const double complete = complete_up_to(parts);
  std::vector<double> lower;
  for (const Entry& e : entries) {
    if (e.bound < 0.0 || e.lambda > complete) break;
    lower.push_back(e.lambda / (1.0 + e.bound));
  }
  std::ranges::sort(lower);
  for (std::size_t i = 0; i < lower.size(); ++i)
    entries[i].bound = std::max(0.0, entries[i].lambda / lower[i] - 1.0);
  whole.frequencies = column(&Entry::lambda, entries.size()).cwiseSqrt();
  whole.eta2 = column(&Entry::eta2, entries.size());
  whole.estimates = column(&Entry::estimate, entries.size());
  whole.rounding = column(&Entry::rounding, entries.size());
  whole.bounds = column(&Entry::bound, lower.size());
  const auto of_model = [](const HarmonicPart& part) { return part.certificate.lambda; };
  const auto of_modes = [](const HarmonicPart& part) {
    const VectorXd lambda = part.omega.cwiseAbs2();
    return std::vector<double>(lambda.begin(), lambda.end());
  };
  whole.fixed_interface = whole_count(parts, &reduce::Certificate::fixed_interface, of_modes);
  whole.range = whole_count(parts, &reduce::Certificate::range, of_model);
  whole.complete = whole_count(parts, &reduce::Certificate::complete, of_model);
  return whole;
}

}  // namespace chladni::cases
