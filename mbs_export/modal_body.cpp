#include "mbs_export/modal_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::mbs_export {

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
