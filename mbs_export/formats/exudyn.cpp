#include "mbs_export/formats/formats.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/files/hdf5.hpp"
#include "mbs_export/formats/export_error.hpp"
#include "mbs_export/formats/floating_body.hpp"

namespace chladni::mbs_export::formats {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// The entries that LoadDictFromHDF5 takes: each object says of which Python type it is.
class Dictionary {
 public:
  explicit Dictionary(const std::string& path) : file_(path) {}

  template <class Derived>
  void array(const std::string& name, const Eigen::MatrixBase<Derived>& x)
  {
    file_.write(name, x, "SI");
    is(name, "ndarray");
  }
  void array(const std::string& name, const files::IntegerMatrix& x)
  {
    file_.write(name, x, "1");
    is(name, "ndarray");
  }
  void real(const std::string& name, double x)
  {
    file_.write(name, x, "SI");
    is(name, "float64");
  }
  void integer(const std::string& name, std::int64_t x)
  {
    file_.write(name, x, "1");
    is(name, "int");
  }
  void text(const std::string& name, const std::string& x)
  {
    file_.write(name, x);
    is(name, "str");
  }
  void list(const std::string& name, const std::vector<std::int64_t>& x)
  {
    file_.group(name);
    is(name, "list");
    for (std::size_t i = 0; i < x.size(); ++i) integer(fmt::format("{}/item_{}", name, i), x[i]);
  }
  void empty_dictionary(const std::string& name)
  {
    file_.group(name);
    is(name, "dict");
  }
  void commit() { file_.commit(); }

 private:
  void is(const std::string& name, const std::string& type)
  {
    file_.variable_attribute(name, "datatype", type);
  }
  files::Writer file_;
};

Matrix3d tilde(const Vector3d& a)
{
  Matrix3d S;
  S << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return S;
}

/// Positions and shapes at the nodes, rows x, y, z of each in turn.
struct Nodes {
  VectorXd x_ref;       ///< [3 nn]
  MatrixXd mode_basis;  ///< [3 nn x nm]
};

Nodes all_nodes(const ModalBody& body)
{
  const Index n_a = Index(body.attachment_nodes.size()), n_p = body.picture.positions.rows();
  Nodes nodes{VectorXd(3 * (n_a + n_p)), MatrixXd(3 * (n_a + n_p), body.n_modes())};
  for (Index i = 0; i < n_a; ++i) {
    nodes.x_ref.segment<3>(3 * i) = body.attachment_nodes[std::size_t(i)].position;
    nodes.mode_basis.middleRows<3>(3 * i) = body.attachment_modes.middleRows<3>(6 * i);
  }
  if (n_p == 0) return nodes;
  nodes.x_ref.tail(3 * n_p) = body.picture.positions.reshaped<Eigen::RowMajor>();
  nodes.mode_basis.bottomRows(3 * n_p) = body.picture.transformation;
  return nodes;
}

/// Triangles of the picture, two for each quadrilateral; lines have none.
files::IntegerMatrix triangles(const ModalBody& body)
{
  const auto first = static_cast<std::int64_t>(body.attachment_nodes.size());
  std::vector<std::array<std::int64_t, 3>> found;
  for (const auto& [a, b, c, d] : body.picture.cells) {
    if (b == c) continue;
    found.push_back({first + a, first + b, first + c});
    if (c != d) found.push_back({first + a, first + c, first + d});
  }
  files::IntegerMatrix matrix(Index(found.size()), 3);
  for (Index i = 0; i < matrix.rows(); ++i)
    for (Index j = 0; j < 3; ++j) matrix(i, j) = found[std::size_t(i)][std::size_t(j)];
  return matrix;
}

/// int psi~_i^T psi~_j dm = int (psi_i . psi_j) I - psi_j psi_i^T dm, [3 nm x 3 nm].
MatrixXd tilde_products(const MassIntegrals& integrals)
{
  const Index n = integrals.displacement.cols();
  const MatrixXd M =
      integrals.products[0] + integrals.products[1] + integrals.products[2];  // int psi_i . psi_j
  MatrixXd products(3 * n, 3 * n);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      // (r, c) of psi_j psi_i^T is psi_r,j psi_c,i
      MatrixXd P = -displacement_product(integrals, c, r);
      if (r == c) P += M;
      products(Eigen::seqN(r, n, 3), Eigen::seqN(c, n, 3)) = P;
    }
  }
  return products;
}

