#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Key sound_rows[] = {
    {"sound", table, "not asked for", "what `chladni sound` does, [sound](../how-to/sound.md)"},
    {"sound.microphones", tables, "none", "where the sound is listened to"},
    {"sound.microphones.name", text, "required", "each another one"},
    {"sound.microphones.position", numbers, "required",
     "[x, y, z] in the frame of the mesh, which does not rotate", in("m")},
    {"sound.outline", tables, "from the generators annulus, hat_disc",
     "middle surface of the body in the meridian"},
    {"sound.outline.from", numbers, "required", "[r, z], r >= 0", in("m")},
    {"sound.outline.to", numbers, "required", "[r, z], r >= 0", in("m")},
    {"sound.outline.thickness", number, "required", "of the piece, half on each side",
     positive("m")},
    {"sound.hub", word, "closed", "closed: the hole in the middle is filled and at rest", no_number,
     "closed | open"},
    {"sound.holes", tables, "none", "round holes along the axis"},
    {"sound.holes.circle_radius", number, "required", "of their centres", positive("m")},
    {"sound.holes.radius", number, "required", "of each", positive("m")},
    {"sound.holes.count", integer, "required", "at equal angles", from_to(1.0, 1e4)},
    {"sound.holes.angle_deg", number, "0", "of the first", in("degrees")},
    {"sound.cycle", word, "auto",
     "which limit cycle sounds; auto: the first of the others that is there", no_number,
     "auto | transient | direct"},
    {"sound.harmonics", integer, "5", "multiples of the frequency", from_to(1.0, 8.0)},
    {"sound.speeds_rad_s", numbers, "none",
     "levels of the limit cycles at further speeds, without and with radiation damping",
     positive("rad/s")},
    {"sound.wav", table, "no file", "the pressure at a microphone as sound"},
    {"sound.wav.microphone", text, "required", "its name"},
    {"sound.wav.rate_Hz", integer, "required", "of the samples", from_to(8000.0, 192000.0, "Hz")},
    {"sound.wav.duration_s", number, "required", "of the file", from_to(0.1, 600.0, "s")},
    {"sound.medium", table, "air at 20 C", "in which it sounds"},
    {"sound.medium.density", number, "required", "of the medium", positive("kg/m^3")},
    {"sound.medium.speed_of_sound", number, "required", "of the medium", positive("m/s")},
    {"sound.method", word, "auto", "Fourier series where the outline is axisymmetric", no_number,
     "auto | fourier | tetrahedra"},
    {"sound.order", integer, "6 in the plane, 2 in space", "of the elements", from_to(2.0, 8.0)},
    {"sound.element_size", number, "from the wavelength", "largest", positive("m")},
    {"sound.edge_size", number, "from the thickness", "at sharp edges", positive("m")},
    {"sound.inner_radius", number, "from body and wavelength", "where the absorbing layer begins",
     positive("m")},
    {"sound.layer_thickness", number, "half a wavelength", "of the absorbing layer", positive("m")},
    {"sound.layer_strength", number, "10; 5 for a thin layer or low order",
     "of the absorbing layer", positive()},
};

}  // namespace

std::span<const Key> sound_keys()
{
  return sound_rows;
}

}  // namespace chladni::scene
