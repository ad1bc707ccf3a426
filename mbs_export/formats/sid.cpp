#include "mbs_export/formats/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "mbs_export/formats/export_error.hpp"
#include "mbs_export/formats/floating_body.hpp"

namespace chladni::mbs_export::formats {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d;

namespace {

/// M(q) = M0 + sum_j M1_j q_j; without a first order `M1` is empty.
struct Taylor {
  MatrixXd M0;
  std::vector<MatrixXd> M1 = {};
  int structure = 3;  ///< 2: symmetric, and only the lower triangle of M0 is written
};

/// Fortran's D takes the place of E; 17 digits return every double.
std::string number(double x)
{
  std::string text = fmt::format("{: .16E}", x);
  text[text.find('E')] = 'D';
  return text;
}

/// Blocks are indented alike; the readers look for words and numbers, not for columns.
class SidText {
 public:
  SidText(Index n_modes, SidDialect dialect) : n_modes_(n_modes), dialect_(dialect) {}

  void line(const std::string& text) { text_ += "    " + text + "\n"; }
  void taylor(const std::string& name, const Taylor& block)
  {
    line(name);
    const bool is_zero = block.M0.isZero(0.0) &&
                         std::ranges::all_of(block.M1, [](const auto& M) { return M.isZero(0.0); });
    const std::array<std::pair<const char*, Index>, 6> sizes{
        {{"order", block.M1.empty() ? 0 : 1},
         {"nrow", block.M0.rows()},
         {"ncol", block.M0.cols()},
         {"nq", n_modes_},
         {"nqn", 0},
         {"structure", is_zero ? 0 : block.structure}}};
    for (const auto& [word, size] : sizes) line(fmt::format("    {:<12}= {:5}", word, size));
    zeroth_order(block);
    for (std::size_t j = 0; j < block.M1.size(); ++j) first_order(block.M1[j], Index(j));
    line("end " + name);
  }
  const std::string& text() const { return text_; }

 private:
  void zeroth_order(const Taylor& block)
  {
    for (Index i = 0; i < block.M0.rows(); ++i)
      for (Index j = 0; j < block.M0.cols(); ++j)
        if (block.M0(i, j) != 0.0 && (block.structure != 2 || j <= i))
          line(fmt::format("    m0({:3},{:3}) = {}", i + 1, j + 1, number(block.M0(i, j))));
  }
  void first_order(const MatrixXd& M, Index mode)
  {
    for (Index i = 0; i < M.rows(); ++i) {
      for (Index j = 0; j < M.cols(); ++j) {
        if (M(i, j) == 0.0) continue;
        const bool mode_last = dialect_ == SidDialect::welib;
        line(fmt::format("    m1({:3},{:3},{:3}) = {}", i + 1, (mode_last ? j : mode) + 1,
                         (mode_last ? mode : j) + 1, number(M(i, j))));
      }
    }
  }

