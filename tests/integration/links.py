"""Every relative link of the README files, of CHANGELOG.md, CONTRIBUTING.md and of docs/ leads to a file or folder that is
there, and every anchor to a heading. Every path `docs/...` that a source names is there too, and every page is
in the navigation of mkdocs.yml; pages of results and decisions have an index of their own. Usage: links.py SOURCE_DIR
"""

import re
import subprocess
import sys
from pathlib import Path

FENCE = re.compile(r"^( *)(```|~~~).*?^\1\2 *$", re.M | re.S)
CODE = re.compile(r"`[^`\n]*`")
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)(?: \"[^\"]*\")?\)")
HEADING = re.compile(r"^#{1,6} +(.*?) *#*$", re.M)
EXTERNAL = re.compile(r"[a-z]+:")
NAMED = re.compile(r"(?<![\w/.-])docs/[\w/.-]*\w")


def tracked(root):
    """What belongs to the sources: the files that git would commit; without git all of them."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard"], capture_output=True, text=True)
    names = listed.stdout.splitlines() if listed.returncode == 0 else (
        str(path.relative_to(root)) for path in root.rglob("*") if not {"build", "out", ".git"} & set(path.relative_to(root).parts))  # fmt: skip
    return [root / name for name in names if (root / name).is_file()]


def slug(heading):
    """The anchor that web pages of git servers and mkdocs.yml give a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors(page):
    """Of all headings of a page; a second one of the same words gets a number."""
    seen, found = {}, set()
    for heading in HEADING.findall(FENCE.sub("", page.read_text())):
        name = slug(heading)
        found.add(name if name not in seen else f"{name}-{seen[name]}")
        seen[name] = seen.get(name, 0) + 1
    return found


def broken_links(page, root):
    """The links of one page that lead nowhere."""
    for target in LINK.findall(CODE.sub("", FENCE.sub("", page.read_text()))):
        if EXTERNAL.match(target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists() or root not in (file, *file.parents):
            yield f"{page.relative_to(root)}: {target} is not there"
        elif anchor and (file.suffix != ".md" or anchor not in anchors(file)):
            yield f"{page.relative_to(root)}: {target}: no heading has this anchor"


def broken_names(file, root):
    """The paths `docs/...` in a source or a text that lead nowhere."""
    try:
        text = file.read_text()
    except UnicodeDecodeError:
        return
    for name in sorted(set(NAMED.findall(text))):
        if not (root / name).exists():
            yield f"{file.relative_to(root)} names {name}, which is not there"


def unlisted(root):
    """The pages of docs/ that the navigation of the site lacks."""
    navigation = (root / "mkdocs.yml").read_text()
    for page in sorted((root / "docs").rglob("*.md")):
        name = page.relative_to(root / "docs").as_posix()
        if not name.startswith(("results/", "explanation/decisions/")) and f": {name}\n" not in navigation:
            yield f"docs/{name} is not in mkdocs.yml"


def main(root):
    files = tracked(root)
    pages = [file for file in files if file.suffix == ".md" and "tests" not in file.relative_to(root).parts]
    found = [line for page in pages for line in broken_links(page, root)]
    found += [line for file in files if file.suffix not in (".json", ".svg") for line in broken_names(file, root)]
    found += unlisted(root)
    print("\n".join(found) or f"the links of {len(pages)} pages and all paths in docs/ that sources name lead somewhere")
    sys.exit(bool(found))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
