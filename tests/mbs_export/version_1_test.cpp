// Files of version 1 stay readable for ever, down to the last bit.
#include "version_1.hpp"

#include <gtest/gtest.h>

#include "mbs_export/body_file.hpp"
#include "mbs_export/reduced_file.hpp"

namespace chladni::mbs_export {
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

void expect_equal(const Provenance& a, const Provenance& b)
{
  EXPECT_EQ(a.scene, b.scene);
  EXPECT_EQ(a.mesh_checksum, b.mesh_checksum);
  EXPECT_EQ(a.versions, b.versions);
  EXPECT_EQ(a.options, b.options);
  EXPECT_EQ(a.ranks, b.ranks);
}

void expect_equal(const std::vector<SelectionStep>& a, const std::vector<SelectionStep>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].added, b[i].added);
    EXPECT_EQ(a[i].n_modes, b[i].n_modes);
    EXPECT_EQ(a[i].n_interface, b[i].n_interface);
    EXPECT_EQ(a[i].error, b[i].error);
  }
}

TEST(Version1, OfAReducedSystemIsReadBitByBit)
{
  const ReducedSystem a = test::version_1_reduced();
  const ReducedSystem b = read_reduced(CHLADNI_SOURCE_DIR "/tests/data/version_1.reduced.h5");
  EXPECT_EQ(a.title, b.title);
  ASSERT_EQ(b.attachment_nodes.size(), 2u);
  EXPECT_EQ(a.attachment_nodes[0].number, b.attachment_nodes[0].number);
  EXPECT_EQ(a.attachment_nodes[0].position, b.attachment_nodes[0].position);
  EXPECT_EQ(a.sets[0].name, b.sets[0].name);
  EXPECT_EQ(a.sets[0].nodes, b.sets[0].nodes);
  ASSERT_EQ(b.masters.size(), 3u);
  EXPECT_EQ(a.masters[1].node, b.masters[1].node);
  EXPECT_EQ(a.masters[1].component, b.masters[1].component);
  EXPECT_EQ(a.K, b.K);
  EXPECT_EQ(a.M, b.M);
  EXPECT_EQ(a.C, b.C);
  EXPECT_EQ(a.fixed_interface_frequencies, b.fixed_interface_frequencies);
  EXPECT_EQ(a.certificate.fixed, b.certificate.fixed);
  EXPECT_EQ(a.certificate.frequencies, b.certificate.frequencies);
  EXPECT_EQ(a.certificate.eta2, b.certificate.eta2);
  expect_equal(a.picture, b.picture);
  expect_equal(a.resultants[0], b.resultants.at(0));
  expect_equal(*a.mass_integrals, b.mass_integrals.value());
  expect_equal(a.provenance, b.provenance);
}

TEST(Version1, OfABodyIsReadBitByBit)
{
  const ModalBody a = test::version_1_body();
  const ModalBody b = read_body(CHLADNI_SOURCE_DIR "/tests/data/version_1.body.h5");
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.kinds, b.kinds);
  EXPECT_EQ(a.omega, b.omega);
  EXPECT_EQ(a.C, b.C);
  EXPECT_EQ(a.attachment_nodes[2].position, b.attachment_nodes.at(2).position);
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.attachment_modes, b.attachment_modes);
  const ContactRing &x = a.rings[0], &y = b.rings.at(0);
  EXPECT_EQ(x.radius, y.radius);
  EXPECT_EQ(x.height, y.height);
  EXPECT_EQ(x.nodes, y.nodes);
  EXPECT_EQ(x.angles, y.angles);
  EXPECT_EQ(x.W, y.W);
  EXPECT_EQ(x.W_r, y.W_r);
  EXPECT_EQ(x.W_t, y.W_t);
  expect_equal(a.picture, b.picture);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.centre_of_mass, b.centre_of_mass);
  EXPECT_EQ(a.inertia, b.inertia);
  EXPECT_EQ(a.free_frequencies, b.free_frequencies);
  EXPECT_EQ(a.n_rigid, b.n_rigid);
  EXPECT_EQ(a.condition_Q_dd, b.condition_Q_dd);
  EXPECT_EQ(a.n_free_rigid, b.n_free_rigid);
  EXPECT_EQ(a.preparation.n_massless, b.preparation.n_massless);
  EXPECT_EQ(a.preparation.rigid_residual, b.preparation.rigid_residual);
  expect_equal(a.resultants[0], b.resultants.at(0));
  expect_equal(*a.mass_integrals, b.mass_integrals.value());
  expect_equal(a.selection->modes_only, b.selection.value().modes_only);
  expect_equal(a.provenance, b.provenance);
}

}  // namespace
}  // namespace chladni::mbs_export