  Index n_modes_;
  SidDialect dialect_;
  std::string text_;
};

/// a~ with a~ b = a x b.
Eigen::Matrix3d cross_matrix(const Vector3d& a)
{
  Eigen::Matrix3d S;
  S << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return S;
}

template <typename Make>
std::vector<MatrixXd> for_each_mode(Index n, const Make& make)
{
  std::vector<MatrixXd> M1;
  for (Index j = 0; j < n; ++j) M1.push_back(make(j));
  return M1;
}

void add_node(SidText& sid, const ModalBody& body, std::size_t node, int number)
{
  const MatrixXd phi = body.attachment_modes.middleRows(6 * Index(node), 3);
  const MatrixXd psi = body.attachment_modes.middleRows(6 * Index(node) + 3, 3);
  sid.line(fmt::format("new node    = {:5}", number));
  sid.line("rframe      = body ref");
  sid.taylor("origin", {body.attachment_nodes[node].position,
                        for_each_mode(phi.cols(), [&](Index j) { return phi.col(j); })});
  sid.taylor("phi", {phi});
  sid.taylor("psi", {psi});
  sid.taylor("AP", {Eigen::Matrix3d::Identity(),
                    for_each_mode(psi.cols(), [&](Index j) { return cross_matrix(psi.col(j)); })});
  sid.line("end node");
}

/// xx, yy, zz, xy, xz, yz of a symmetric tensor.
Eigen::Vector<double, 6> six(const Eigen::Matrix3d& A)
{
  return {A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(0, 2), A(1, 2)};
}

/// J(q) to first order: J1_j = -C4_j - C4_j^T, C4_j = int x~ phi~_j dm.
Taylor inertia(const MassIntegrals& integrals, SidDialect dialect)
{
  const bool as_matrix = dialect == SidDialect::welib;
  const auto arranged = [&](const Eigen::Matrix3d& J) {
    return as_matrix ? MatrixXd(J) : MatrixXd(six(J));
  };
  Taylor J{.M0 = arranged(inertia_about_origin(integrals)), .structure = as_matrix ? 2 : 3};
  J.M1 = for_each_mode(integrals.displacement.cols(), [&](Index j) {
    const Eigen::Matrix3d C4 = position_tilde_shape(integrals, j);
    return arranged(-C4 - C4.transpose());
  });
  return J;
}

/// K_sigma q of a load is a force that the first order of its coefficients holds; zero where the
/// body has no such matrix.
MatrixXd stiffening_under(const ModalBody& body, const std::string& load)
{
  if (body.stiffening &&
      std::ranges::find(body.stiffening->loads, load) != body.stiffening->loads.end())
    return stiffening_by(*body.stiffening, load);
  return MatrixXd::Zero(body.n_modes(), body.n_modes());
}

/// The load of omega_k omega_l.
const std::string& load_of_product(int k, int l)
{
  for (std::size_t i = 0; i < product_axes.size(); ++i)
    if (product_axes[i] == std::pair{k, l} || product_axes[i] == std::pair{l, k})
      return stiffening_loads[i];
  return stiffening_loads.front();
}

/// int phi_i . (omega x (omega x (x + sum phi_j q_j))) dm by the six products of omega, and the
/// geometric stiffness by the stress of these forces.
Taylor centrifugal(const ModalBody& body, SidDialect dialect)
{
  const MassIntegrals& integrals = *body.mass_integrals;
  using Pairs = std::array<std::pair<int, int>, 6>;
  const Pairs axes = dialect == SidDialect::simpack
                         ? Pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}}
                         : Pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  const Index n = integrals.displacement.cols();
  const auto S = [&](int k, int l) { return displacement_product(integrals, k, l); };
  const MatrixXd M = S(0, 0) + S(1, 1) + S(2, 2);
  Taylor O_e{.M0 = MatrixXd(n, 6), .M1 = std::vector<MatrixXd>(std::size_t(n), MatrixXd(n, 6))};
  for (Index c = 0; c < 6; ++c) {
    const auto [k, l] = axes[std::size_t(c)];
    const MatrixXd of_mass = k == l ? MatrixXd(S(k, k) - M) : MatrixXd(S(k, l) + S(l, k));
    const MatrixXd both = of_mass + stiffening_under(body, load_of_product(k, l));
    for (Index j = 0; j < n; ++j) {
      const Eigen::Matrix3d C4 = position_tilde_shape(integrals, j);
      O_e.M0(j, c) = k == l ? C4(k, k) : C4(k, l) + C4(l, k);
      O_e.M1[std::size_t(j)].col(c) = both.col(j);
    }
  }
  return O_e;
}

/// Ct(q) to first order: its factor is the acceleration of the frame, whose stress stiffens.
Taylor translational(const ModalBody& body)
{
  const Index n = body.n_modes();
  Taylor C_t{.M0 = body.mass_integrals->displacement.transpose()};
  const std::array<MatrixXd, 3> K{stiffening_under(body, "acceleration_x"),
                                  stiffening_under(body, "acceleration_y"),
                                  stiffening_under(body, "acceleration_z")};
  const auto is_zero = [](const MatrixXd& A) { return A.isZero(0.0); };
  if (std::ranges::all_of(K, is_zero)) return C_t;
  C_t.M1 = for_each_mode(n, [&](Index j) {
    MatrixXd M1(n, 3);
    for (Index c = 0; c < 3; ++c) M1.col(c) = K[std::size_t(c)].col(j);
    return M1;
  });
  return C_t;
}

/// Cr(q) = int phi x~... to first order: Cr1_m(i, c) = int (phi_m x phi_i)_c dm, and Ge = 2 Cr1.
/// The stress of angular accelerations stiffens by Cr1 too.
struct Rotational {
  Taylor Cr, G_e, Gr;
};

Rotational rotational(const FloatingBody& floating, const MassIntegrals& integrals)
{
  const Index n = integrals.displacement.cols();
  Rotational terms{.Cr = {.M0 = floating.angular_momentum.transpose(),
                          .M1 = std::vector<MatrixXd>(std::size_t(n), MatrixXd(n, 3))},
                   .G_e = {MatrixXd(n, 3 * n)},
                   .Gr = {MatrixXd(3, 3 * n)}};
  for (int c = 0; c < 3; ++c) {
    const MatrixXd cross = cross_product(integrals, c);
    const MatrixXd K = stiffening_under(floating.body, stiffening_loads[6 + std::size_t(c)]);
    for (Index m = 0; m < n; ++m) {
      terms.Cr.M1[std::size_t(m)].col(c) = cross.row(m).transpose() + K.col(m);
      terms.G_e.M0.col(3 * m + c) = 2.0 * cross.row(m).transpose();
    }
  }
  for (Index j = 0; j < n; ++j)
    terms.Gr.M0.middleCols<3>(3 * j) = -2.0 * position_tilde_shape(integrals, j);
  return terms;
}

