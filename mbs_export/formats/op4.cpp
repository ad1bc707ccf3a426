#include "mbs_export/formats/op4.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::Index;

constexpr int real_double = 2;

/// First and last row that are not zero; last < first for a column of zeros.
struct Rows {
  Index first, last;
};

Rows nonzero_rows(const Eigen::VectorXd& column)
{
  Rows rows{0, column.size() - 1};
  while (rows.first <= rows.last && column[rows.first] == 0.0) ++rows.first;
  while (rows.last >= rows.first && column[rows.last] == 0.0) --rows.last;
  return rows;
}

void append_values(std::string& text, const Eigen::VectorXd& values)
{
  constexpr Index per_line = 3;
  for (Index i = 0; i < values.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:23.16E}", values[i]);
    if (i % per_line == per_line - 1 || i == values.size() - 1) text += '\n';
  }
}

/// Exponents have two digits.
Eigen::MatrixXd writable(const std::string& name, const Eigen::MatrixXd& A)
{
  if (!A.allFinite() || A.cwiseAbs().maxCoeff() > 1e99)
    throw Error(fmt::format("{}: an entry is not finite or above 1e99; OP4 cannot hold it", name));
  return (A.array().abs() < 1e-99).select(0.0, A);
}

}  // namespace

std::string op4_matrix(const std::string& name, const Eigen::MatrixXd& A, MatrixForm form)
{
  const Eigen::MatrixXd values = writable(name, A);
  std::string text = fmt::format("{:8}{:8}{:8}{:8}{:<8}1P,3E23.16\n", A.cols(), A.rows(),
                                 static_cast<int>(form), real_double, name);
  for (Index j = 0; j < A.cols(); ++j) {
    const auto [first, last] = nonzero_rows(values.col(j));
    const Index n = last - first + 1;
    if (n <= 0) continue;
    text += fmt::format("{:8}{:8}{:8}\n", j + 1, first + 1, n);
    append_values(text, values.col(j).segment(first, n));
  }
  // The column after the last one ends the matrix; its value is never used.
  text += fmt::format("{:8}{:8}{:8}\n", A.cols() + 1, 1, 1);
  append_values(text, Eigen::VectorXd::Constant(1, std::sqrt(2.0)));
  return text;
}

}  // namespace chladni::mbs_export::formats
