#include "cli/node_rows.hpp"

namespace chladni::cli {

using Eigen::Index, Eigen::MatrixXd;

MatrixXd node_rows(const std::vector<int>& nodes, const plate::DofMap& dofs, const RowsOf& rows_of)
{
  std::vector<int> wanted;  // the DOFs of each node or of its reference
  for (const int node : nodes) {
    for (const int c : dofs.components) wanted.push_back(*dofs.dof(node, c));
  }
  const MatrixXd known = rows_of(wanted);
  const Index n_c = dofs.n_components();
  MatrixXd rows = MatrixXd::Zero(6 * std::ssize(nodes), known.cols());
  for (Index k = 0; k < std::ssize(nodes); ++k) {
    const int node = nodes[static_cast<std::size_t>(k)];
    for (Index i = 0; i < n_c; ++i) {
      rows.row(6 * k + dofs.components[static_cast<std::size_t>(i)]) = known.row(n_c * k + i);
    }
    if (!dofs.is_dependent(node)) continue;
    const auto [a, b, c] = dofs.arm(node);
    Eigen::Matrix3d R;  // theta x arm = R theta
    R << 0.0, c, -b, -c, 0.0, a, b, -a, 0.0;
    rows.middleRows<3>(6 * k) += R * rows.middleRows<3>(6 * k + 3);
  }
  return rows;
}

}  // namespace chladni::cli