/// Columns by mode and axis, or by axis and mode.
Taylor in_order(const Taylor& block, SidGyroscopic order)
{
  if (order == SidGyroscopic::by_mode) return block;
  const Index n = block.M0.cols() / 3;
  Taylor by_axis = block;
  for (Index mode = 0; mode < n; ++mode)
    for (Index c = 0; c < 3; ++c) by_axis.M0.col(c * n + mode) = block.M0.col(3 * mode + c);
  return by_axis;
}

/// What readers would take for a value or an end of line is left out.
std::string sid_header(const ModalBody& body)
{
  std::string title = body.title.substr(0, 100);
  std::erase_if(title, [](unsigned char c) { return c == '=' || c < 32; });
  return fmt::format("{:5} {:5}    :No. nodes, No. modes: made by Chladni in SI units, {}\n",
                     body.attachment_nodes.size(), body.n_modes(), title);
}

void add_reference(SidText& sid, const ModalBody& body)
{
  sid.line("refmod");
  sid.line(fmt::format("    mass            = {}", number(body.mass)));
  sid.line(fmt::format("    nelastq         = {:5}", body.n_modes()));
  for (Index j = 0; j < body.n_modes(); ++j) {
    sid.line(fmt::format("    ielastq ({:5}) = Mode {:5} : {:14.6f} Hz", j + 1, j + 1,
                         body.omega[j] / (2.0 * std::numbers::pi)));
  }
  sid.line("end refmod");
}

}  // namespace

std::string sid_fem(const FloatingBody& floating, const SidOptions& options)
{
  const ModalBody& body = floating.body;
  const Index n = body.n_modes();
  if (n == 0) throw ExportError("body.keep", "SID_FEM: the body has no elastic mode");
  if (!body.mass_integrals) {
    throw ExportError(
        "reduce.mass_integrals",
        "SID_FEM: the reduced system has no mass integrals; reduce the scene again, without "
        "mass_integrals = false in [reduce]");
  }
  const MassIntegrals& integrals = *body.mass_integrals;
  SidText sid(n, options.dialect);
  sid.line("new modal   =");
  add_reference(sid, body);
  sid.line("frame");
  // The reader of EMBSlib holds five digits of a number.
  const std::vector<int> numbers = unique_node_numbers(body.attachment_nodes, 99999);
  for (std::size_t node = 0; node < numbers.size(); ++node)
    add_node(sid, body, node, numbers[node]);
  sid.line("end frame");
  sid.taylor("mdCM", {integrals.first,
                      for_each_mode(n, [&](Index j) { return integrals.displacement.col(j); })});
  sid.taylor("J", inertia(integrals, options.dialect));
  sid.taylor("Ct", translational(body));
  const Rotational terms = rotational(floating, integrals);
  sid.taylor("Cr", terms.Cr);
  sid.taylor("Me", {MatrixXd::Identity(n, n)});
  sid.taylor("Gr", in_order(terms.Gr, options.gyroscopic));
  sid.taylor("Ge", in_order(terms.G_e, options.gyroscopic));
  sid.taylor("Oe", centrifugal(body, options.dialect));
  sid.taylor("ksigma", {MatrixXd::Zero(n, 1)});
  sid.taylor("Ke", {MatrixXd(body.omega.cwiseAbs2().asDiagonal())});
  sid.taylor("De", {body.C.size() > 0 ? body.C : MatrixXd::Zero(n, n)});
  sid.line("end modal");
  return sid_header(body) + "part\n" + sid.text() + "end part\n";
}

std::vector<int> unique_node_numbers(const std::vector<AttachmentNode>& nodes, int largest)
{
  if (nodes.size() > static_cast<std::size_t>(largest)) {
    throw Error(fmt::format("this format has numbers for {} nodes, and the body has {}", largest,
                            nodes.size()));
  }
  std::vector<int> numbers;
  std::set<std::int64_t> taken;
  for (const AttachmentNode& node : nodes) {
    const bool own = node.number >= 1 && node.number <= largest && taken.insert(node.number).second;
    numbers.push_back(own ? static_cast<int>(node.number) : 0);
  }
  int next = 1;
  for (int& number : numbers) {
    if (number != 0) continue;
    while (!taken.insert(next).second) ++next;
    number = next;
  }
  return numbers;
}

}  // namespace chladni::mbs_export::formats
