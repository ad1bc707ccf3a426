"""The layout of the sources beyond what clang-format 14 keeps by itself.

usage: layout.py [--check] SOURCE...    mends them in place; --check names those that it would change

- A body of one line has no braces, and neither has a loop around it; a body that is wrapped has them, and an `if` around
  a macro of GoogleTest, which may hold an `else` of its own.
- An algorithm takes a range: std::ranges::sort(x), not std::sort(x.begin(), x.end()).
"""
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


def formatted(text, path, style):
    command = ["clang-format", f"--style=file:{style}", f"--assume-filename={path}"]
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


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


def laid_out(path, without_braces):
    """The text of a source and what it should be."""
    text = path.read_text(encoding="utf-8")
    ranged = PAIR.sub(lambda m: f"std::ranges::{m[1]}({m[2]}", text)
    bare = formatted(formatted(ranged, path, without_braces), path, ROOT / ".clang-format")
    return text, formatted(braces_around_macros(braces_around_wrapped_bodies(bare)), path, ROOT / ".clang-format")


def main(arguments):
    check = arguments[:1] == ["--check"]
    paths = [Path(name) for name in arguments[check:] if name.endswith((".cpp", ".hpp"))]
    with tempfile.NamedTemporaryFile("w", suffix=".clang-format") as style, ThreadPoolExecutor() as pool:
        style.write((ROOT / ".clang-format").read_text() + "RemoveBracesLLVM: true\n")
        style.flush()
        texts = list(pool.map(lambda path: laid_out(path, style.name), paths))
    changed = [(path, wanted) for path, (text, wanted) in zip(paths, texts) if text != wanted]
    for path, wanted in changed:
        if check:
            print(f"{path}: ./dev format changes its layout")
        else:
            path.write_text(wanted, encoding="utf-8")
    return check and bool(changed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
