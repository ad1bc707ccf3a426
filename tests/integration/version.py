"""CMakeLists.txt, CITATION.cff and the newest release of CHANGELOG.md have one version. Usage: version.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

WHERE = {"CMakeLists.txt": r"^project\(chladni VERSION ([\d.]+)", "CITATION.cff": r"^version: ([\d.]+)$", "CHANGELOG.md": r"^## (\d[\d.]+), "}

if __name__ == "__main__":
    root = Path(sys.argv[1])
    found = {name: re.search(pattern, (root / name).read_text(), re.M)[1] for name, pattern in WHERE.items()}
    date = re.search(r"^date-released: (\S+)$", (root / "CITATION.cff").read_text(), re.M)[1]
    print(", ".join(f"{name}: {version}" for name, version in found.items()))
    if len(set(found.values())) != 1:
        sys.exit("FAILED: the versions differ")
    if f"## {found['CHANGELOG.md']}, {date}" not in (root / "CHANGELOG.md").read_text():
        sys.exit("FAILED: CITATION.cff and CHANGELOG.md have different dates")
