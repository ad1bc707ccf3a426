#pragma once

#include <string>
#include <vector>

/// Symmetric pencils (K, M) that no part of this project was written for, as plain lists of
/// numbers.
namespace chladni::strangers {

/// One value of a matrix; values of the same place add up.
struct Entry {
  int row, column;
  double value;
};

/// A symmetric pencil and the masters to which it is reduced.
struct Pencil {
  std::string name;        ///< of letters and digits, as a test wants it
  int n = 0;               ///< rows
  int n_rigid = 0;         ///< dimension of the nullspace of K
  std::vector<Entry> K{};  ///< both triangles
  std::vector<Entry> M{};
  std::vector<int> masters{};
  std::vector<int> held{};  ///< of the masters
  /// A method must refuse it; a word of the message that says why, or several divided
  /// by |. Empty: every method must
  /// succeed.
  std::string refusal{};
};

/// Frames, beams, solids, blades, chains: what other programs assemble.
std::vector<Pencil> mechanical_pencils();
/// Graphs, diagonals, clusters, classical matrices.
std::vector<Pencil> algebraic_pencils();
/// Pencils that have no reduction, or none on these masters.
std::vector<Pencil> refused_pencils();
/// All of them; no name stands twice.
std::vector<Pencil> all_pencils();

}  // namespace chladni::strangers
