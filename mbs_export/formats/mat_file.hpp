#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

/// Arrays as bytes of a MAT-file of version 5.
/// Source: MathWorks, MAT-File Format, "Level 5 MAT-File Format"; numbers in the order of this
/// machine.
namespace chladni::mbs_export::formats {

/// An array of MATLAB that has no name yet: its class, extents and what follows the name.
struct MatArray {
  std::string before_name, after_name;
};

/// A full matrix of doubles; a vector is a column.
MatArray mat_array(const Eigen::MatrixXd& x);
/// A row of characters.
/// @param text  UTF-8
MatArray mat_array(const std::string& text);
/// A column of cells with texts.
MatArray mat_array(const std::vector<std::string>& texts);

/// The fields of one element of an array of structs; names of up to 31 letters, digits and _.
using MatFields = std::vector<std::pair<std::string, MatArray>>;
/// A row of structs, all with the same fields in the same order.
/// @param elements  none make an empty array without fields
MatArray mat_array(const std::vector<MatFields>& elements);

/// A file with one variable.
/// @param description  up to 116 characters, which `type FILE` shows
/// @throws chladni::Error when the variable is too large for the format, 2 GiB.
std::string mat_file(const std::string& description, const std::string& name, const MatArray& x);

}  // namespace chladni::mbs_export::formats
