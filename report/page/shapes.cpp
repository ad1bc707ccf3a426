#include "report/page/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "report/page/numbers.hpp"

namespace chladni::report {
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
