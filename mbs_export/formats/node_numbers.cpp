#include "mbs_export/formats/node_numbers.hpp"

#include <fmt/format.h>

#include <set>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {

std::vector<int> unique_node_numbers(const std::vector<AttachmentNode>& nodes, int largest)
{
  if (nodes.size() > static_cast<std::size_t>(largest)) {
    throw Error(fmt::format("this format has numbers for {} nodes, and the body has {}", largest,
                            nodes.size()));
  }
  std::vector<int> numbers;
  std::set<std::int64_t> taken;
  for (const AttachmentNode& node : nodes) {
    const bool own = node.number >= 1 && node.number <= largest && taken.insert(node.number).second;
    numbers.push_back(own ? static_cast<int>(node.number) : 0);
  }
  int next = 1;
  for (int& number : numbers) {
    if (number != 0) continue;
    while (!taken.insert(next).second) ++next;
    number = next;
  }
  return numbers;
}

}  // namespace chladni::mbs_export::formats
