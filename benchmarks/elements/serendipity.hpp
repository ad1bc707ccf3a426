#pragma once

#include "plate/elements/shell_element.hpp"

/// The mainstream to compare with: quadratic serendipity shells with uniform reduced integration.
namespace chladni::benchmarks {

/// Lattice places of the nodes of these elements in blocks of order 2.
std::vector<int> serendipity_places(mesh::Shape shape);

/// K and M of the 8-node quadrilateral at 2 x 2 points (S8R of Abaqus without its stabilisation) or
/// of the 6-node triangle at 3 points; displacement-based, mass consistent, no drilling stiffness.
/// @param nodes  of the element in lattice order, those without function left out
plate::ElementMatrices serendipity_matrices(mesh::Shape shape, const plate::ShellNodes& nodes,
                                            const plate::Material& material);

}  // namespace chladni::benchmarks
