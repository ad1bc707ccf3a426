#pragma once

#include <Eigen/Core>
#include <span>

#include "pencils.hpp"

/// The bricks of which pencils are built.
namespace chladni::strangers {

/// Adds a dense matrix at some rows and columns; rows -1 are held and left out.
void add(std::vector<Entry>& A, std::span<const int> dofs, const Eigen::MatrixXd& block);
/// Adds k (u_i - u_j)^2 / 2.
void add_spring(std::vector<Entry>& K, int i, int j, double k);
/// Adds to the diagonal.
void add_diagonal(std::vector<Entry>& A, int i, double value);
/// Adds the same value to all of the diagonal.
void add_identity(std::vector<Entry>& A, int n, double value = 1.0);
/// Every value times a factor.
void scale(std::vector<Entry>& A, double factor);

/// Stiffness and mass of one element.
struct ElementMatrices {
  Eigen::MatrixXd K, M;
};

/// Rod along the line between its ends, as a beam of Bernoulli and Euler in space; 12 DOFs, x y z
/// rx ry rz of both ends. Masses are consistent.
struct FrameSection {
  double young, shear, density, area, inertia_y, inertia_z, torsion;
};
ElementMatrices frame_element(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const FrameSection& section);
/// Deflection and slope of a beam at both ends; 4 DOFs.
ElementMatrices beam_element(double length, double bending_stiffness, double mass_per_length);
/// Eight nodes, three displacements each; E, nu, rho.
struct Solid {
  double young, poisson, density;
};
ElementMatrices hexahedron(const Eigen::Vector3d& edges, const Solid& solid);

}  // namespace chladni::strangers
