"""The layout of the sources beyond what clang-format 14 keeps by itself.

usage: layout.py [--check] SOURCE...    mends them in place; --check names those that it would change

- A body of one line has no braces, and neither has a loop around it; a body that is wrapped has them, and an `if` around
  a macro of GoogleTest, which may hold an `else` of its own.
- An algorithm takes a range: std::ranges::sort(x), not std::sort(x.begin(), x.end()).
"""
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parents[2]
ALGORITHMS = ("adjacent_find|all_of|any_of|binary_search|copy|copy_if|count|count_if|fill|find|find_if|for_each|generate|"
              "is_sorted|lower_bound|max_element|min_element|minmax_element|none_of|replace|reverse|sort|stable_sort|"
              "transform|upper_bound")
PAIR = re.compile(rf"\bstd::({ALGORITHMS})\(\s*([\w.]+)\.begin\(\),\s*\2\.end\(\)")
MACRO = re.compile(r"\s+(?:EXPECT|ASSERT)_[A-Z_]+\(.*")
CONTROL = re.compile(r"\s*(?:for|if|while)\b.*\)$")


def formatted(texts, style, folder):
    """Texts by the paths of their sources, laid out; many at a time, since clang-format starts slowly."""
    copies = [folder / path.resolve().relative_to(ROOT) for path in texts]
    for copy, text in zip(copies, texts.values()):
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text, encoding="utf-8")
    n = os.cpu_count()
    with ThreadPoolExecutor(n) as pool:
        list(pool.map(lambda some: subprocess.run(["clang-format", "-i", f"--style=file:{style}", *some], check=True),
                      [some for some in (copies[i::n] for i in range(n)) if some]))
    return {path: copy.read_text(encoding="utf-8") for path, copy in zip(texts, copies)}


def indent(line):
    return len(line) - len(line.lstrip())


def braces_around_wrapped_bodies(text):
    lines = text.split("\n")
    for i in reversed(range(len(lines) - 1)):
        body = lines[i + 1]
        if not CONTROL.match(lines[i]) or lines[i].count("(") != lines[i].count(")") or CONTROL.match(body):
            continue
        end = i + 1
        while indent(lines[end]) > indent(lines[i]) and not lines[end].endswith((";", "{", "}")) and "//" not in lines[end]:
            end += 1
        if end == i + 1 or not lines[end].endswith(";") or indent(lines[end]) <= indent(body):
            continue
        if not re.match(r"\s*else\b", lines[end + 1]):
            lines[i] += " {"
            lines.insert(end + 1, "}")
    return "\n".join(lines)


def braces_around_macros(text):
    lines = text.split("\n")
    for i in reversed(range(len(lines) - 1)):
        condition = re.match(r"\s*if \(", lines[i]) and MACRO.search(lines[i])
        if condition:
            lines[i:i + 1] = [lines[i][:condition.start()], lines[i][condition.start():].lstrip()]
        elif not (re.match(r"\s*if \(", lines[i]) and CONTROL.match(lines[i].split("  //")[0]) and
                  MACRO.match(" " + lines[i + 1])):
            continue
        end = i + 1
        while not lines[end].split("  //")[0].endswith(";"):
            end += 1
        head, comment, note = lines[i].partition("  //")
        lines[i] = head + " {" + comment + note
        lines.insert(end + 1, "}")
    return "\n".join(lines)


def laid_out(texts):
    """What the texts of sources should be."""
    style = ROOT / ".clang-format"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        without_braces = folder / "without_braces"
        without_braces.write_text(style.read_text() + "RemoveBracesLLVM: true\n")
        wanted = {path: PAIR.sub(lambda m: f"std::ranges::{m[1]}({m[2]}", text) for path, text in texts.items()}
        wanted = formatted(formatted(wanted, without_braces, folder), style, folder)
        wanted = {path: braces_around_macros(braces_around_wrapped_bodies(text)) for path, text in wanted.items()}
        return formatted(wanted, style, folder)


def main(arguments):
    check = arguments[:1] == ["--check"]
    paths = [Path(name) for name in arguments[check:] if name.endswith((".cpp", ".hpp"))]
    texts = {path: path.read_text(encoding="utf-8") for path in paths}
    changed = {path: wanted for path, wanted in laid_out(texts).items() if wanted != texts[path]}
    for path, wanted in changed.items():
        if check:
            print(f"{path}: ./dev format changes its layout")
        else:
            path.write_text(wanted, encoding="utf-8")
    return check and bool(changed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
