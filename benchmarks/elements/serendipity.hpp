#pragma once

#include "plate/elements/shell_element.hpp"

/// Quadratic serendipity shells with uniform reduced integration, the usual element of commercial
/// programs, as a comparison.
namespace chladni::benchmarks {

/// The nodes that these elements use, as places in the lattice of an element of order 2.
std::vector<int> serendipity_places(mesh::Shape shape);

/// Element matrices K and M of the 8-node quadrilateral with 2 x 2 integration points (Abaqus S8R
/// without its stabilisation) or of the 6-node triangle with 3 points: displacement formulation,
/// consistent mass, no drilling stiffness.
/// @param nodes  nodes of the element in lattice order, without those that the element does not use
plate::ElementMatrices serendipity_matrices(mesh::Shape shape, const plate::ShellNodes& nodes,
                                            const plate::Material& material);

}  // namespace chladni::benchmarks
