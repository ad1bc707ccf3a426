#include "expect_equal.hpp"

#include <gtest/gtest.h>

#include "mbs_export/files/body_files.hpp"

namespace chladni::mbs_export::test {
namespace {

void expect_equal(const MassIntegrals& a, const MassIntegrals& b)
{
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.second, b.second);
  EXPECT_EQ(a.displacement, b.displacement);
  EXPECT_EQ(a.position_displacement, b.position_displacement);
  for (std::size_t i = 0; i < a.products.size(); ++i) EXPECT_EQ(a.products[i], b.products[i]);
}

void expect_equal(const Stiffening& a, const Stiffening& b)
{
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.loads, b.loads);
  EXPECT_EQ(a.K, b.K);
}

void expect_equal(const ResultantModes& a, const ResultantModes& b)
{
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.kinds, b.kinds);
  EXPECT_EQ(a.units, b.units);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.axes, b.axes);
  EXPECT_EQ(a.S, b.S);
}

void expect_equal(const Picture& a, const Picture& b)
{
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.transformation, b.transformation);
}

void expect_equal(const ModeCount& a, const ModeCount& b)
{
  EXPECT_EQ(a.up_to, b.up_to);
  EXPECT_EQ(a.expected, b.expected);
  EXPECT_EQ(a.found, b.found);
}

void expect_equal(const Certificate& a, const Certificate& b)
{
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.frequencies, b.frequencies);
  EXPECT_EQ(a.eta2, b.eta2);
  EXPECT_EQ(a.estimates, b.estimates);
  EXPECT_EQ(a.rounding, b.rounding);
  EXPECT_EQ(a.mesh_errors, b.mesh_errors);
  EXPECT_EQ(a.mesh_shape_errors, b.mesh_shape_errors);
  EXPECT_EQ(a.mesh_compliances.sets, b.mesh_compliances.sets);
  EXPECT_EQ(a.mesh_compliances.growth, b.mesh_compliances.growth);
  EXPECT_EQ(a.bounds, b.bounds);
  expect_equal(a.fixed_interface, b.fixed_interface);
  expect_equal(a.range, b.range);
  expect_equal(a.complete, b.complete);
  EXPECT_EQ(a.n_rigid, b.n_rigid);
  EXPECT_EQ(a.rigid_residual, b.rigid_residual);
  EXPECT_EQ(a.condition, b.condition);
  EXPECT_EQ(files::difference(a.responses, b.responses, "responses"), "");
}

void expect_equal(const std::vector<AttachmentNode>& a, const std::vector<AttachmentNode>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].number, b[i].number);
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].drilling_axis, b[i].drilling_axis);
  }
}

void expect_equal(const std::vector<AttachmentSet>& a, const std::vector<AttachmentSet>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].nodes, b[i].nodes);
  }
}

void expect_equal(const ContactRing& a, const ContactRing& b)
{
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.angles, b.angles);
  EXPECT_EQ(a.W, b.W);
  EXPECT_EQ(a.W_r, b.W_r);
  EXPECT_EQ(a.W_t, b.W_t);
}

template <class Value>
void expect_equal_list(const std::vector<Value>& a, const std::vector<Value>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) expect_equal(a[i], b[i]);
}

void expect_equal(const SectorMotions& a, const SectorMotions& b)
{
  EXPECT_EQ(a.n_sectors, b.n_sectors);
  EXPECT_EQ(a.n_coordinates, b.n_coordinates);
  EXPECT_EQ(a.T, b.T);
  ASSERT_EQ(a.harmonics.size(), b.harmonics.size());
  for (std::size_t i = 0; i < a.harmonics.size(); ++i) {
    EXPECT_EQ(a.harmonics[i].order, b.harmonics[i].order);
    EXPECT_EQ(a.harmonics[i].x, b.harmonics[i].x);
    EXPECT_EQ(a.harmonics[i].y, b.harmonics[i].y);
    EXPECT_EQ(a.harmonics[i].columns, b.harmonics[i].columns);
  }
}

