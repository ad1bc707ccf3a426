#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "tests/references/squeal/analytic_body.hpp"

/// Bodies whose rings lie in the faces of a plate, and brakes with pads on them.
namespace chladni::squeal::test {

/// A ring at the height z that is linked rigidly to "track" in the middle surface: it moves by
/// u = -z (W_r, W_t) in its plane.
inline void add_linked_ring(mbs_export::ModalBody& body, const std::string& name, double z)
{
  mbs_export::ContactRing ring = body.rings.front();
  ring.name = name;
  ring.height = z;
  ring.nodes.clear();
  const auto first = static_cast<int>(body.attachment_modes.rows() / 6);
  body.attachment_modes.conservativeResizeLike(
      Eigen::MatrixXd::Zero(body.attachment_modes.rows() + 6 * ring.angles.size(), body.n_modes()));
  for (Eigen::Index i = 0; i < ring.angles.size(); ++i) {
    ring.nodes.push_back(first + static_cast<int>(i));
    auto u = body.attachment_modes.middleRows(6 * (first + i), 2);
    const double c = std::cos(ring.angles[i]), s = std::sin(ring.angles[i]);
    u.row(0) = -z * (c * ring.W_r.row(i) - s * ring.W_t.row(i));
    u.row(1) = -z * (s * ring.W_r.row(i) + c * ring.W_t.row(i));
  }
  body.rings.push_back(ring);
}

inline mbs_export::ModalBody linked_body(const std::vector<PlatePair>& pairs,
                                         const std::vector<double>& heights)
{
  mbs_export::ModalBody body = analytic_body(pairs);
  body.attachment_modes.resize(0, body.n_modes());
  for (std::size_t i = 0; i < heights.size(); ++i)
    add_linked_ring(body, "ring " + std::to_string(i + 1), heights[i]);
  return body;
}

inline std::vector<PlatePair> three_pairs()
{
  return {kirchhoff_2(), kirchhoff_3(), kirchhoff_4()};
}

/// Two pads, one of them with a plate that moves in all directions and a caliper.
inline SquealOptions brake_options(ContactLaw law = ContactLaw::bilateral)
{
  SquealOptions options = reference_options(law);
  options.pads[0].damping = 20.0;
  PadPair second = options.pads[0];
  second.angle = 1.2;
  second.body = PadBody{.mass = 0.3,
                        .height = 0.01,
                        .radial = Suspension{3e7, 20.0},
                        .tangential = Suspension{2e7, 20.0},
                        .axial = Suspension{5e6, 30.0},
                        .about_radial = RotarySuspension{1.5e-4, {3e3, 0.05}}};
  second.caliper = Caliper{.mass = 3.0, .axial = {4e6, 10.0}};
  second.grid = PadGrid{.sector = 0.4, .points = 3};
  options.pads.push_back(second);
  return options;
}

inline SquealOptions on_rings(SquealOptions options, const std::string& ring,
                              const ContactPlanes& planes)
{
  options.ring = ring;
  options.planes = planes;
  return options;
}

/// Pads on rings in the two faces of the plate.
inline SquealOptions on_faces(const SquealOptions& options)
{
  return on_rings(options, "ring 1", {.opposite_ring = "ring 2"});
}

inline Disc disc_for(const mbs_export::ModalBody& body, const SquealOptions& options)
{
  return make_disc(body, ring_choice(options), {});
}

inline Eigen::MatrixXd matrix_of_brake(const mbs_export::ModalBody& body,
                                       const SquealOptions& options)
{
  return state_matrix(inertial_disc(disc_for(body, options)), options, 18.0);
}

}  // namespace chladni::squeal::test
