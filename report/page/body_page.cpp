#include "report/page/body_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "report/describe_body.hpp"
#include "report/page/page.hpp"

namespace chladni::report {

using Eigen::Index;

namespace {

using std::numbers::pi;

/// The place in the certificate of each mode of the body: the next one of the same frequency.
/// Interface modes turn the modes above them, which then are no modes of the certificate.
std::vector<std::optional<Index>> certified_places(const mbs_export::ModalBody& body,
                                                   const mbs_export::Certificate& certificate)
{
  std::vector<std::optional<Index>> places(static_cast<std::size_t>(body.n_modes()));
  if (certificate.fixed != body.fixed) return places;  // another support, other modes
  constexpr double same = 1e-6;
  Index next = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double omega = body.omega[static_cast<Index>(i)];
    const auto& omega_c = certificate.frequencies;
    if (body.kinds[i] == mbs_export::ModeKind::rigid) continue;
    while (next < omega_c.size() && omega_c[next] < omega * (1.0 - same)) ++next;
    if (next < omega_c.size() && omega_c[next] <= omega * (1.0 + same)) places[i] = next++;
  }
  return places;
}

Json path_json(const std::vector<mbs_export::SelectionStep>& steps)
{
  std::vector<Json> points;
  for (const mbs_export::SelectionStep& step : steps) {
    points.push_back(Json::object({{"added", step.added},
                                   {"size", step.size()},
                                   {"interface", step.n_interface},
                                   {"error", rounded(step.error)}}));
  }
  return Json::array(points);
}

Json count_json(const std::string& of, const mbs_export::ModeCount& count)
{
  return Json::object({{"of", of},
                       {"up_to_Hz", rounded(count.up_to / (2.0 * pi))},
                       {"expected", count.expected},
                       {"found", count.found}});
}

}  // namespace

