"""What the axes of the arrays of a file are, by the names of its datasets (docs/reference/file_formats.md)."""

import re

# For each format: a pattern of dataset names, the axes, and where the coordinates along some axes stand. A name
# that is relative stands beside the dataset; one with a leading / counts from the root.
_Rows = list[tuple[str, tuple[str, ...], dict[str, str]]]
_OF_RESULTS: _Rows = [
    (r"(frozen_)?eigenvalues/speeds", ("speed",), {}),
    (r"frozen_eigenvalues/angles", ("speed",), {"speed": "speeds"}),
    (r"(frozen_)?eigenvalues/lambda_(re|im)", ("speed", "eigenvalue"), {"speed": "speeds"}),
    (r"eigenvalues/shapes/\d+/(re|im)", ("coordinate", "eigenvalue"), {}),
    (r".*mode_numbers", ("mode",), {}),
    (r"critical(_values/\d+)?/range/\w+", ("end",), {}),
    (r".*unstable/.*", ("interval",), {}),
    (r".*(envelope|windows|history|tail)/\w+", ("time",), {"time": "t"}),
    (r".*events/\w+", ("event",), {"event": "t"}),
    (r"limit_cycle\w*/amplitude_(re|im)", ("mode",), {"mode": "mode_numbers"}),
    (r".*multipliers_(re|im)", ("multiplier",), {}),
    (r".*/energy/\w+", ("pad",), {}),
    (r"limit_cycle_direct/x", ("state",), {}),
    (r"limit_cycle_branch/folds/\w+", ("fold",), {}),
    (r"limit_cycle_branch/\w+(/\w+)*", ("cycle",), {}),
    (r"rotation_stability/exponents_(re|im)", ("speed", "exponent"), {"speed": "speeds"}),
    (r"rotation_stability/\w+", ("speed",), {"speed": "speeds"}),
    (r"stability/(values)", ("value",), {}),
    (r"stability/(growth|angular_frequency)", ("branch", "value"), {"value": "values"}),
    (r"stability/band", ("end",), {}),
    (r"stability/families/\w+", ("family",), {}),
    (r"stability/shares", ("branch", "family"), {}),
    (r"stability/(worst/\w+|pads)", ("branch",), {}),
    (r"stability/work/\w+", ("unstable_mode",), {}),
    (r"stability_map/values", ("value",), {}),
    (r"stability_map/speeds", ("speed",), {}),
    (r"stability_map/\w+", ("value", "speed"), {"value": "values", "speed": "speeds"}),
    (r"spectrogram/lines/\w+", ("t", "line"), {"t": "/spectrogram/t"}),
    (r"spectrogram/amplitude", ("t", "frequency"), {"t": "t", "frequency": "frequency"}),
    (r"spectrogram/frequency", ("frequency",), {}),
    (r"spectrogram/\w+", ("t",), {"t": "t"}),
    (r"gradients/(keys|units|values|critical_speed_by_value)", ("key",), {"key": "keys"}),
    (r"gradients/growth_by_value", ("key", "motion"), {"key": "keys"}),
    (r"gradients/(growth|frequency)", ("motion",), {}),
    (r"spectrum/peaks/\w+", ("peak",), {}),
    (r"spectrum/\w+", ("frequency",), {"frequency": "frequency"}),
    (r"missing", ("analysis",), {}),
]
_OF_BODIES: _Rows = [
    (r"attachment/node_numbers", ("node",), {}),
    (r"attachment/(node_positions|drilling_axes)", ("node", "xyz"), {"node": "node_numbers"}),
    (r"attachment/set_names", ("set",), {}),
    (r"attachment/sets/.+", ("node_of_set",), {}),
    (r"attachment/displacements", ("node_component", "coordinate"), {}),
    (r"picture/positions", ("point", "xyz"), {}),
    (r"picture/cells", ("cell", "corner"), {}),
    (r"resultants/[^/]+/(kinds|units)", ("kind",), {}),
    (r"resultants/[^/]+/elements", ("point",), {}),
    (r"resultants/[^/]+/(positions)", ("point", "xyz"), {"point": "elements"}),
    (r"resultants/[^/]+/axes", ("point", "axis_component"), {"point": "elements"}),
    (r"mass_integrals/(first_moment)", ("xyz",), {}),
    (r"mass_integrals/second_moment", ("xyz", "xyz_2"), {}),
    (r"masters/shapes", ("node_component", "master"), {}),
    (r"masters/\w+", ("master",), {}),
    (r"fixed_interface_frequencies", ("fixed_interface_mode",), {}),
    (r"certificate/counts/\w+", ("count",), {}),
    (r"certificate/fixed|fixed", ("support",), {}),
    (r"certificate/frequencies", ("certified_mode",), {}),
    (r"certificate/(eta2|estimates|rounding|mesh_errors)", ("certified_mode",), {"certified_mode": "frequencies"}),
    (r"certificate/bounds", ("bounded_mode",), {}),
    (r"modes/(frequencies|kinds)", ("mode",), {}),
    (r"modes/loss_factors", ("mode",), {"mode": "frequencies"}),
    (r"modes/(structural_)?damping", ("mode", "mode_2"), {"mode": "frequencies", "mode_2": "frequencies"}),
    (r"modes/attachment_displacements", ("node_component", "mode"), {"mode": "frequencies"}),
    (r"modes/row_\w+", ("node_component",), {}),
    (r"ring_names", ("ring",), {}),
    (r"resultant_names", ("resultant",), {}),
    (r"rigid_body/centre_of_mass", ("xyz",), {}),
    (r"rigid_body/inertia", ("xyz", "xyz_2"), {}),
    (r"free_body/frequencies", ("free_mode",), {}),
    (r"selection/loads", ("load",), {}),
    (r"selection/\w+/\w+", ("step",), {}),
    (r"rings/[^/]+/(nodes|angles)", ("angle",), {"angle": "angles"}),
    (r"rings/[^/]+/\w+_(cosine|sine)", ("harmonic", "mode"), {"mode": "/modes/frequencies"}),
    (r"rings/[^/]+/\w+", ("angle", "mode"), {"angle": "angles", "mode": "/modes/frequencies"}),
]
_OF_REDUCED: _Rows = [
    (r"matrices/\w+", ("coordinate", "coordinate_2"), {}),
    (r"picture/displacements", ("point_component", "coordinate"), {}),
    (r"picture/sectors/[xy]", ("point_component_of_sector", "column"), {"column": "coordinates"}),
    (r"picture/sectors/transformation", ("coordinate", "coordinate_2"), {}),
    (r"picture/sectors/(harmonics|coordinates)", ("column",), {"column": "coordinates"}),
    (r"resultants/[^/]+/modes", ("point_kind", "coordinate"), {}),
    (r"mass_integrals/displacement_\w\w", ("coordinate", "coordinate_2"), {}),
    (r"mass_integrals/displacement", ("xyz", "coordinate"), {}),
    (r"mass_integrals/position_displacement", ("xyz_xyz", "coordinate"), {}),
    (r"stiffening/(omega|alpha|acceleration)_\w+", ("coordinate", "coordinate_2"), {}),
]
_OF_MODAL: _Rows = [
    (r"picture/displacements", ("point_component", "mode"), {"mode": "/modes/frequencies"}),
    (r"resultants/[^/]+/modes", ("point_kind", "mode"), {"mode": "/modes/frequencies"}),
    (r"mass_integrals/displacement_\w\w", ("mode", "mode_2"), {}),
    (r"mass_integrals/displacement", ("xyz", "mode"), {"mode": "/modes/frequencies"}),
    (r"mass_integrals/position_displacement", ("xyz_xyz", "mode"), {"mode": "/modes/frequencies"}),
    (r"stiffening/(omega|alpha|acceleration)_\w+", ("mode", "mode_2"), {}),
]
_OF_SOUND: _Rows = [
    (r"circumferential_harmonics", ("harmonic",), {}),
    (r"tones/.*/nodes", ("node", "rz"), {}),
    (r"tones/.*/triangles", ("triangle", "corner"), {}),
    (r"tones/.*/(co)?sine_(re|im)", ("node",), {}),
    (r"microphones/names", ("microphone",), {}),
    (r"microphones/positions", ("microphone", "xyz"), {"microphone": "names"}),
    (r"microphones/pressure_(re|im)", ("microphone", "tone"), {"microphone": "names"}),
    (r"microphones/levels", ("microphone", "level"), {"microphone": "names"}),
    (r"microphones/around_axis", ("microphone", "extreme"), {"microphone": "names"}),
    (r"directivity/polar", ("polar",), {}),
    (r"directivity/azimuth", ("azimuth",), {}),
    (r"directivity/rms", ("polar", "azimuth"), {"polar": "polar", "azimuth": "azimuth"}),
    (r"radiation/mode_numbers", ("mode",), {}),
    (r"radiation/\w+", ("mode",), {"mode": "mode_numbers"}),
    (r"notes", ("note",), {}),
    (r"loudness/\w+/levels", ("speed", "microphone"), {"speed": "speeds"}),
    (r"loudness/\w+/\w+", ("speed",), {"speed": "speeds"}),
]
_OF_RADIATION: _Rows = [(r"\w+", ("mode",), {"mode": "mode_numbers"})]
_OF_RESPONSES: _Rows = [
    (r"frequencies", ("frequency",), {}),
    (r"loads/positions", ("load", "xyz"), {"load": "names"}),
    (r"loads/\w+", ("load",), {}),
    (r"outputs/positions", ("output", "xyz"), {"output": "names"}),
    (r"outputs/\w+", ("output",), {}),
    (r"responses/[^/]+/H_(re|im)", ("frequency", "output"), {"frequency": "/frequencies", "output": "/outputs/names"}),
    (r"measured/H_(re|im)", ("frequency", "measured"), {"frequency": "/frequencies"}),
    (r"measured/(names|lines|loads|outputs|assurance)", ("measured",), {}),
    (r"section_force_names", ("section",), {}),
    (r"section_forces/[^/]+/(kinds|units)", ("kind",), {}),
    (r"section_forces/[^/]+/elements", ("point",), {}),
    (r"section_forces/[^/]+/positions", ("point", "xyz"), {"point": "elements"}),
    (r"section_forces/[^/]+/axes", ("point", "axis_component"), {"point": "elements"}),
    (r"section_forces/[^/]+/responses/[^/]+/r_(re|im)", ("frequency", "point_kind"), {"frequency": "/frequencies"}),
]
_AXES: dict[str, _Rows] = {
    "chladni-response": _OF_RESPONSES,
    "chladni-sound": _OF_SOUND,
    "chladni-radiation": _OF_RADIATION,
    "chladni-squeal": _OF_RESULTS,
    "chladni-body": _OF_MODAL + _OF_BODIES,
    "chladni-reduced": _OF_REDUCED + _OF_BODIES,
}


def axes_of(form: str, name: str, rank: int) -> tuple[tuple[str, ...], dict[str, str]]:
    """The names of the axes of a dataset, and for some of them the name of the dataset with their coordinates.

    >>> axes_of("chladni-squeal", "eigenvalues/lambda_re", 2)
    (('speed', 'eigenvalue'), {'speed': 'eigenvalues/speeds'})
    """
    for pattern, axes, coordinates in _AXES.get(form, ()):
        if len(axes) == rank and re.fullmatch(pattern, name):
            folder = name.rpartition("/")[0]
            beside = f"{folder}/" if folder else ""
            return axes, {a: at[1:] if at.startswith("/") else beside + at for a, at in coordinates.items()}
    return tuple(f"axis_{i}" for i in range(rank)), {}
