"""Fails when a program shows a library functions of Eigen, of which the library may have its own.

Usage: hides_symbols.py PROGRAM...
"""

import subprocess
import sys

for program in sys.argv[1:]:
    shown = subprocess.run(["nm", "--dynamic", "--demangle", program], capture_output=True, text=True, check=True).stdout
    if "H5Fopen" not in shown:
        sys.exit(f"nm shows nothing that {program} needs, so it has not seen the program at all")
    defined = [line for line in shown.splitlines() if "Eigen::" in line and " U " not in line]
    if defined:
        sys.exit(f"{program} shows {len(defined)} functions of Eigen, among them\n{defined[0]}")
    print(f"{program} shows nothing of Eigen")