void expect_equal(const SectorHarmonics& a, const SectorHarmonics& b)
{
  EXPECT_EQ(a.n_sectors, b.n_sectors);
  EXPECT_EQ(a.order, b.order);
}

template <class Value>
void expect_equal_if_any(const std::optional<Value>& a, const std::optional<Value>& b)
{
  ASSERT_EQ(a.has_value(), b.has_value());
  if (a) expect_equal(*a, *b);
}

}  // namespace

void expect_equal(const ReducedSystem& a, const ReducedSystem& b)
{
  EXPECT_EQ(a.title, b.title);
  expect_equal(a.attachment_nodes, b.attachment_nodes);
  expect_equal(a.sets, b.sets);
  ASSERT_EQ(a.masters.size(), b.masters.size());
  for (std::size_t i = 0; i < a.masters.size(); ++i) {
    EXPECT_EQ(a.masters[i].node, b.masters[i].node);
    EXPECT_EQ(a.masters[i].component, b.masters[i].component);
    const auto &p = a.masters[i].harmonic, &q = b.masters[i].harmonic;
    ASSERT_EQ(p.has_value(), q.has_value());
    EXPECT_TRUE(!p || (p->set == q->set && p->order == q->order && p->is_sine == q->is_sine));
  }
  ASSERT_EQ(a.ring_motion.has_value(), b.ring_motion.has_value());
  if (a.ring_motion) {
    EXPECT_EQ(a.ring_motion->shapes, b.ring_motion->shapes);
    EXPECT_EQ(a.ring_motion->displacements, b.ring_motion->displacements);
  }
  EXPECT_EQ(a.K, b.K);
  EXPECT_EQ(a.M, b.M);
  EXPECT_EQ(a.C, b.C);
  EXPECT_EQ(a.H, b.H);
  EXPECT_EQ(a.fixed_interface_frequencies, b.fixed_interface_frequencies);
  expect_equal(a.picture, b.picture);
  expect_equal_if_any(a.picture_of_sectors, b.picture_of_sectors);
  expect_equal_if_any(a.sector_harmonics, b.sector_harmonics);
  expect_equal(a.certificate, b.certificate);
  expect_equal_list(a.resultants, b.resultants);
  expect_equal_if_any(a.mass_integrals, b.mass_integrals);
  expect_equal_if_any(a.stiffening, b.stiffening);
  EXPECT_EQ(files::difference(a.provenance, b.provenance, "provenance"), "");
}

void expect_equal(const ModalBody& a, const ModalBody& b)
{
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.kinds, b.kinds);
  EXPECT_EQ(a.omega, b.omega);
  EXPECT_EQ(a.C, b.C);
  EXPECT_EQ(a.H, b.H);
  expect_equal(a.attachment_nodes, b.attachment_nodes);
  expect_equal(a.sets, b.sets);
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.attachment_modes, b.attachment_modes);
  expect_equal_list(a.rings, b.rings);
  expect_equal(a.picture, b.picture);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.centre_of_mass, b.centre_of_mass);
  EXPECT_EQ(a.inertia, b.inertia);
  EXPECT_EQ(a.free_frequencies, b.free_frequencies);
  EXPECT_EQ(a.n_rigid, b.n_rigid);
  EXPECT_EQ(a.condition_Q_dd, b.condition_Q_dd);
  EXPECT_EQ(a.n_free_rigid, b.n_free_rigid);
  EXPECT_EQ(files::difference(a.preparation, b.preparation, "preparation"), "");
  expect_equal_list(a.resultants, b.resultants);
  expect_equal_if_any(a.mass_integrals, b.mass_integrals);
  expect_equal_if_any(a.stiffening, b.stiffening);
  EXPECT_EQ(files::difference(a.selection, b.selection, "selection"), "");
  EXPECT_EQ(files::difference(a.condensation, b.condensation, "condensation"), "");
  expect_equal_if_any(a.sector_harmonics, b.sector_harmonics);
  expect_equal(a.certificate, b.certificate);
  EXPECT_EQ(files::difference(a.provenance, b.provenance, "provenance"), "");
}

}  // namespace chladni::mbs_export::test
