#include "squeal/fmu/driven_brake.hpp"

#include <cmath>
#include <complex>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "common/error.hpp"

namespace chladni::brake_fmu {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// The largest eigenvalue of a symmetric matrix, from below, by its powers.
double largest_eigenvalue(const MatrixXd& A)
{
  constexpr int n_powers = 50;
  VectorXd x = VectorXd::LinSpaced(A.rows(), 1.0, 2.0).normalized();
  double value = 0.0;
  for (int i = 0; i < n_powers; ++i) {
    const VectorXd y = A * x;
    value = y.norm();
    if (value == 0.0) return 0.0;
    x = y / value;
  }
  return value;
}

void check(const Drive& drive, const squeal::PadSystem& pads)
{
  const bool is_regularised = pads.points.front().contact.friction.regularisation > 0.0;
  if (!(drive.speed > 0.0) && !is_regularised) {
    throw Error("the speed is " + std::to_string(drive.speed) +
                " rad/s; it must be above 0, for friction has no direction at rest unless the "
                "scene regularises it");
  }
  if (!(drive.friction >= 0.0))
    throw Error("the friction is " + std::to_string(drive.friction) + "; it must be at least 0");
  for (std::size_t i = 0; i < drive.preloads.size(); ++i) {
    if (drive.preloads[i] > 0.0) continue;
    throw Error("the preload of pad " + std::to_string(i + 1) + " is " +
                std::to_string(drive.preloads[i]) + " N; it must be above 0");
  }
}

}  // namespace

std::vector<double> preloads_of(const squeal::PadSystem& pads)
{
  std::vector<double> preloads(pads.n_pads(), 0.0);
  for (const squeal::PointPair& point : pads.points) preloads[point.pad] += point.contact.preload;
  return preloads;
}

DrivenDisc::DrivenDisc(const BrakeModel& model)
    : model_(model),
      pads_(model.pads),
      shapes_(model.disc),
      series_(model.disc.compliance, pads_, 1.0),
      drive_{.speed = 0.0, .friction = 0.0, .preloads = {}},
      motions_(pads_.points.size()),
      contacts_(pads_.points.size())
{}

void DrivenDisc::set_drive(const Drive& drive)
{
  if (drive == drive_) return;
  check(drive, model_.pads);
  drive_ = drive;
  rebuild();
}

void DrivenDisc::rebuild()
{
  const std::vector<double> usual = preloads_of(model_.pads);
  for (std::size_t i = 0; i < pads_.points.size(); ++i) {
    const squeal::PadContact& of_scene = model_.pads.points[i].contact;
    const std::size_t pad = pads_.points[i].pad;
    squeal::PadContact& contact = pads_.points[i].contact;
    contact.friction.kinetic = drive_.friction;
    contact.preload = of_scene.preload * (drive_.preloads[pad] / usual[pad]);
  }
  squeal::FreeBrake free = squeal::free_brake(model_.disc, pads_, drive_.speed);
  omega_ = std::move(free.omega);
  C_ = std::move(free.C);
  series_ = squeal::ContactSeries(model_.disc.compliance, pads_, drive_.speed);
  points_.clear();
  for (const squeal::PointPair& point : pads_.points)
    points_.push_back(squeal::brake_point(shapes_.at(point, 0.0), pads_, point, drive_.speed));
}

VectorXd DrivenDisc::acceleration(double angle, const VectorXd& q, const VectorXd& v)
{
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const MatrixXd& of_disc = shapes_.at(pads_.points[i], angle);
    squeal::PairShapes& S = points_[i].S;
    S.topLeftCorner(of_disc.rows(), of_disc.cols()) = of_disc;
    motions_[i] = {.g = S.transpose() * q, .g_dot = S.transpose() * v};
  }
  series_.add_to(motions_, [&](std::size_t i, const squeal::PointMotion& at) {
    return squeal::contact_at(points_[i], at, drive_.speed).force;
  });
  VectorXd a = -omega_.cwiseAbs2().cwiseProduct(q) - C_ * v;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const squeal::PairContact at = squeal::contact_at(points_[i], motions_[i], drive_.speed);
    contacts_[i] = at.states;
    a += points_[i].S * at.force;
  }
  return a;
}

std::vector<squeal::ContactResult<double>> DrivenDisc::contacts() const
{
  return squeal::by_pad(pads_, contacts_);
}

double DrivenDisc::torque() const
{
  double torque = 0.0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const squeal::PadContact& contact = pads_.points[i].contact;
    torque += contact.faces[0].radius * contacts_[i].upper.f_t +
              contact.faces[1].radius * contacts_[i].lower.f_t;
  }
  return torque;
}

