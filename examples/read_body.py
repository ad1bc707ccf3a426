"""Reads a modal body with h5py alone: its mass, its modes, its contact rings. Usage: read_body.py NAME.body.h5"""
import sys
import h5py
import numpy as np

with h5py.File(sys.argv[1]) as body:
    print(f"{body.attrs['title'].decode()}: {body['rigid_body/mass'][()]:.4g} kg")
    f_Hz = body["modes/frequencies"][:] / (2 * np.pi)
    # Rows: three displacements and three rotations of each node in turn.
    modes = body["modes/attachment_displacements"][:].reshape(-1, 6, f_Hz.size)
    loudest = body["attachment/node_numbers"][:][np.linalg.norm(modes[:, :3], axis=1).argmax(axis=0)]
    for mode in zip(range(1, f_Hz.size + 1), f_Hz, body["modes/kinds"].asstr()[:], loudest):
        print("mode {}: {:10.2f} Hz  {:<12} moves node {} most".format(*mode))
    for name in body["ring_names"].asstr():
        ring = body[f"rings/{name}"]
        amplitude = np.hypot(ring["displacement_cosine"][:], ring["displacement_sine"][:])
        print(f"ring {name}, radius {ring['radius'][()]:.4g} m, nodal diameters of its modes:")
        print(" ".join(str(n) for n in amplitude.argmax(axis=0)))
