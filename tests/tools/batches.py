"""Which sources can be read together, as one file that includes them.

usage: batches.py SOURCE...    prints a line for each batch

Headers of Eigen take most of the time of a reader, and a batch reads them once. Sources whose unnamed
namespaces share a name, or that open different namespaces, cannot be in one batch. Of those that
fill in templates for others a batch has one: they take long without any header.
"""
import pathlib
import re
import sys

MOST = 12
HIDDEN = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.S | re.M)
TYPE = re.compile(r"(?:struct|class|enum class|enum) (\w+)")
ALIAS = re.compile(r"using (\w+) = (.*);")
OPENED = re.compile(r"^using namespace ([\w:]+);", re.M)
USING = re.compile(r"^using (\w+::[\w:, ]+);", re.M)
CONSTANT = re.compile(r"(?<![.\w])(\w+)(?: = |\{|\[)")  # not a member that is set
FILLED = re.compile(r"^template class ", re.M)
MAIN = re.compile(r"^int main\(", re.M)
FUNCTION = re.compile(r"[\w:<>,&* ]*?\b(\w+)\(")


def hidden_names(path):
    """{name: what it is} of what a file declares for itself; equal aliases may stand in two files."""
    whole = pathlib.Path(path).read_text(encoding="utf-8")
    names = {what.split("::")[-1]: what for used in USING.findall(whole) for what in used.split(", ")}
    if OPENED.search(whole):
        names["using namespace"] = " ".join(OPENED.findall(whole))
    if MAIN.search(whole):
        names["main"] = path
    if FILLED.search(whole):
        names["template class"] = path
    for text in HIDDEN.findall(whole):
        for line in text.splitlines():
            if not line or line[0] in " }/#{" or line.startswith(("TEST", "INSTANTIATE", "template")):
                continue
            alias, kind = ALIAS.match(line), TYPE.match(line)
            if alias:
                names[alias[1]] = alias[2]
            elif kind:
                names[kind[1]] = path
            elif line.startswith(("constexpr ", "const ")) and CONSTANT.search(line.split("(")[0]):
                names.update((name, path) for name in CONSTANT.findall(line))
            elif FUNCTION.match(line):
                names[FUNCTION.match(line)[1]] = path
    return names


def batches(paths, key=lambda path: None, most=MOST):
    """Lists of paths of one key and without names that mean two things."""
    made = []
    for path in paths:
        names = hidden_names(path)
        for batch in made:
            if (batch["key"] == key(path) and len(batch["paths"]) < most
                    and all(batch["names"].get(name, what) == what for name, what in names.items())):
                batch["paths"].append(path)
                batch["names"].update(names)
                break
        else:
            made.append({"key": key(path), "paths": [path], "names": names})
    return [batch["paths"] for batch in made]


if __name__ == "__main__":
    for batch in batches(sys.argv[1:]):
        print(*batch)
