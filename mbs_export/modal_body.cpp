#include "mbs_export/modal_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::mbs_export {

Eigen::VectorXd loss_factors(const ModalBody& body)
{
  if (body.H.size() == 0) return {};
  Eigen::VectorXd eta = Eigen::VectorXd::Zero(body.n_modes());
  for (Eigen::Index i = 0; i < eta.size(); ++i)
    if (body.omega[i] > 0.0) eta[i] = body.H(i, i) / (body.omega[i] * body.omega[i]);
  return eta;
}

const ContactRing& find_ring(const ModalBody& body, const std::string& name)
{
  const auto found = std::ranges::find(body.rings, name, &ContactRing::name);
  if (found != body.rings.end()) return *found;
  std::vector<std::string> names;
  for (const ContactRing& ring : body.rings) names.push_back("'" + ring.name + "'");
  throw Error(fmt::format(
      "no contact ring '{}'; there is {} (a ring is an attachment set of three or more nodes at "
      "equal angles on one circle about the z axis, with all six components)",
      name, names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace chladni::mbs_export
