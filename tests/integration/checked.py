"""What `chladni check` says of all files that a run has left."""

import json
import tempfile
from pathlib import Path

from running import start


def failed_checks(programs, folder):
    """One line for each check that fails, of each reduced system and body below `folder`; prints those that warn."""
    files = sorted(path for kind in ("reduced", "body") for path in Path(folder).rglob(f"*.{kind}.h5"))
    if not files:
        yield f"{folder}: nothing to check"
    with tempfile.TemporaryDirectory() as name:
        table = Path(name) / "check.json"
        for file in files:
            run = start(programs / "chladni", "check", file, "--json", table)
            if not table.exists():
                yield f"check of {file.name}: {run.stderr.strip()}"
                continue
            found = json.loads(table.read_text())
            table.unlink()
            print(f"{found['verdict']:8}{file.relative_to(folder)}")
            for check in found["checks"]:
                if check["verdict"] == "pass":
                    continue
                line = f"{check['check']} of {file.name}: {check['value']} (limit {check['limit']})"
                print(f"{check['verdict']:8}{line}")
                if check["verdict"] == "FAIL":
                    yield line
