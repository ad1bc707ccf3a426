#include "cases/node_rows.hpp"
#include "common/eigen_every.hpp"

#include <algorithm>

namespace chladni::cases {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// The first components of the motions of nodes.
template <int n_components>
MatrixXd motion_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                     const RowsOf& rows_of)
{
  const int n_c = dofs.n_components();
  std::vector<int> numbers;  // on which the nodes depend, each once
  for (const int node : nodes)
    for (const plate::MotionTerm& term : dofs.motion(node)) numbers.push_back(term.number);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<int> wanted;
  for (const int number : numbers)
    for (int c = 0; c < n_c; ++c) wanted.push_back(n_c * number + c);
  const MatrixXd known = rows_of(wanted);
  MatrixXd rows = MatrixXd::Zero(n_components * std::ssize(nodes), known.cols());
  for (Index k = 0; k < std::ssize(nodes); ++k) {
    for (const plate::MotionTerm& term : dofs.motion(nodes[static_cast<std::size_t>(k)])) {
      const auto place = std::ranges::lower_bound(numbers, term.number) - numbers.begin();
      const MatrixXd T = term.T.topRows<n_components>()(every, dofs.components());
      rows.middleRows<n_components>(n_components * k).noalias() +=
          T.lazyProduct(known.middleRows(n_c * place, n_c));
    }
  }
  return rows;
}

}  // namespace

MatrixXd node_rows(const std::vector<int>& nodes, const plate::DofMap& dofs, const RowsOf& rows_of)
{
  return motion_rows<6>(nodes, dofs, rows_of);
}

MatrixXd displacement_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                           const RowsOf& rows_of)
{
  return motion_rows<3>(nodes, dofs, rows_of);
}

}  // namespace chladni::cases