Json modes_json(const mbs_export::ModalBody& body, const mbs_export::Certificate& certificate,
                const ModeLooks& looks)
{
  const auto places = certified_places(body, certificate);
  std::vector<Json> modes;
  for (Index i = 0; i < body.n_modes(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const int number = static_cast<int>(i) + 1;
    std::vector<Json::Member> mode{{"number", number},
                                   {"frequency_Hz", rounded(body.omega[i] / (2.0 * pi))},
                                   {"kind", name_of(body.kinds[k])}};
    if (const auto look = looks.find(number); look != looks.end())
      for (Json::Member& member : look_members(look->second)) mode.push_back(std::move(member));
    if (const auto place = places[k]) {
      mode.emplace_back("estimate", rounded(mbs_export::estimated_errors(certificate)[*place]));
      if (*place < certificate.bounds.size())
        mode.emplace_back("bound", rounded(certificate.bounds[*place] / 2.0));
    }
    modes.push_back(Json::object(mode));
  }
  return Json::array(modes);
}

Json counts_json(const mbs_export::Certificate& certificate)
{
  std::vector<Json> counts;
  if (certificate.fixed_interface.up_to > 0.0)
    counts.push_back(count_json("fixed-interface modes", certificate.fixed_interface));
  if (certificate.range.up_to > 0.0) counts.push_back(count_json("modes", certificate.range));
  if (certificate.complete.up_to > 0.0 && certificate.complete.up_to != certificate.range.up_to)
    counts.push_back(count_json("modes", certificate.complete));
  return counts.empty() ? Json() : Json::array(counts);
}

Json selection_json(const mbs_export::ModalBody& body)
{
  if (!body.selection) return Json();
  const mbs_export::SelectionTable& selection = *body.selection;
  return Json::object({{"tolerance", rounded(selection.error)},
                       {"up_to_Hz", rounded(selection.Omega_max / (2.0 * pi))},
                       {"loads", texts(selection.loads)},
                       {"chosen", body.n_modes()},
                       {"modes_only", path_json(selection.modes_only)},
                       {"with_interface_modes", path_json(selection.with_interface_modes)}});
}

namespace {

/// A share of motion and what it looks like.
struct Share {
  double part = 0.0;
  const ModeLook* look = nullptr;
};

/// The shares of all looks that modes of the shape have, the modes of a pair as one.
std::vector<Share> shares_of(const Eigen::VectorXcd& shape, const std::vector<int>& mode_numbers,
                             const ModeLooks& looks)
{
  std::map<std::pair<int, int>, Share> shares;
  for (std::size_t i = 0; i < mode_numbers.size(); ++i) {
    const auto found = looks.find(mode_numbers[i]);
    if (found == looks.end()) continue;
    const ModeLook& look = found->second;
    Share& share = shares[{look.diameters, look.circles.value_or(-1)}];
    share.part += std::norm(shape[static_cast<Index>(i)]);
    share.look = &look;
  }
  std::vector<Share> all;
  for (const auto& [key, share] : shares) all.push_back(share);
  return all;
}

/// The dominant harmonic around the ring of (u_r, u_t), the displacements of its nodes in the plane
/// in a mode; none when they do not move.
std::optional<int> waves_in_plane(const mbs_export::ModalBody& body,
                                  const mbs_export::ContactRing& ring, Index mode)
{
  const Index n = ring.angles.size();
  if (std::ssize(ring.nodes) != n) return std::nullopt;
  std::optional<int> dominant;
  double largest = 0.0;
  for (int d = 0; d <= n / 2; ++d) {
    std::complex<double> u_r = 0.0, u_t = 0.0;
    for (Index i = 0; i < n; ++i) {
      const Index row = 6 * Index{ring.nodes[static_cast<std::size_t>(i)]};
      if (row + 6 > body.attachment_modes.rows()) return std::nullopt;
      const double x = body.attachment_modes(row, mode), y = body.attachment_modes(row + 1, mode),
                   c = std::cos(ring.angles[i]), s = std::sin(ring.angles[i]);
      const std::complex<double> wave = std::polar(1.0, -d * ring.angles[i]);
      u_r += (c * x + s * y) * wave;
      u_t += (c * y - s * x) * wave;
    }
    // A harmonic d > 0 stands for two terms of the series, d and -d.
    const double size = (d > 0 ? 2.0 : 1.0) * (std::norm(u_r) + std::norm(u_t));
    if (size > largest * (1.0 + 1e-9)) {
      largest = size;
      dominant = d;
    }
  }
  return dominant;
}

}  // namespace

ModeLooks mode_looks(const squeal::Disc& disc, const mbs_export::ModalBody& body)
{
  ModeLooks looks;
  const std::vector<int> diameters = squeal::nodal_diameters(disc);
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const squeal::ModeFigure figure =
        i < disc.figures.size() ? disc.figures[i] : squeal::ModeFigure{};
    looks[disc.mode_numbers[i]] = {
        .diameters = diameters[i], .circles = figure.circles, .in_plane = figure.in_plane};
  }
  const auto ring =
      std::ranges::find(body.rings, disc.rings.front().name, &mbs_export::ContactRing::name);
  if (ring == body.rings.end()) return looks;
  for (const int number : disc.still)
    if (const auto waves = waves_in_plane(body, *ring, number - 1))
      looks[number] = {.diameters = *waves, .circles = {}, .in_plane = 1.0};
  return looks;
}

std::vector<Json::Member> look_members(const ModeLook& look)
{
  return {{"diameters", look.diameters},
          {"circles", look.circles ? Json(*look.circles) : Json()},
          {"in_plane", look.in_plane ? rounded(*look.in_plane) : Json()}};
}

Json motion_looks(const squeal::EigenvalueMap& map, const ModeLooks& looks)
{
  if (map.shapes.empty() || map.mode_numbers.empty() || looks.empty()) return Json();
  std::vector<Json> all;
  for (Index j = 0; j < map.lambda.cols(); ++j) {
    Index i = 0;
    map.lambda.col(j).real().maxCoeff(&i);
    const Eigen::VectorXcd shape = map.shapes[static_cast<std::size_t>(i)].col(j);
    const std::vector<Share> shares = shares_of(shape, map.mode_numbers, looks);
    const auto largest = std::ranges::max_element(shares, {}, &Share::part);
    all.push_back(largest == shares.end() ? Json() : Json::object(look_members(*largest->look)));
  }
  return Json::array(all);
}