DrivenDisc::Rates DrivenDisc::fastest()
{
  MatrixXd K = omega_.cwiseAbs2().asDiagonal(), D = 0.5 * (C_ + C_.transpose());
  for (const squeal::BrakePoint& point : points_) {
    const squeal::PairDerivatives by =
        squeal::pair_derivatives(point.contact, drive_.speed, pads_.rows());
    K -= point.S * (0.5 * (by.D_a + by.D_a.transpose())) * point.S.transpose();
    D -= point.S * (0.5 * (by.D_p + by.D_p.transpose())) * point.S.transpose();
  }
  return {std::sqrt(largest_eigenvalue(K)), largest_eigenvalue(D)};
}

namespace {

constexpr std::string_view mark = "chladni-fmu-brake 2\n";

[[noreturn]] void refuse(const char* why)
{
  throw Error(std::string(brake_file) + " " + why);
}

template <class T>
concept Number = std::is_arithmetic_v<T>;

/// Numbers as eight bytes each, in the order in which `transfer` names them.
class Writer {
 public:
  void operator()(const Number auto& number) { append(static_cast<double>(number)); }
  void operator()(const std::string& text)
  {
    append(static_cast<double>(text.size()));
    bytes_ += text;
  }
  template <class Matrix>
  void matrix(const Matrix& A)
  {
    append(static_cast<double>(A.rows()));
    append(static_cast<double>(A.cols()));
    bytes_.append(reinterpret_cast<const char*>(A.data()),
                  static_cast<std::size_t>(A.size()) * sizeof(typename Matrix::Scalar));
  }
  void each(const auto& items, auto&& transfer)
  {
    append(static_cast<double>(items.size()));
    for (const auto& item : items) transfer(*this, item);
  }
  std::string bytes() && { return std::move(bytes_); }

