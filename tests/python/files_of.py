"""What tests ask of files."""

import chladni


def arrays_of(group, path=""):
    """Name and array of each dataset that is one."""
    for name, member in group.items():
        if isinstance(member, chladni.Group):
            yield from arrays_of(member, f"{path}{name}/")
        elif isinstance(member, chladni.Array):
            yield path + name, member
