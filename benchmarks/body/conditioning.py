"""Bodies that ought to be hard, each solved with its loss of digits or refused with advice."""

import h5py
import numpy as np

from cases import ROOT, beam, only, run


def verdict(case, summary, value="", digits=None):
    """One row of the table of hard cases."""
    refused = isinstance(summary, str)
    return {"case": case, "outcome": "refused" if refused else "solved",
            "condition": None if refused else summary["condition_Q_dd"],
            "unit rows": None if refused else summary["condition_directions"], "value": value,
            "digits_lost": digits, "message": summary if refused else ""}


def lost(found, exact):
    """Of sixteen digits."""
    error = np.abs(np.array(found) / np.array(exact) - 1).max()
    return float(max(0.0, 16 + np.log10(max(error, 1e-16))))


def struck_out(path, held):
    """Frequencies in Hz of the reduced matrices without the rows and columns of the held (node, component)."""
    with h5py.File(path) as file:
        K, M = file["matrices/stiffness"][:], file["matrices/mass"][:]
        masters = list(zip(file["masters/node"][:], file["masters/component"][:]))
    kept = [i for i in range(len(K)) if i >= len(masters) or masters[i] not in held]
    s = 1 / np.sqrt(np.diag(M)[kept])
    L = np.linalg.inv(np.linalg.cholesky(s[:, None] * M[np.ix_(kept, kept)] * s))
    return np.sqrt(np.linalg.eigvalsh(L @ (s[:, None] * K[np.ix_(kept, kept)] * s) @ L.T)) / (2 * np.pi)


def conditioning(folder):
    rows = []
    first = run("run", folder / "L1", beam())["frequencies_Hz"][:5]
    for distance in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        # Two heights that come to mean one: Q_dd = [1, x_A; 1, x_D].
        made = run("run", folder / f"D{distance}", beam(body='fixed = ["A.z", "D.z"]\nkeep = { modes = 40 }', beside_A=distance))
        digits = None
        if not isinstance(made, str):
            exact = struck_out(only(folder / f"D{distance}", "*.reduced.h5"), [(0, 2), (3, 2)])
            digits = lost(made["frequencies_Hz"][:5], exact[:5])
        rows.append(verdict(f"supports {distance:g} of the length apart", made, digits=digits))
    for length in (1e-2, 1e-4, 1e-6, 1e-9, 1e-12):
        # Frequencies go with 1 / L^2, cond(Q_dd) with 1 / L.
        made = run("run", folder / f"L{length}", beam(length=length))
        digits = None if isinstance(made, str) else lost(np.array(made["frequencies_Hz"][:5]) * length**2, first)
        rows.append(verdict(f"clamped beam of length {length:g} m", made, digits=digits))
    text = beam()
    run("reduce", folder / "near", text)
    base = run("body", folder / "near", beam(body='fixed = ["A"]'))["frequencies_Hz"]
    omega_n = 2 * np.pi * base[7]
    for distance in (1e-2, 1e-6, 1e-10, 1e-14):
        body = 'fixed = ["A"]\nkeep = { modes = 5 }\ninterface_modes = [{ kind = "frm", at = "B", dofs = ["ry"], ' \
               f'omega0 = {omega_n * (1 + distance):.17g} }}]'
        made = run("body", folder / "near", beam(body=body))
        digits = None if isinstance(made, str) else lost(made["frequencies_Hz"][:5], base[:5])
        rows.append(verdict(f"FRM at a neglected frequency (1 + {distance:g})", made, digits=digits))
    disc = (ROOT / "tests/data/coarse_disc.toml").read_text().replace("nodes = 12", "nodes = 60")
    disc = disc[:disc.index("[body]")]
    run("reduce", folder / "disc", disc)
    for frequencies in ("", ", omega0 = 5000.0"):
        made = run("body", folder / "disc", disc + '[body]\nfixed = ["hub"]\nkeep = { modes = 20 }\n'
                   f'interface_modes = [{{ kind = "frm", at = "track", dofs = ["z"]{frequencies} }}]\n')
        value = "" if isinstance(made, str) else f"{made['interface_modes_dropped']} of 60 dropped"
        rows.append(verdict("60 FRMs on one ring" + frequencies, made, value))
    for fixed in ('"hub.x"', '"hub.x", "hub.y", "hub.z"', '"hub", "track"'):
        made = run("body", folder / "disc", disc + f"[body]\nfixed = [{fixed}]\nkeep = {{ modes = 20 }}\n")
        value = "" if isinstance(made, str) else f"{sum(f == 0 for f in made['frequencies_Hz'])} rigid motions left"
        rows.append(verdict(f"supports {fixed.replace(chr(34), '')}", made, value))
    return rows
