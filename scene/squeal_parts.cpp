#include "scene/squeal_tables.hpp"

namespace chladni::scene {
namespace {

using squeal::ContactLaw;

}  // namespace

squeal::FrictionLaw read_friction(const Table& squeal)
{
  if (!squeal.is_table("friction")) return {.kinetic = squeal.number("friction")};
  const Table table = squeal.table("friction");
  squeal::FrictionLaw law{.kinetic = table.number("kinetic")};
  if (table.has("static")) {
    law.rise = table.number("static", {.at_least = law.kinetic, .unit = "kinetic"}) - law.kinetic;
    law.decay_speed = table.number("decay_speed");
  }
  if (table.has("regularisation")) law.regularisation = table.number("regularisation");
  return law;
}

squeal::ContactLaw read_contact(const Table& squeal)
{
  if (!squeal.has("contact")) return ContactLaw::unilateral;
  return squeal.choice<ContactLaw>("contact", {{"unilateral", ContactLaw::unilateral},
                                               {"bilateral", ContactLaw::bilateral},
                                               {"signed", ContactLaw::signed_force}});
}

squeal::PadSpring read_pad_spring(const Table& pad)
{
  squeal::PadSpring spring{.linear = pad.number("stiffness")};
  if (pad.has("cubic_stiffness")) spring.cubic = pad.number("cubic_stiffness");
  return spring;
}

}  // namespace chladni::scene