 private:
  void append(double number)
  {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  void operator()(Number auto& number)
  {
    double value = 0.0;
    std::memcpy(&value, take(sizeof(value)).data(), sizeof(value));
    if (!std::isfinite(value) || std::abs(value) > 1e300)
      refuse("contains a value that is no finite number");
    using T = std::remove_reference_t<decltype(number)>;
    if constexpr (!std::is_same_v<T, double>) {
      if (value != std::floor(value) || value < 0.0 || value > 2e9)
        refuse("contains a count that is no whole number");
    }
    number = static_cast<T>(value);
  }
  void operator()(std::string& text) { text = take(count(1)); }
  template <class Matrix>
  void matrix(Matrix& A)
  {
    constexpr std::size_t size = sizeof(typename Matrix::Scalar);
    const std::size_t rows = count(0), cols = count(0);
    if (rows > 0 && cols > rest_.size() / rows / size) refuse("is cut off");
    if constexpr (Matrix::ColsAtCompileTime != Eigen::Dynamic) {
      if (static_cast<Index>(cols) != Index(Matrix::ColsAtCompileTime)) refuse("is damaged");
    }
    A.resize(static_cast<Index>(rows), static_cast<Index>(cols));
    const std::string_view bytes = take(rows * cols * size);
    if (!bytes.empty()) std::memcpy(A.data(), bytes.data(), bytes.size());
    if (!A.allFinite()) refuse("contains a value that is no finite number");
  }
  template <class T>
  void each(std::vector<T>& items, auto&& transfer)
  {
    items.resize(count(sizeof(double)));
    for (T& item : items) transfer(*this, item);
  }
  bool at_end() const { return rest_.empty(); }

 private:
  /// A number of things that take at least so many bytes each.
  std::size_t count(std::size_t bytes_each)
  {
    int n = 0;
    (*this)(n);
    if (bytes_each > 0 && static_cast<std::size_t>(n) > rest_.size() / bytes_each)
      refuse("is cut off");
    return static_cast<std::size_t>(n);
  }
  std::string_view take(std::size_t n)
  {
    if (n > rest_.size()) refuse("is cut off");
    const std::string_view taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }
  std::string_view rest_;
};

void transfer_ring(auto& archive, auto& ring)
{
  archive(ring.name);
  archive(ring.radius);
  archive(ring.height);
  archive(ring.n_nodes);
  for (auto* function : {&ring.W, &ring.W_r, &ring.W_t, &ring.V_r, &ring.V_t}) {
    archive.matrix(function->cosine);
    archive.matrix(function->sine);
  }
}

void transfer_contact(auto& archive, auto& contact)
{
  for (auto& face : contact.faces) {
    archive(face.radius);
    archive(face.plane);
    archive(face.distance);
  }
  archive(contact.friction.kinetic);
  archive(contact.friction.rise);
  archive(contact.friction.decay_speed);
  archive(contact.friction.regularisation);
  archive(contact.spring.linear);
  archive(contact.spring.cubic);
  archive(contact.damping);
  archive(contact.preload);
}

void transfer_disc(auto& archive, auto& disc)
{
  archive.matrix(disc.omega);
  archive.matrix(disc.C);
  archive.matrix(disc.G);
  archive.each(disc.rings, [](auto& inner, auto& ring) { transfer_ring(inner, ring); });
  archive.each(disc.compliance.C, [](auto& inner, auto& C) { inner.matrix(C); });
}

/// @param law  of all contacts, as a number
void transfer_pads(auto& archive, auto& pads, auto& law)
{
  archive(law);
  archive(pads.disc_rows);
  archive.matrix(pads.omega);
  archive.matrix(pads.C);
  archive.each(pads.points, [](auto& inner, auto& point) {
    inner(point.pad);
    inner(point.angle);
    inner(point.patch);
    for (auto& ring : point.rings) inner(ring);
    transfer_contact(inner, point.contact);
    inner.matrix(point.upper);
    inner.matrix(point.lower);
  });
}

void require(bool is_so, const char* why)
{
  if (!is_so) refuse(why);
}

void check_ring(const squeal::DiscRing& ring, Index n_modes, bool in_plane)
{
  for (const auto* f : {&ring.W, &ring.W_r, &ring.W_t, &ring.V_r, &ring.V_t}) {
    const bool is_needed = in_plane || (f != &ring.V_r && f != &ring.V_t);
    const Index n = is_needed ? n_modes : 0;
    require(f->cosine.cols() == n && f->sine.cols() == n && f->cosine.rows() == f->sine.rows() &&
                (n == 0 || f->cosine.rows() == ring.W.cosine.rows()),
            "has a ring of other modes");
  }
}

void check(const BrakeModel& model)
{
  const squeal::Disc& disc = model.disc;
  const squeal::PadSystem& pads = model.pads;
  const Index n = disc.n_modes(), m = pads.n_modes();
  require(
      n > 0 && disc.C.rows() == n && disc.C.cols() == n && disc.G.rows() == n && disc.G.cols() == n,
      "has matrices of other modes");
  const bool in_plane = pads.disc_rows == 2 * squeal::face_rows;
  require(in_plane || pads.disc_rows == squeal::middle_rows, "has points of no known kind");
  require(!disc.rings.empty() && !pads.points.empty(), "has no ring or no pad");
  for (const squeal::DiscRing& ring : disc.rings) check_ring(ring, n, in_plane);
  require(m == 0 || (pads.C.rows() == m && pads.C.cols() == m), "has pads of other modes");
  const auto n_rows = Index(in_plane ? 5 : 3) * std::ssize(disc.rings);
  for (const Eigen::MatrixXcd& C : disc.compliance.C)
    require(C.rows() == n_rows && C.cols() == n_rows, "has a compliance of other rings");
  std::size_t last = 0;
  for (const squeal::PointPair& point : pads.points) {
    require(point.pad == last || point.pad == last + 1, "has pads out of order");
    last = point.pad;
    require(point.rings[0] < disc.rings.size() && point.rings[1] < disc.rings.size(),
            "has a pad on a ring that is not there");
    require(point.upper.rows() == m && point.lower.rows() == m, "has a plate of other modes");
    require(point.contact.preload > 0.0, "has a pad without preload");
  }
}

}  // namespace

std::string packed(const BrakeModel& model)
{
  Writer writer;
  writer(model.token);
  writer(model.speed);
  transfer_disc(writer, model.disc);
  const int law = static_cast<int>(model.pads.points.front().contact.law);
  transfer_pads(writer, model.pads, law);
  return std::string(mark) + std::move(writer).bytes();
}

BrakeModel unpacked_brake(std::string_view bytes)
{
  if (!bytes.starts_with(mark)) refuse("is no brake of version 1 for an FMU");
  Reader reader(bytes.substr(mark.size()));
  BrakeModel model{};
  reader(model.token);
  reader(model.speed);
  transfer_disc(reader, model.disc);
  int law = 0;
  transfer_pads(reader, model.pads, law);
  require(reader.at_end(), "is longer than it says");
  require(law <= static_cast<int>(squeal::ContactLaw::signed_force), "has no known contact");
  for (squeal::PointPair& point : model.pads.points)
    point.contact.law = static_cast<squeal::ContactLaw>(law);
  check(model);
  model.friction = model.pads.points.front().contact.friction.kinetic;
  return model;
}

}  // namespace chladni::brake_fmu
