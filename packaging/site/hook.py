"""What mkdocs needs to make a site of docs/ as it stands on a git server.

Files outside docs/ that a page links to (examples, READMEs of folders, CHANGELOG.md) become part of the site under source/,
and links lead there. Markdown of git servers becomes that of mkdocs: names beside the language of a block of code, lists that
are indented by two columns, tables and lists that follow a line of text.
"""

import os
import posixpath
import re
import shutil
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
DOCS, STAGE, API = ROOT / "docs", ROOT / "build/docs_source", ROOT / "build/api_html"
LINK = re.compile(r"(\]\()([^()\s]+)(\))")
FENCE = re.compile(r"^( *)(?:```|~~~)(\w*) ?(\S*)")
ITEM = re.compile(r"^( *)([-*]|\d+\.) +")


def slug(heading, separator):
    """The anchor of a heading, as git servers make it and tests/integration/links.py checks it."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)


def on_config(config):
    config["mdx_configs"]["toc"]["slugify"] = slug
    return config


def is_relative(target):
    return not re.match(r"[a-z]+:|#|/", target)


def meant(page, target):
    """The file of the project that a link of a page leads to: of a folder its README.md, or the list of its files."""
    path = Path(os.path.normpath(page.parent / target.partition("#")[0]))
    return path / "README.md" if path.is_dir() and (path / "README.md").is_file() else path


def uri(path):
    """Where a file stands in the site."""
    if DOCS in path.parents:
        return path.relative_to(DOCS).as_posix()
    name = path.relative_to(ROOT).as_posix()
    return f"source/{name}/README.md" if path.is_dir() else f"source/{name}"


def path_of(address):
    return ROOT / address.removeprefix("source/") if address.startswith("source/") else DOCS / address


def linked(page):
    return {meant(page, target) for _, target, _ in LINK.findall(page.read_text()) if is_relative(target)}


def stage(path):
    """A copy of a file outside docs/, or the list of a folder's files."""
    copy = STAGE / uri(path)
    copy.parent.mkdir(parents=True, exist_ok=True)
    if path.is_dir():
        names = sorted(file.name for file in path.iterdir() if file.is_file())
        copy.write_text("\n".join([f"# {path.relative_to(ROOT)}", "", *(f"- [{name}]({name})" for name in names), ""]))
        return {path / name for name in names}
    shutil.copyfile(path, copy)
    return linked(path) if path.suffix == ".md" else set()


def on_files(files, config):
    """The files of docs/, and those outside that they lead to."""
    shutil.rmtree(STAGE, ignore_errors=True)
    waiting = set().union(*(linked(Path(file.abs_src_path)) for file in files if file.is_documentation_page()))
    staged = set()
    while waiting:
        path = waiting.pop()
        if path in staged or DOCS in path.parents or path == DOCS or not path.exists():
            continue
        staged.add(path)
        waiting |= stage(path)
        files.append(File(uri(path), str(STAGE), config["site_dir"], config["use_directory_urls"]))
    return files


def relinked(text, page):
    def link(match):
        target = match[2]
        if not is_relative(target):
            return match[0]
        anchor = target.partition("#")[2]
        new = posixpath.relpath(uri(meant(path_of(page), target)), posixpath.dirname(page) or ".")
        return f"{match[1]}{new}{'#' + anchor if anchor else ''}{match[3]}"

    return LINK.sub(link, text)


def indented(text):
    """Contents of lists four columns to the right of their marks; blank lines before lists and tables."""
    lines, columns, fenced, before = [], [], None, ""
    for line in text.splitlines():
        width = len(line) - len(line.lstrip())
        if line.strip() and fenced is None:
            while columns and width < columns[-1]:
                columns.pop()
        shift = " " * (4 * len(columns) - (columns[-1] if columns else 0)) if line.strip() else ""
        fence = FENCE.match(line)
        if fence and fenced is None:
            fenced = fence[1]
            if fence[3] and fence[3] != "fails":
                lines += [f"{shift}{fence[1]}`{fence[3]}`", ""]
            line = f"{fence[1]}```{fence[2]}"
        elif fence and fenced == fence[1]:
            fenced = None
        elif fenced is None:
            item = ITEM.match(line)
            if (item or line.startswith("|")) and before.strip() and before[0] not in " -*|1":
                lines.append("")
            if item:
                columns.append(item.end())
        lines.append(shift + line)
        before = line
    return "\n".join(lines)


def on_page_markdown(markdown, page, config, files):
    text = indented(relinked(markdown, page.file.src_uri))
    if page.file.src_uri == "reference/c_and_cpp.md" and API.is_dir():
        text = text.replace("`build/docs/api/index.html`", '<a href="../api/index.html"><code>build/docs/api/index.html</code></a>')
    return text


def on_post_build(config):
    """The reference of Doxygen, if it was made, becomes part of the site."""
    if API.is_dir():
        shutil.copytree(API, Path(config["site_dir"]) / "api", dirs_exist_ok=True)
