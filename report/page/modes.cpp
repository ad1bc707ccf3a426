#include "report/page/modes.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "report/describe.hpp"
#include "report/page/numbers.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

constexpr double two_pi = 2.0 * std::numbers::pi;

/// The place in the certificate of each mode of the body: the next one of the same frequency.
/// Interface modes turn the modes above them, which then are no modes of the certificate.
std::vector<std::optional<Index>> certified_places(const mbs_export::ModalBody& body,
                                                   const mbs_export::Certificate& certificate)
{
  std::vector<std::optional<Index>> places(static_cast<std::size_t>(body.n_modes()));
  if (certificate.fixed != body.fixed) return places;  // another support, other modes
  constexpr double same = 1e-6;
  Index next = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double omega = body.omega[static_cast<Index>(i)];
    const auto& omega_c = certificate.frequencies;
    if (body.kinds[i] == mbs_export::ModeKind::rigid) continue;
    while (next < omega_c.size() && omega_c[next] < omega * (1.0 - same)) ++next;
    if (next < omega_c.size() && omega_c[next] <= omega * (1.0 + same)) places[i] = next++;
  }
  return places;
}

Json path_json(const std::vector<mbs_export::SelectionStep>& steps)
{
  std::vector<Json> points;
  for (const mbs_export::SelectionStep& step : steps) {
    points.push_back(Json::object({{"added", step.added},
                                   {"size", step.size()},
                                   {"interface", step.n_interface},
                                   {"error", rounded(step.error)}}));
  }
  return Json::array(points);
}

Json count_json(const std::string& of, const mbs_export::ModeCount& count)
{
  return Json::object({{"of", of},
                       {"up_to_Hz", rounded(count.up_to / two_pi)},
                       {"expected", count.expected},
                       {"found", count.found}});
}

}  // namespace

Json modes_json(const mbs_export::ModalBody& body, const mbs_export::Certificate& certificate,
                const ModeLooks& looks)
{
  const auto places = certified_places(body, certificate);
  std::vector<Json> modes;
  for (Index i = 0; i < body.n_modes(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const int number = static_cast<int>(i) + 1;
    std::vector<Json::Member> mode{{"number", number},
                                   {"frequency_Hz", rounded(body.omega[i] / two_pi)},
                                   {"kind", name_of(body.kinds[k])}};
    if (const auto look = looks.find(number); look != looks.end())
      for (Json::Member& member : look_members(look->second)) mode.push_back(std::move(member));
    if (const auto place = places[k]) {
      mode.emplace_back("estimate", rounded(mbs_export::estimated_errors(certificate)[*place]));
      if (*place < certificate.bounds.size())
        mode.emplace_back("bound", rounded(certificate.bounds[*place] / 2.0));
    }
    modes.push_back(Json::object(mode));
  }
  return Json::array(modes);
}

Json counts_json(const mbs_export::Certificate& certificate)
{
  std::vector<Json> counts;
  if (certificate.fixed_interface.up_to > 0.0)
    counts.push_back(count_json("fixed-interface modes", certificate.fixed_interface));
  if (certificate.range.up_to > 0.0) counts.push_back(count_json("modes", certificate.range));
  if (certificate.complete.up_to > 0.0 && certificate.complete.up_to != certificate.range.up_to)
    counts.push_back(count_json("modes", certificate.complete));
  return counts.empty() ? Json() : Json::array(counts);
}

Json selection_json(const mbs_export::ModalBody& body)
{
  if (!body.selection) return Json();
  const mbs_export::SelectionTable& selection = *body.selection;
  return Json::object({{"tolerance", rounded(selection.error)},
                       {"up_to_Hz", rounded(selection.Omega_max / two_pi)},
                       {"loads", texts(selection.loads)},
                       {"chosen", body.n_modes()},
                       {"modes_only", path_json(selection.modes_only)},
                       {"with_interface_modes", path_json(selection.with_interface_modes)}});
}

}  // namespace chladni::report