namespace {

constexpr Eigen::Index most_displacements = 1'500'000;  ///< 4 MB as 16-bit numbers in base64

/// 16-bit displacements; 32767 is `full_scale`.
Json packed_displacements(const Eigen::VectorXd& displacements, double full_scale)
{
  std::vector<std::int16_t> steps;
  const double step = full_scale > 0.0 ? full_scale / 32767.0 : 1.0;
  for (const double u : displacements)
    steps.push_back(static_cast<std::int16_t>(std::lround(u / step)));
  return packed(steps);
}

Json motion_json(const Motion& motion, const std::string& kind, const Eigen::MatrixXd& modes)
{
  const Eigen::VectorXd re = modes * motion.amplitude.real();
  const Eigen::VectorXd im = modes * motion.amplitude.imag();
  const double largest = std::max(re.cwiseAbs().maxCoeff(), im.cwiseAbs().maxCoeff());
  std::vector<Json::Member> members{{"name", motion.name},
                                    {"kind", kind},
                                    {"frequency_Hz", rounded(motion.frequency_Hz)},
                                    {"full_scale", rounded(largest)},
                                    {"re", packed_displacements(re, largest)}};
  if (im.cwiseAbs().maxCoeff() > 0.0) members.emplace_back("im", packed_displacements(im, largest));
  return Json::object(members);
}

Motion mode_alone(const mbs_export::ModalBody& body, Eigen::Index i)
{
  const double f_Hz = body.omega[i] / (2.0 * std::numbers::pi);
  return {.name = fmt::format("Mode {}", i + 1),
          .frequency_Hz = f_Hz,
          .amplitude = Eigen::VectorXcd::Unit(body.n_modes(), i)};
}

Json positions_json(const mbs_export::Picture& picture)
{
  std::vector<float> positions;
  for (const double x : picture.positions.reshaped<Eigen::RowMajor>())
    positions.push_back(static_cast<float>(x));
  return packed(positions);
}

Json cells_json(const mbs_export::Picture& picture)
{
  std::vector<std::int32_t> corners;
  for (const auto& cell : picture.cells) corners.insert(corners.end(), cell.begin(), cell.end());
  return packed(corners);
}

void add_lines(mbs_export::Picture& picture, const mbs_export::ContactRing& ring)
{
  const std::size_t n = ring.nodes.size();
  for (std::size_t i = 0; i < n; ++i) {
    const int next = ring.nodes[(i + 1) % n];
    picture.cells.push_back({ring.nodes[i], next, next, next});
  }
}

}  // namespace

mbs_export::Picture drawable(const mbs_export::ModalBody& body)
{
  if (body.picture.positions.rows() > 0) return body.picture;
  const auto n = static_cast<Eigen::Index>(body.attachment_nodes.size());
  mbs_export::Picture picture;
  picture.positions.resize(n, 3);
  picture.transformation.resize(3 * n, body.n_modes());
  for (Eigen::Index i = 0; i < n; ++i) {
    picture.positions.row(i) = body.attachment_nodes[static_cast<std::size_t>(i)].position;
    picture.transformation.middleRows<3>(3 * i) = body.attachment_modes.middleRows<3>(6 * i);
  }
  for (const mbs_export::ContactRing& ring : body.rings) add_lines(picture, ring);
  return picture;
}

Json shapes_json(const mbs_export::ModalBody& body, const std::vector<Motion>& motions)
{
  const mbs_export::Picture picture = drawable(body);
  if (picture.positions.rows() == 0) return Json();
  const Eigen::Index fitting = most_displacements / (3 * picture.positions.rows());
  const Eigen::Index n = std::min<Eigen::Index>(std::max<Eigen::Index>(fitting, 1), body.n_modes());
  const std::vector<std::string> kinds{"rigid", "constrained", "interface"};
  std::vector<Json> shapes;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto kind = static_cast<std::size_t>(body.kinds[static_cast<std::size_t>(i)]);
    shapes.push_back(motion_json(mode_alone(body, i), kinds[kind], picture.transformation));
  }
  for (const Motion& motion : motions)
    shapes.push_back(motion_json(motion, "squeal", picture.transformation));
  return Json::object({{"positions", positions_json(picture)},
                       {"cells", cells_json(picture)},
                       {"motions", Json::array(shapes)},
                       {"left_out", body.n_modes() - n}});
}

}  // namespace chladni::report
