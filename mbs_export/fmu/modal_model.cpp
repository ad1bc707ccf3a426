#include "mbs_export/fmu/modal_model.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include <cstring>

#include "common/error.hpp"

namespace chladni::fmu {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr std::string_view mark = "chladni-fmu-body 1\n";

void append(std::string& bytes, const void* from, std::size_t n)
{
  bytes.append(static_cast<const char*>(from), n);
}

void append(std::string& bytes, std::uint64_t number)
{
  append(bytes, &number, sizeof(number));
}

void append(std::string& bytes, const Eigen::MatrixXd& values)
{
  append(bytes, values.data(), static_cast<std::size_t>(values.size()) * sizeof(double));
}

class Source {
 public:
  explicit Source(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::uint64_t n)
  {
    if (n > rest_.size()) throw Error(std::string(model_file) + " is cut off");
    const std::string_view taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }
  /// A number of things of at least eight bytes each, which must all be there.
  Eigen::Index count()
  {
    std::uint64_t number = 0;
    std::memcpy(&number, take(sizeof(number)).data(), sizeof(number));
    if (number > rest_.size()) throw Error(std::string(model_file) + " is cut off");
    return static_cast<Eigen::Index>(number);
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index cols)
  {
    const std::uint64_t n = std::uint64_t(rows) * std::uint64_t(cols);
    if (n > rest_.size()) throw Error(std::string(model_file) + " is cut off");
    Eigen::MatrixXd values(rows, cols);
    if (n > 0) std::memcpy(values.data(), take(n * sizeof(double)).data(), n * sizeof(double));
    if (!values.allFinite()) {
      throw Error(std::string(model_file) +
                  " contains a value that is no finite number; export the FMU again");
    }
    return values;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

}  // namespace

std::string packed(const ModalModel& model)
{
  std::string bytes(mark);
  append(bytes, std::uint64_t(model.token.size()));
  bytes += model.token;
  for (const Eigen::Index n : {model.n_modes(), model.n_dofs(), model.C.rows()})
    append(bytes, std::uint64_t(n));
  append(bytes, Eigen::MatrixXd(model.omega));
  append(bytes, model.C);
  append(bytes, model.Phi);
  return bytes;
}

ModalModel unpacked(std::string_view bytes)
{
  if (!bytes.starts_with(mark)) {
    throw Error(std::string(model_file) +
                " is not a body file for FMUs of version 1; export the FMU again");
  }
  Source source(bytes.substr(mark.size()));
  ModalModel model;
  model.token = source.take(std::uint64_t(source.count()));
  const Eigen::Index n_modes = source.count(), n_dofs = source.count(), n_damped = source.count();
  if (n_damped != 0 && n_damped != n_modes) {
    throw Error(std::string(model_file) +
                ": its damping matrix does not have the size of its modes; export the FMU again");
  }
  model.omega = source.matrix(n_modes, 1);
  model.C = source.matrix(n_damped, n_damped);
  model.Phi = source.matrix(n_dofs, n_modes);
  if (!source.at_end()) {
    throw Error(std::string(model_file) +
                " has more bytes than its contents need; export the FMU again");
  }
  return model;
}

namespace {

/// In coordinates s q with s = max(omega, 1/h), so that A h has entries of the size of omega h
/// instead of (omega h)^2.
Propagator dense_propagator(const VectorXd& omega, const MatrixXd& C, double h)
{
  const Index n = omega.size();
  const VectorXd s = omega.cwiseMax(1.0 / h);
  MatrixXd A = MatrixXd::Zero(3 * n, 3 * n);
  A.block(0, n, n, n) = s.asDiagonal();
  A.block(n, 0, n, n) = (-omega.cwiseAbs2().cwiseQuotient(s)).asDiagonal();
  A.block(n, n, n, n) = -C;
  A.block(n, 2 * n, n, n).setIdentity();
  const MatrixXd exponential = (A * h).exp();
  VectorXd scale = VectorXd::Ones(2 * n);
  scale.head(n) = s;
  return {.from_state = scale.cwiseInverse().asDiagonal() *
                        exponential.topLeftCorner(2 * n, 2 * n) * scale.asDiagonal(),
          .from_force = scale.cwiseInverse().asDiagonal() * exponential.topRightCorner(2 * n, n)};
}

}  // namespace

Propagator propagator(const VectorXd& omega, const MatrixXd& C, double h)
{
  const Index n = omega.size();
  if (n == 0 || !C.isDiagonal(0.0)) return dense_propagator(omega, C, h);
  Propagator all{.from_state = MatrixXd::Zero(2 * n, 2 * n),
                 .from_force = MatrixXd::Zero(2 * n, n)};
  for (Index i = 0; i < n; ++i) {
    const Propagator one = dense_propagator(omega.segment(i, 1), C.block(i, i, 1, 1), h);
    for (Index row = 0; row < 2; ++row) {
      for (Index col = 0; col < 2; ++col)
        all.from_state(row * n + i, col * n + i) = one.from_state(row, col);
      all.from_force(row * n + i, i) = one.from_force(row, 0);
    }
  }
  return all;
}

}  // namespace chladni::fmu
