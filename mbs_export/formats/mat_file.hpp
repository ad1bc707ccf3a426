#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

/// Arrays as bytes of a MAT-file of version 5, in the byte order of this machine.
/// Source: MathWorks, MAT-File Format, "Level 5 MAT-File Format".
namespace chladni::mbs_export::formats {

/// An array of MATLAB without its name: the bytes for class and extents, and those after the name.
struct MatArray {
  std::string before_name, after_name;
};

/// A full matrix of doubles; a vector becomes a column.
MatArray mat_array(const Eigen::MatrixXd& x);
/// A row of characters.
/// @param text  UTF-8
MatArray mat_array(const std::string& text);
/// A column of cells that hold texts.
MatArray mat_array(const std::vector<std::string>& texts);

/// The fields of one element of an array of structs. Names have up to 31 letters, digits and _.
using MatFields = std::vector<std::pair<std::string, MatArray>>;
/// A row of structs that all have the same fields in the same order.
/// @param elements  if empty, the array is empty and has no fields
MatArray mat_array(const std::vector<MatFields>& elements);

/// The bytes of a file with one variable.
/// @param description  up to 116 characters, shown by `type FILE`
/// @throws chladni::Error when the variable is too large for the format, 2 GiB.
std::string mat_file(const std::string& description, const std::string& name, const MatArray& x);

}  // namespace chladni::mbs_export::formats