/// The terms of the moving frame as Exudyn calls them, Psi the shapes and ~ of each shape.
void write_products(Dictionary& dictionary, const MassIntegrals& integrals)
{
  const Index n = integrals.displacement.cols();
  MatrixXd Phi_Psi_tilde(3, 3 * n), x_Psi(3, n), x_Psi_tilde(3, 3 * n), Psi_Psi(3 * n, n);
  for (Index j = 0; j < n; ++j) {
    Phi_Psi_tilde.middleCols<3>(3 * j) = tilde(integrals.displacement.col(j));
    const Matrix3d C4 = position_tilde_shape(integrals, j);
    x_Psi_tilde.middleCols<3>(3 * j) = -C4;  // x~^T = -x~
    // C4 - C4^T = int phi x^T - x phi^T dm = (int x x phi dm)~
    x_Psi.col(j) = -Vector3d(C4(2, 1) - C4(1, 2), C4(0, 2) - C4(2, 0), C4(1, 0) - C4(0, 1));
  }
  for (int c = 0; c < 3; ++c) Psi_Psi(Eigen::seqN(c, n, 3), every) = -cross_product(integrals, c);
  dictionary.array("mPhitTPsi", integrals.displacement);
  dictionary.array("mPhitTPsiTilde", Phi_Psi_tilde);
  dictionary.array("mXRefTildePsi", x_Psi);
  dictionary.array("mXRefTildePsiTilde", x_Psi_tilde);
  dictionary.array("mPsiTildePsi", Psi_Psi);
  dictionary.array("mPsiTildePsiTilde", tilde_products(integrals));
}

void write_rigid_body(Dictionary& dictionary, const MassIntegrals& integrals)
{
  const Vector3d centre = integrals.first / integrals.mass;
  dictionary.array("Mtt", MatrixXd(integrals.mass * Matrix3d::Identity()));
  dictionary.real("totalMass", integrals.mass);
  dictionary.array("chiU", centre);
  dictionary.array("chiUtilde", tilde(centre));
  dictionary.array("inertiaLocal", inertia_about_origin(integrals));
}

}  // namespace

void write_exudyn(const std::string& path, const FloatingBody& floating)
{
  const ModalBody& body = floating.body;
  const Index n = body.n_modes();
  if (n == 0) throw ExportError("body.keep", "Exudyn: the body has no elastic mode");
  if (!body.mass_integrals) {
    throw ExportError(
        "reduce.mass_integrals",
        "Exudyn: the reduced system has no mass integrals; reduce the scene again, without "
        "mass_integrals = false in [reduce]");
  }
  const Nodes nodes = all_nodes(body);
  constexpr Index n_rotation = 4, n_rigid = 7;  // Euler parameters
  Dictionary dictionary(path);
  dictionary.text("type", "ObjectFFRFreducedOrderInterface");
  dictionary.integer("fileVersion", 1);
  dictionary.array("modeBasis", nodes.mode_basis);
  dictionary.array("xRef", nodes.x_ref);
  dictionary.array("trigList", triangles(body));
  dictionary.empty_dictionary("postProcessingModes");
  dictionary.array("massMatrixReduced", MatrixXd::Identity(n, n));
  dictionary.array("stiffnessMatrixReduced", MatrixXd(body.omega.cwiseAbs2().asDiagonal()));
  dictionary.list("infoList", {n, nodes.x_ref.size() / 3, 3, n_rotation, n_rigid, n_rigid + n});
  dictionary.text("rigidBodyNodeType", "NodeType.RotationEulerParameters");
  write_rigid_body(dictionary, *body.mass_integrals);
  write_products(dictionary, *body.mass_integrals);
  dictionary.commit();
}

}  // namespace chladni::mbs_export::formats
