#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr std::string_view response_components = "x | y | z | rx | ry | rz";
constexpr Admissible node_number = from_to(0, 2147483647);

constexpr Key response_rows[] = {
    {"response", table, "not asked for", "[`chladni response`](../how-to/response.md)"},
    {"response.of", word, "body",
     "what responds: the modal body, the reduced system or the FE model", no_number,
     "body | reduced | fe"},
    {"response.quantity", word, "receptance",
     "displacement, velocity or acceleration for each unit of load", no_number,
     "receptance | mobility | accelerance"},
    {"response.loads", tables, "required", "unit loads, one for each of `dofs`"},
    {"response.loads.at", text, "required",
     "interface node, whose nodes share the unit equally; of the FE model any group, ring or "
     "coupling"},
    {"response.loads.dofs", texts, "required", "loaded components", no_number, response_components},
    {"response.loads.near", numbers, "all nodes", "the nearest node alone, [x, y, z]", in("m")},
    {"response.loads.measured_node", integer, "the nearest measured node",
     "number of the node in a measurement (`chladni response --measured`)", node_number},
    {"response.outputs", tables, "required", "motions, of each node and each of `dofs`"},
    {"response.outputs.at", text, "required", "as of loads"},
    {"response.outputs.dofs", texts, "required", "components", no_number, response_components},
    {"response.outputs.near", numbers, "all nodes", "the nearest node alone, [x, y, z]", in("m")},
    {"response.outputs.measured_node", integer, "the nearest measured node",
     "number of the node in a measurement (`chladni response --measured`)", node_number},
    {"response.from_Hz", number, "required", "first frequency; above 0 for logarithmic spacing",
     not_negative("Hz")},
    {"response.to_Hz", number, "required", "last frequency, above the first", not_negative("Hz")},
    {"response.count", integer, "required", "frequencies, both ends among them",
     from_to(2, 1000000)},
    {"response.spacing", word, "linear", "of the frequencies", no_number, "linear | logarithmic"},
    {"response.loss_factor",
     number,
     "0",
     "eta of a stiffness K (1 + i eta), besides `body.damping`",
     {.at_least = 0.0, .below = 1.0}},
    {"response.section_forces", texts, "none",
     "groups of `reduce.resultants` whose section forces, of solids stresses, respond; not of the "
     "FE model"},
};

}  // namespace

std::span<const Key> response_keys()
{
  return response_rows;
}

}  // namespace chladni::scene
