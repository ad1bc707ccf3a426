#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr std::string_view response_components = "x | y | z | rx | ry | rz";
constexpr Admissible response_place{.unit = "m"};
constexpr Admissible node_number{.at_least = 0, .at_most = 2147483647};
constexpr Admissible response_frequency{.at_least = 0.0, .unit = "Hz"};

constexpr Key response_rows[] = {
    {"response", table, "not asked for", "[`chladni response`](../how-to/response.md)"},
    {"response.of",
     word,
     "body",
     "what responds: the modal body, the reduced system or the FE model",
     {},
     "body | reduced | fe"},
    {"response.quantity",
     word,
     "receptance",
     "displacement, velocity or acceleration for each unit of load",
     {},
     "receptance | mobility | accelerance"},
    {"response.loads", tables, "required", "unit loads, one for each of `dofs`"},
    {"response.loads.at", text, "required",
     "interface node, whose nodes share the unit equally; of the FE model any group, ring or "
     "coupling"},
    {"response.loads.dofs", texts, "required", "loaded components", {}, response_components},
    {"response.loads.near", numbers, "all nodes", "the nearest node alone, [x, y, z]",
     response_place},
    {"response.loads.measured_node", integer, "the nearest measured node",
     "number of the node in a measurement (`chladni response --measured`)", node_number},
    {"response.outputs", tables, "required", "motions, of each node and each of `dofs`"},
    {"response.outputs.at", text, "required", "as of loads"},
    {"response.outputs.dofs", texts, "required", "components", {}, response_components},
    {"response.outputs.near", numbers, "all nodes", "the nearest node alone, [x, y, z]",
     response_place},
    {"response.outputs.measured_node", integer, "the nearest measured node",
     "number of the node in a measurement (`chladni response --measured`)", node_number},
    {"response.from_Hz", number, "required", "first frequency; above 0 for logarithmic spacing",
     response_frequency},
    {"response.to_Hz", number, "required", "last frequency, above the first", response_frequency},
    {"response.count",
     integer,
     "required",
     "frequencies, both ends among them",
     {.at_least = 2, .at_most = 1000000}},
    {"response.spacing", word, "linear", "of the frequencies", {}, "linear | logarithmic"},
    {"response.loss_factor",
     number,
     "0",
     "eta of a stiffness K (1 + i eta), besides `body.damping`",
     {.at_least = 0.0, .below = 1.0}},
    {"response.section_forces", texts, "none",
     "groups of `reduce.resultants` whose section forces respond; not of the FE model"},
};

}  // namespace

std::span<const Key> response_keys()
{
  return response_rows;
}

}  // namespace chladni::scene
