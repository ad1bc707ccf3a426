#include "cli/node_rows.hpp"

namespace chladni::cli {

using Eigen::Index, Eigen::MatrixXd;

MatrixXd node_rows(const std::vector<int>& nodes, const plate::DofMap& dofs, const RowsOf& rows_of)
{
  const Index n_c = dofs.n_components();
  std::vector<int> wanted;  // the DOFs of all terms of the nodes' motions
  for (const int node : nodes) {
    for (const plate::MotionTerm& term : dofs.motion(node)) {
      for (int c = 0; c < n_c; ++c) wanted.push_back(static_cast<int>(n_c) * term.number + c);
    }
  }
  const MatrixXd known = rows_of(wanted);
  MatrixXd rows = MatrixXd::Zero(6 * std::ssize(nodes), known.cols());
  Index next = 0;
  for (Index k = 0; k < std::ssize(nodes); ++k) {
    for (const plate::MotionTerm& term : dofs.motion(nodes[static_cast<std::size_t>(k)])) {
      rows.middleRows<6>(6 * k) +=
          term.T(Eigen::all, dofs.components) * known.middleRows(next, n_c);
      next += n_c;
    }
  }
  return rows;
}

}  // namespace chladni::cli
