"""Plants small faults in the sources of libraries and asks whether their unit tests see them.

usage: mutants.py BUILD PAGE.md NUMBER [ROOM...]
       mutants.py BUILD PAGE.md again

So many faults are drawn from the tables below, with the number of commits as seed, from the sources of the rooms (of all that
have a library and a unit test). Those of one library are compiled together: each waits behind CHLADNI_MUTANT, so that `a < b`
becomes `mutants::is(17) ? a <= b : a < b`. What cannot be written so is compiled by itself. A first run of the tests, with no
fault, notes which test reaches which of them and how long it takes. A fault is tried by the tests that reach it, the shortest
first, until one fails, hangs or dies; what survives on one rank is tried on several, as in the gate. PAGE.md gets a table by
room and all survivors with file and line; `again` tries what has survived the last run by the tests as they are
by now, with the objects that the run has left, and makes the page anew.

Debian 12 and 13 package no such tool for C++: Mull, Dextool, universalmutator and Milu were looked for, and a search for
"mutation" finds genetics, permutations and JavaScript alone.
"""
import dataclasses
import json
import os
import pathlib
import random
import re
import resource
import shlex
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Libraries of a room, and its unit tests.
ROOMS = {
    "linear/dense": (["dense", "products"], ["dense_test"]),
    "linear": (["linear"], ["supernodal_test", "linear_test", "reduce_test"]),
    "reduce": (["reduce"], ["reduce_test"]),
    "reduce/cyclic": (["cyclic"], ["cyclic_test"]),
    "mesh": (["mesh"], ["mesh_test"]),
    "plate/elements": (["elements"], ["elements_test"]),
    "plate": (["plate"], ["assemble_test", "obstacle_course_test"]),
    "files": (["files"], ["files_test"]),
    "mbs_export": (["mbs_export"], ["mbs_export_test"]),
    "fmu": (["fmu"], ["fmu_test"]),
    "scene": (["scene"], ["scene_test"]),
    "sound": (["sound"], ["sound_test"]),
    "squeal": (["squeal_brake", "squeal"], ["assembly_test", "sweep_test", "squeal_test"]),
}  # fmt: skip

# On how many ranks the gate runs a program at most.
ON_RANKS = {"linear_test": 3, "reduce_test": 2, "assemble_test": 3}

# Faults that change nothing that a test may ask for: file, the line as it is, what becomes of it (None: whatever), and why that
# is equivalent.
EQUIVALENT = [
    ("plate/elements/shell_element.cpp", "const double c = order == 2 ? 0.5 : 0.1;", "const double c = order == 2 ? 0.5 : 0.2;",
     "how much of a thick element is integrated less; elements with either number have the same order of convergence"),
    *(("plate/elements/beam_element.cpp", "const VectorXd nodes = VectorXd::LinSpaced(n, -1.0, 1.0);", after,
       "an affine change of the parameter of a line, whose tangents keep their directions")
      for after in ("const VectorXd nodes = VectorXd::LinSpaced(n, -2.0, 1.0);", "const VectorXd nodes = VectorXd::LinSpaced(n, -1.0, 2.0);")),
    ("mbs_export/modal_body.cpp", "return ring.radius > 0.0 ? std::optional(ring) : std::nullopt;",
     "return (ring.radius >= 0.0) ? std::optional(ring) : std::nullopt;", "nodes on the axis all have the angle 0, which is refused before"),
    ("mbs_export/response_error.cpp", "(omega.array() > 0.0).select(omega.array().max(1e-300).square().inverse(), 0.0);", None,
     "no frequency is as low: it keeps a value from being infinite that is not taken"),
    ("common/files/hdf5.cpp", "const Eigen::Index most = std::max<Eigen::Index>(1, piece / std::max<Eigen::Index>(1, x.cols()));", None,
     "how many rows are written at a time; the file is the same"),
    ("linear/dense/dense_solvers.cpp", "const Eigen::VectorXd s = std::min(A.rows(), A.cols()) <= few", None,
     "two algorithms for the same values; which one is faster"),
    ("mbs_export/formats/nastran.cpp", "if (!A.allFinite() || A.cwiseAbs().maxCoeff() > 1e99)",
     "if (!A.allFinite() || (A.cwiseAbs().maxCoeff() >= 1e99))", "no entry is the limit itself"),
    ("mbs_export/check_body.cpp", 'checks.push_back({"their stiffness", stiffness > 1e-12 ? Verdict::pass : Verdict::fail, stiffness,',
     'checks.push_back({"their stiffness", (stiffness >= 1e-12) ? Verdict::pass : Verdict::fail, stiffness,', "no stiffness is the limit itself"),
    ("mbs_export/select_by_tolerance.cpp", "if (norm <= largest_norm) continue;", "if ((norm < largest_norm)) continue;",
     "of two groups that lack as much either may be first"),
    ("linear/lanczos/block_iteration.cpp", "if (was_found) forgotten_from_ = std::min(forgotten_from_, n);",
     "if (true || (was_found)) forgotten_from_ = std::min(forgotten_from_, n);", "copies are looked for once more; the pairs are the same"),
    ("reduce/supported_solutions.cpp", "pairs.lambda.resize(options.n_modes);", "nothing", "block Lanczos gives no more than it is asked for"),
    ("reduce/cyclic/harmonic_coordinates.cpp", "if (column.norm() > dependent) B.col(found++) = column.normalized();",
     "if ((column.norm() >= dependent)) B.col(found++) = column.normalized();", "no length is the limit itself"),
    ("plate/elements/shell_strains.cpp", "if (parts == StrainParts::all) {", "if (true || (parts == StrainParts::all)) {",
     "zeros where nobody reads: parts that were not asked for"),
    ("plate/assembly/inertia_integrals.cpp", "constexpr double round_off = 1e-14;", "constexpr double round_off = 1e-11;",
     "what moves together couples by more than either of the two, what does not by less"),
    ("plate/dofs/dof_map.cpp", "return (E.array().abs() < 1e-14).select(0.0, E);", "return (E.array().abs() < 1e-11).select(0.0, E);",
     "a component of a direction that is no round-off is larger than either of the two"),
    ("plate/refinement/refined_mesh.cpp", "if (share > near_middle) return middle;", "if ((share >= near_middle)) return middle;",
     "no share is the limit itself"),
    ("plate/assembly/geometric_stiffness.cpp", "if (offsets.size() == 0 && std::ranges::none_of(nodes, follows)) return;",
     "if (false && (offsets.size() == 0 && std::ranges::none_of(nodes, follows))) return;", "arms of no length add nothing; it saves work"),
    ("linear/dense/real_eigenvalues.cpp", "Reflection to{n, {1.0, 0.0, 0.0}, 0.0, 0.0};", None, "a reflection whose beta is zero is none"),
    ("linear/cholesky/elimination_order.cpp", "return std::ranges::max(degrees) <= dense;", "return (std::ranges::max(degrees) < dense);",
     "no degree is the limit itself"),
    ("linear/lanczos/block_iteration.cpp", "append_random(block_size_ - basis_.n_columns(), op);", None, "the basis is empty there"),
    ("linear/cholesky/factorization.cpp", "if (stiffness < softest.stiffness) softest = {.stiffness = stiffness, .row = j};",
     "if ((stiffness <= softest.stiffness)) softest = {.stiffness = stiffness, .row = j};", "of two that are as soft either may be told"),
    ("linear/cholesky/mumps_factor.cpp", "return static_cast<PetscInt>(std::max<std::int64_t>(largest_count / rows, 1));", None,
     "how many columns are solved at a time; the solutions are the same"),
    ("linear/lanczos/parted_lanczos.cpp", "parts_.front().most = std::min(most, parts_.front().n_rows);", None,
     "no part has more pairs than rows, and none is asked for more than there are"),
    ("linear/blas_memory.cpp", "const double factor = 1.0;", None, "what is multiplied is zero"),
    ("linear/lanczos/parted_lanczos.cpp", "const double middle = 0.5 * (low + high);", None, "where the next look is; the pairs are the same"),
    ("linear/lanczos/block_lanczos.cpp", "unresolved_from_ = theta > nothing * largest ? 1.0 / theta : all_of_them;", None,
     "no theta is the limit itself"),
    ("linear/lanczos/block_lanczos.cpp", "next_look_ = n + lacking(n, excess(pairs, std::min(n_pairs, n), options_.tolerance));", None,
     "when the next look is; the pairs are the same"),
    ("linear/kernels/component_forms.cpp", "const petsc::Matrix Y = uninitialized_dense(A_rc, last - first);", None,
     "columns that nobody reads"),
    ("linear/lanczos/block_basis.cpp", "if (capacity <= capacity_) return;", "if ((capacity < capacity_)) return;",
     "memory of the size that is there is taken anew"),
    ("linear/cholesky/sylvester.cpp", "if (is_given(name)) return true;", None, "two solvers count the same"),
    ("reduce/reduction.cpp", "if (are_ordered) linear::keep_order(K.ss, std::move(order));", None, "an order of no row is none"),
    ("reduce/supported_solutions.cpp", "if (mu != 0.0) A = linear::shifted(A, M_ff, -mu);", "if (true || (mu != 0.0)) A = linear::shifted(A, M_ff, -mu);",
     "a shift by zero changes nothing"),
    ("reduce/harmonic_response.cpp", "if (loaded[j] < first || loaded[j] >= last) continue;", "if (loaded[j] < first || (loaded[j] > last)) continue;",
     "an entry that two ranks insert is the same"),
    ("mesh/decks/deck.cpp", "if (!options.matrices) raise_linear_solids(deck);", None, "of a mesh with matrices the corners alone are taken"),
    ("mesh/decks/nastran_cards.cpp", 'const std::string mark = line.size() > behind ? capitals(line.substr(behind, small)) : "";', None,
     "nothing stands behind the end of a line"),
    ("mesh/sectors.cpp", "tried, [&](double other) { return std::abs(std::remainder(other - plane, half)) < 1e-9; });", None,
     "no distance is the limit itself"),
    ("plate/elements/beam_element.cpp", "const VectorXd nodes = VectorXd::LinSpaced(n, -1.0, 1.0);", "const VectorXd nodes = VectorXd::LinSpaced(n, -0.5, 1.0);",
     "an affine change of the parameter of a line, whose tangents keep their directions"),
    ("plate/dofs/couplings.cpp", "ranks[reference] = std::min(ranks[reference], owners[node]);", None, "which of the ranks has the reference node"),
    ("squeal/motion/dormand_prince.cpp", "constexpr double safety = 0.9, shrink_max = 0.2, grow_max = 6.0;", None,
     "how fast steps grow; each of them keeps the tolerance"),
    ("squeal/brake/disc.cpp", "(alternating[i] > whole[i] ? alternates : moves)[std::size_t(i)] = 1;", None, "no two parts are the same"),
    *(("reduce/craig_bampton.cpp", "constexpr double suspicious = 1e-10, round_off = 64.0 * std::numeric_limits<double>::epsilon();",
       f"constexpr double suspicious = 1e-10, round_off = {factor} * std::numeric_limits<double>::epsilon();",
       "each is above the rounding of the sum of a row and four decades below what is a mass") for factor in ("32.0", "128.0")),
    ("mesh/sectors.cpp", "common = std::gcd(common, n_off_axis);", "nothing",
     "more numbers of copies are tried; those that do not divide the nodes do not take the mesh to itself"),
    ("reduce/supported_solutions.cpp", "if (guess == most_guesses) return shift;", "if ((guess != most_guesses)) return shift;",
     "another shift: its rounding stays below that of K, and block Lanczos takes more steps to the same pairs"),
    ("plate/elements/assumed_strains.cpp", "constexpr double near = 1.0 / 6.0, far = 4.0 / 6.0;",
     "constexpr double near = 0.5 / 6.0, far = 4.0 / 6.0;",
     "three other points inside tie the shear as well: a thin element is the same to 1e-9, whichever corner is first"),
    ("mesh/sweep.cpp", "const auto same = [&](double b) { return std::abs(b - x) < 1e-9 * size; };",
     f"const auto same = [&](double b) {{ return std::abs(b - x) < {1e-9 * 1e-3!r} * size; }};",
     "places differ by the rounding of a few sums, or by more than either"),
    ("mesh/quality.cpp", "area += (o.high[0] - o.low[0]) * (o.high[1] - o.low[1]) / double(outlines.size());", None,
     "how wide the squares are by which outlines are looked up; the overlaps are the same"),
    ("mesh/exchange/unv.cpp", "const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);", None,
     "a number ends with its digits; that the text ends there is asked behind"),
    ("reduce/error_estimates.cpp", "if (std::ssize(group) < few)", None, "which pairs are worked on together; their errors are the same"),
    ("squeal/motion/generalised_alpha.cpp", "constexpr double contraction = 0.2;", None,
     "when the tangent is made anew; each step is iterated to the same remaining error"),
    ("squeal/cycle/limit_cycle_direct.cpp", "constexpr double as_near = 2.0;", "constexpr double as_near = 4.0;",
     "from which return Newton's method starts; the cycle that it ends at is the same"),
    ("squeal/stability/near_groups.cpp", "return last * modes_->B.colwise().norm().maxCoeff() * std::min(1.0, share);",
     "return last * modes_->B.colwise().norm().maxCoeff() * std::max(1.0, share);",
     "an estimate above the tolerance asks for more harmonics; what it ends at keeps the tolerance either way"),
]  # fmt: skip

RELATIONS = {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
             "&&": ("||",), "||": ("&&",)}  # fmt: skip
SIGNS = ("+", "-", "+=", "-=")
EXTREMES = {"max": "min", "min": "max"}
# What a line must not have: it is no code that runs, or says only what is said or how fast.
LEFT_OUT = re.compile(r"^\s*(#|//|template|using|static_assert|assert\(|case |friend|namespace|throw )|fmt::format|report_progress"
                      r"|\.reserve\(|LogEvent|static constexpr|operator")  # fmt: skip

HEADER = """#pragma once
#include <sys/mman.h>
#include <cstdlib>
#include <string>
namespace mutants {
inline constexpr int most = 4096;
// Shared with the processes that a test forks.
inline bool* const reached =
    static_cast<bool*>(mmap(nullptr, most, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
inline int chosen()
{
  static const int number = [] {
    const char* text = std::getenv("CHLADNI_MUTANT");
    return text == nullptr ? -1 : std::atoi(text);
  }();
  return number;
}
inline bool is(int number)
{
  reached[number] = true;
  return number == chosen();
}
inline int sign(int number) { return is(number) ? -1 : 1; }
inline double value(int number, double right, double wrong) { return is(number) ? wrong : right; }
}  // namespace mutants
"""

# Appends `name milliseconds reached...` of each test to the file CHLADNI_REACHED, with -1 of one that fails; `suite. 0 reached...`
# of what runs before its first test, whose result all of them read, and `*. 0 reached...` of constants that are made before all.
LISTENER = """#include <gtest/gtest.h>
#include <cstdio>
#include "mutants.hpp"
namespace {
class Listener : public testing::EmptyTestEventListener {
  void OnTestProgramStart(const testing::UnitTest& /*all*/) override { note("*", "", 0); }
  void OnTestStart(const testing::TestInfo& test) override { note(test.test_suite_name(), "", 0); }
  void OnTestEnd(const testing::TestInfo& test) override
  {
    note(test.test_suite_name(), test.name(), test.result()->Failed() ? -1 : int(test.result()->elapsed_time()));
  }
  static void note(const char* suite, const char* name, int milliseconds)
  {
    const char* path = std::getenv("CHLADNI_REACHED");
    if (path == nullptr) return;
    std::FILE* file = std::fopen(path, "a");
    std::fprintf(file, "%s.%s %d", suite, name, milliseconds);
    for (int i = 0; i < mutants::most; ++i)
      if (mutants::reached[i]) std::fprintf(file, " %d", i);
    std::fprintf(file, "\\n");
    std::fclose(file);
    for (int i = 0; i < mutants::most; ++i) mutants::reached[i] = false;
  }
};
const bool is_added = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new Listener);
  return true;
}();
}  // namespace
"""


@dataclasses.dataclass
class Fault:
    """The text [first, last) of a file becomes `switched`, or `plain` where it stands by itself."""

    path: str
    first: int
    last: int
    kind: str
    switched: str
    plain: str
    line: int = 0
    before: str = ""
    after: str = ""
    number: int = -1
    by_itself: bool = False
    outcome: str = ""
    seen_by: str = ""


def masked(text):
    """The text with comments, strings and characters blank, at the same places."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])
    text = re.sub(r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', blank, text, flags=re.S)
    text = re.sub(r"^#el(?:if|se)\b.*?^#endif", blank, text, flags=re.S | re.M)  # of another machine
    return re.sub(r"throw Error\([^;]*;", blank, text)  # what is said


def code_spans(text):
    """For each character whether it lies in the body of a function."""
    inside, stack, depth = [], [], 0
    for i, c in enumerate(text):
        if c == "{":
            ahead = text[max(0, i - 400):i].rstrip()
            is_body = bool(re.search(r"(\)|\bconst|\bnoexcept|\boverride|\belse|\bdo|\btry|\]|->\s*[\w:<>,\s*&]+)$", ahead))
            is_type = bool(re.search(r"\b(namespace|struct|class|enum|union)\b[^;{}()]*$", ahead))
            stack.append((is_body or depth > 0) and not is_type)
            depth = sum(stack)
        elif c == "}" and stack:
            stack.pop()
            depth = sum(stack)
        inside.append(depth > 0)
    return inside


STOPS = {"&&", "||", "?", ":", "=", "return", "<<", "+=", "-=", "*=", "/="}


def operand(text, at, step, stops):
    """The end of the operand that begins beside an operator, in steps of -1 or 1."""
    depth, opening, closing = 0, ")]}" if step < 0 else "([{", "([{" if step < 0 else ")]}"
    i = at
    while 0 <= i < len(text):
        c = text[i]
        if c in opening:
            depth += 1
        elif c in closing:
            if depth == 0:
                break
            depth -= 1
        elif depth == 0:
            if c in ",;":
                break
            word = re.compile(r"\s(&&|\|\||\?|:|[+\-*/|]?=|<<|<=?|>=?|==|!=)\s").match(text, i - 1 if step > 0 else max(0, i - 3))
            if step > 0 and word and word[1] in stops and text[i - 1].isspace():
                i -= 1
                break
            if step < 0:
                ahead = re.search(r"(?:\s(&&|\|\||\?|:|[+\-*/|]?=|<<|<=?|>=?|==|!=)|\b(return))\s$", text[max(0, i - 7):i + 1])
                if ahead and (ahead[1] or ahead[2]) in stops:
                    break
        i += step
    return i + 1 if step < 0 else i


def closing(mask, at):
    """The place of the bracket that closes the one before `at`."""
    depth = 1
    while depth > 0 and at < len(mask):
        depth += (mask[at] in "([{") - (mask[at] in ")]}")
        at += 1
    return at - 1


def relations(path, text, mask):
    for match in re.finditer(r" (<=?|>=?|==|!=|&&|\|\|) ", mask):
        line = line_of(text, match.start())
        if re.match(r"\s*for \(", line) or "template" in line:
            continue
        op = match[1]
        logical = op in ("&&", "||")
        stops = STOPS if not logical else STOPS | {op}
        first, last = operand(mask, match.start(), -1, stops), operand(mask, match.end(), 1, stops)
        left, right = text[first:match.start()].strip(), text[match.end():last].strip()
        first += len(text[first:match.start()]) - len(text[first:match.start()].lstrip())
        last = match.end() + len(text[match.end():last].rstrip())
        if not left or not right or "[&" in left + right or "{" in left + right:
            continue
        for other in RELATIONS[op]:
            yield Fault(path, first, last, f"`{op}` to `{other}`",
                        f"(mutants::is(@) ? ({left} {other} {right}) : ({left} {op} {right}))", f"({left} {other} {right})")


def signs(path, text, mask):
    for match in re.finditer(r"(?<=[\w)\]]) ([+-]=?) (?=[\w(])", mask):
        op = match[1]
        if re.search(r"\bfor \(", line_of(text, match.start())):
            continue
        last = match.end()
        plain = {"+": " - ", "-": " + ", "+=": " -= ", "-=": " += "}[op]
        if len(op) == 2:
            end = mask.find(";", last)
            if end < 0 or "\n" in mask[last:end]:
                continue
            yield Fault(path, last, end, f"`{op}` to `{plain.strip()}`", f"mutants::sign(@) * ({text[last:end]})", "")
        else:
            yield Fault(path, match.start(), last, f"`{op}` to `{plain.strip()}`", f" {op} mutants::sign(@) * ", plain)


def constants(path, text, mask):
    for match in re.finditer(r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+)(?![\w.])", mask):
        number = float(match[1])
        if number == 0.0:
            continue
        others = [number * 2.0, number * 0.5] if "e" not in match[1] else [number * 1e3, number * 1e-3]
        for other in others:
            yield Fault(path, match.start(), match.end(), f"{match[1]} to {other:.3g}",
                        f"mutants::value(@, {match[1]}, {other!r})", repr(other))


STATEMENT = re.compile(r"^( +)(?!return\b|throw\b|const\b|auto\b|if\b|for\b|while\b|using\b|static\b|else\b|break\b|continue\b|case\b|delete\b)"
                       r"([\w:.\[\]*()&>-]+(?:\(.*\))?(?: [+\-*/|]?= .*)?);$")  # fmt: skip


def statements(path, text, mask):
    at = 0
    lines = mask.splitlines(keepends=True)
    for k, line in enumerate(lines):
        match = STATEMENT.match(line.rstrip("\n"))
        before = next((previous.rstrip() for previous in reversed(lines[:k]) if previous.strip()), "")
        if match and before.endswith((";", "{", "}", ")")) and ("(" in line or "=" in line) and "Restore" not in line:
            first, last = at + len(match[1]), at + len(line.rstrip("\n"))
            yield Fault(path, first, last, "statement dropped", f"{{ if (!mutants::is(@)) {text[first:last]} }}", "{}")
        at += len(line)


def guards(path, text, mask):
    for match in re.finditer(r"\bif \(", mask):
        last = closing(mask, match.end())
        condition = text[match.end():last]
        if ";" in condition or " = " in condition or "constexpr" in line_of(text, match.start()):
            continue
        yield Fault(path, match.end(), last, "guard removed", f"!mutants::is(@) && ({condition})", f"false && ({condition})")
        yield Fault(path, match.end(), last, "condition always true", f"mutants::is(@) || ({condition})",
                    f"true || ({condition})")  # fmt: skip


def extremes(path, text, mask):
    for match in re.finditer(r"std::(max|min)(<[\w:]+>)?\(", mask):
        last = closing(mask, match.end()) + 1
        right, rest = text[match.start():last], text[match.start() + 8:last]
        if right.count(",") == 0 or "{" in right:
            continue
        wrong = f"std::{EXTREMES[match[1]]}{rest}"
        yield Fault(path, match.start(), last, f"`{match[1]}` to `{EXTREMES[match[1]]}`",
                    f"(mutants::is(@) ? {wrong} : {right})", wrong)


KINDS = (relations, signs, constants, statements, guards, extremes)


def line_of(text, at):
    return text[text.rfind("\n", 0, at) + 1:text.find("\n", at)]


def faults_of(path):
    """[[Fault...] of each kind], each with its line as it is and as it becomes."""
    text = (ROOT / path).read_text(encoding="utf-8")
    mask = masked(text)
    inside = code_spans(mask)
    found = []
    for kind in KINDS:
        found.append([])
        for fault in kind(path, text, mask):
            line = line_of(text, fault.first)
            is_constant = line.lstrip().startswith("constexpr") and kind is constants
            if not (inside[fault.first] or is_constant) or LEFT_OUT.search(line) or ("constexpr" in line and not is_constant):
                continue
            fault.line = text.count("\n", 0, fault.first) + 1
            begin, end = text.rfind("\n", 0, fault.first) + 1, text.find("\n", fault.last)
            fault.before = " ".join(text[begin:end].split())
            plain = fault.plain or text[fault.first:fault.last]
            fault.after = " ".join((text[begin:fault.first] + plain + text[fault.last:end]).split())
            if kind is statements:
                fault.after = "nothing"
            if fault.kind in ("`+=` to `-=`", "`-=` to `+=`"):
                old, new = re.findall("`(.=)`", fault.kind)
                fault.after = fault.before.replace(old, new, 1)
            found[-1].append(fault)
    return found


def drawn(paths, number, generator):
    """So many faults, of no two in one line; the kinds as often as each other."""
    kinds = [[] for _ in KINDS]
    for path in paths:
        for kind, of_file in zip(kinds, faults_of(path)):
            kind.extend(of_file)
    chosen, taken = [], []
    while len(chosen) < number and any(kinds):
        kind = generator.choice([k for k in kinds if k])
        fault = kind.pop(generator.randrange(len(kind)))
        lines = range(fault.line, fault.line + 1 + fault.switched.count("\n"))
        if any(path == fault.path and (set(lines) & set(others)) for path, others in taken):
            continue
        taken.append((fault.path, lines))
        chosen.append(fault)
    return chosen


def planted(path, faults):
    """The source with these faults behind their switches."""
    text = (ROOT / path).read_text(encoding="utf-8")
    for fault in sorted(faults, key=lambda f: -f.first):
        switched = fault.switched.replace("@", str(fault.number))
        begin = text.rfind("\n", 0, fault.first) + 1
        text = text[:fault.first] + switched + text[fault.last:]
        if re.match(r"\s*constexpr ", text[begin:]):
            text = text[:begin] + text[begin:].replace("constexpr", "const", 1)
    return text


def plainly(path, fault):
    """The source with this fault alone, as an author would have made it."""
    text = (ROOT / path).read_text(encoding="utf-8")
    if not fault.plain:  # of `+=`
        begin = text.rfind("\n", 0, fault.first) + 1
        old, new = re.findall("`(.=)`", fault.kind)
        return text[:begin] + text[begin:].replace(old, new, 1)
    return text[:fault.first] + fault.plain + text[fault.last:]


INCLUDED = re.compile(r'#include "([^"]+)"')
UNITY = re.compile(r"/chladni_(\w+)\.dir/Unity/unity_\d+_cxx\.cxx$")


def sources_of(unity):
    """The sources that CMake compiles as one file."""
    return [pathlib.Path(path).relative_to(ROOT).as_posix() for path in INCLUDED.findall(unity.read_text(encoding="utf-8"))]


class Library:
    """The sources of a library that are compiled as one, with faults, and programs linked with them."""

    def __init__(self, build, scratch, libraries, programs):
        self.build, self.scratch, self.programs = build, scratch, programs
        programs_beside = scratch.parent / "libexec"  # where tests look for the mesher, from the folder that they lie in
        if not programs_beside.is_symlink():
            programs_beside.symlink_to("../libexec")
        subprocess.run(["ninja", "-C", str(build), *(f"tests/{p}" for p in programs)], stdout=subprocess.DEVNULL, check=True)
        listed = subprocess.run(["ninja", "-C", str(build), "-t", "commands", *(f"tests/{p}" for p in programs)],
                                stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()  # fmt: skip
        self.commands = {}
        for command in listed:
            of_library = UNITY.search(command)
            if of_library and of_library[1] in libraries:
                self.commands[pathlib.Path(shlex.split(command)[-1])] = command
        self.links = {p: next(c for c in listed if f" -o tests/{p} " in c) for p in programs}
        # The listener needs what a test is compiled with.
        self.of_test = next(c for c in listed if f"/{programs[0]}.dir/Unity/unity_0_cxx.cxx" in c and " -c " in c)

    def sources(self):
        return {unity: sources_of(unity) for unity in self.commands}

    def with_faults(self, unity, folder, name):
        """The object file with those sources that the folder has, or what the compiler says."""
        text = "".join(f'#include "{folder / path if (folder / path).is_file() else ROOT / path}"\n' for path in sources_of(unity))
        (folder / unity.name).write_text(text, encoding="utf-8")
        return self.compile(self.commands[unity], folder / unity.name, folder, name)

    def compile(self, command, source, folder, name):
        """The object file, or what the compiler says."""
        words = [w for w in shlex.split(command.replace("&&", " ")) if w not in (":", "-Werror")]
        out = folder / f"{name}.o"
        for flag, value in (("-o", str(out)), ("-c", str(source)), ("-MF", str(out) + ".d"), ("-MT", str(out))):
            words[words.index(flag) + 1] = value
        first = next(i for i, w in enumerate(words) if w.startswith("-I"))
        words[first:first] = ["-include", str(self.scratch / "mutants.hpp"), "-ferror-limit=0", "-w"]
        done = subprocess.run(words, cwd=self.build, stderr=subprocess.PIPE, text=True, check=False)
        return (out, "") if done.returncode == 0 else (None, done.stderr)

    def link(self, program, objects, name):
        command = self.links[program]
        words = shlex.split(command[command.index("/usr/bin/"):].split(" && ")[0])
        out = self.scratch / name
        words[words.index("-o") + 1] = str(out)
        at = next(i for i, w in enumerate(words) if w.startswith("tests/") and w.endswith(".o"))
        words[at:at] = [str(o) for o in objects]
        words = [w.replace("$ORIGIN/../lib", str(self.build / "lib")) for w in words]
        subprocess.run(words, cwd=self.build, check=True)
        return out


most_memory = 8 << 30  # bytes: a loop that does not end may fill the machine


def runs(program, build, timeout, mutant=None, tests=None, reached=None, ranks=1):
    """(whether all tests passed, the first that did not)"""
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1",
                       CHLADNI_MESHER=str(build / "libexec/chladni/chladni-mesher"))
    if mutant is not None:
        environment["CHLADNI_MUTANT"] = str(mutant)
    if reached is not None:
        environment["CHLADNI_REACHED"] = str(reached)
    if tests is not None:
        environment["GTEST_FILTER"] = ":".join(tests)
    several = ["mpiexec", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    fast = [] if reached is not None or several else ["--gtest_fail_fast"]  # on several, the others would wait

    def limited():
        resource.setrlimit(resource.RLIMIT_AS, (most_memory, most_memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        done = subprocess.run([*several, program, "--gtest_brief=1", *fast], cwd=build / "tests", env=environment, timeout=timeout,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False,
                              preexec_fn=limited)  # fmt: skip
    except subprocess.TimeoutExpired:
        return False, "time"
    failed = re.search(r"\[  FAILED  \] ([\w/.]+)", done.stdout)
    return done.returncode == 0, failed[1] if failed else f"exit status {done.returncode}"


def compiled(library, faults):
    """Objects with all faults that can stand together; the others are marked."""
    objects = []
    for unity, paths in library.sources().items():
        together = [f for f in faults if f.path in paths]
        if not together:
            continue
        folder = library.scratch / f"{unity.parents[1].stem}_{unity.stem}"
        while True:
            for path in {f.path for f in together}:
                (folder / path).parent.mkdir(parents=True, exist_ok=True)
                (folder / path).write_text(planted(path, [f for f in together if f.path == path and not f.by_itself]), encoding="utf-8")
            made, errors = library.with_faults(unity, folder, "switched")
            if made:
                objects.append(made)
                break
            wrong = {(pathlib.Path(m[1]).relative_to(folder).as_posix(), int(m[2]))
                     for m in re.finditer(r"^(\S+?):(\d+):\d+: error", errors, re.M) if m[1].startswith(str(folder))}
            wrong |= {(pathlib.Path(m[1]).relative_to(folder).as_posix(), int(m[2]))
                      for m in re.finditer(r"^(\S+?):(\d+):\d+: note: in instantiation", errors, re.M) if m[1].startswith(str(folder))}
            marked = [f for f in together if not f.by_itself and any(p == f.path and abs(f.line - n) < 4 for p, n in wrong)]
            for fault in marked or [f for f in together if not f.by_itself]:
                fault.by_itself = True
    return objects


def baseline(library, programs):
    """{(name of the program, test): (seconds, numbers that it reaches)}"""
    known = {}
    for name, program in programs.items():
        file = library.scratch / f"{name}.reached"
        file.unlink(missing_ok=True)
        passed, failed = runs(program, library.build, 1200, reached=file)
        if not passed and " -1" not in file.read_text():
            sys.exit(f"mutants: {name} fails without a fault: {failed}")
        of_suite = {}
        for line in file.read_text().splitlines():
            test, milliseconds, *numbers = line.split()
            suite = test.split(".")[0]
            if milliseconds == "-1":  # such as a test of the limit of memory, within another limit
                print(f"mutants: {test} of {name} fails without a fault", flush=True)
            elif test.endswith("."):
                of_suite.setdefault(suite, set()).update(int(n) for n in numbers)
            else:
                known[name, test] = (int(milliseconds) / 1e3, {int(n) for n in numbers} | of_suite[suite] | of_suite["*"])
    return known


def batches(known, tests):
    """(program, [test...], seconds), so that what fails in a short test is seen before the long ones begin."""
    of_program = {}
    for seconds, (name, test) in sorted((known[key][0], key) for key in tests):
        of_its = of_program.setdefault(name, [])
        spent = sum(s for _, s in of_its)
        if not of_its or (of_its[-1][1] > 0.5 and of_its[-1][1] + seconds > 3.0 * (spent - of_its[-1][1])):
            of_its.append(([], 0.0))
        of_its[-1] = ([*of_its[-1][0], test], of_its[-1][1] + seconds)
    return sorted(((name, of_batch, seconds) for name, of_its in of_program.items() for of_batch, seconds in of_its), key=lambda b: b[2])


def tried(library, fault, programs, known, number):
    """Fills in the outcome."""
    reaching = [key for key, (_, numbers) in known.items() if fault.by_itself or fault.number in numbers]
    fault.outcome, fault.seen_by = "survived", "" if reaching else "no test comes here"
    for name, tests, seconds in batches(known, reaching):
        passed, failed = runs(programs[name], library.build, 5.0 * seconds + 15.0, mutant=number, tests=tests)
        if not passed:
            fault.outcome, fault.seen_by = "seen", failed
            return
    for name in (n for n in programs if n in ON_RANKS):
        tests = [test for program, test in reaching or known if program == name]
        seconds = sum(known[key][0] for key in known if key[0] == name)
        passed, failed = runs(programs[name], library.build, 10.0 * seconds + 30.0, mutant=number, tests=tests, ranks=ON_RANKS[name])
        if not passed:
            fault.outcome, fault.seen_by = "seen", f"{failed}, on {ON_RANKS[name]} ranks"
            return


def listener_for(library):
    (library.scratch / "mutants.hpp").write_text(HEADER, encoding="utf-8")
    (library.scratch / "listener.cpp").write_text(LISTENER, encoding="utf-8")
    listener, errors = library.compile(library.of_test, library.scratch / "listener.cpp", library.scratch, "listener")
    if listener is None:
        sys.exit(errors)
    return listener


def try_survivors(room, build, scratch, faults):
    """With the objects of a run before; those compiled by themselves left none for all."""
    libraries, names = ROOMS[room]
    library = Library(build, scratch, libraries, names)
    objects = [listener_for(library), *sorted(scratch.glob("chladni_*/switched.o"))]
    programs = {name: library.link(name, objects, name) for name in names}
    known = baseline(library, programs)
    for fault in faults:
        tried(library, fault, programs, known, fault.number)
        report(fault)


def try_library(room, build, scratch, faults):
    libraries, names = ROOMS[room]
    library = Library(build, scratch, libraries, names)
    listener = listener_for(library)
    objects = [listener, *compiled(library, faults)]
    programs = {name: library.link(name, objects, name) for name in names}
    known = baseline(library, programs)
    for fault in faults:
        if not fault.by_itself:
            tried(library, fault, programs, known, fault.number)
            report(fault)
    for fault in faults:
        if not fault.by_itself:
            continue
        unity = next(u for u, paths in library.sources().items() if fault.path in paths)
        folder = scratch / f"alone_{fault.number}"
        (folder / fault.path).parent.mkdir(parents=True, exist_ok=True)
        (folder / fault.path).write_text(plainly(fault.path, fault), encoding="utf-8")
        made, _ = library.with_faults(unity, folder, "alone")
        if made is None:
            fault.outcome = "no program"
        else:
            alone = {name: library.link(name, [listener, made], f"alone_{name}") for name in names}
            tried(library, fault, alone, known, None)
        report(fault)


def reason(fault):
    return next((why for path, before, after, why in EQUIVALENT
                 if (path, before) == (fault.path, fault.before) and after in (None, fault.after)), None)  # fmt: skip


def report(fault):
    print(f"{fault.outcome:10} {fault.path}:{fault.line}: {fault.kind}: {fault.before}  [{fault.seen_by}]", flush=True)


def cell(text):
    return text.replace("|", "\\|")


def page(faults, run):
    rooms = {}
    for room, fault in faults:
        row = rooms.setdefault(room, {"seen": 0, "survived": 0, "equivalent": 0})
        row["equivalent" if fault.outcome == "survived" and reason(fault) else fault.outcome] += 1
    total = {k: sum(row[k] for row in rooms.values()) for k in ("seen", "survived", "equivalent")}
    yield "# Mutants\n"
    asked, seed = " ".join(run["asked"]), run["seed"]
    again = f" What survived was tried again at commit {run['again']}, by the tests of then." if "again" in run else ""
    yield (f"Written by `./dev mutants {asked}` at commit {seed}: small faults, planted at random in the sources of a library "
           "(relations, signs, constants, statements, guards, extremes), and whether the unit tests of the library see them, on as "
           "many ranks as in the gate. The number of commits is the seed, so that other faults are tried each time. An equivalent fault "
           "changes nothing that a test may ask for; `tests/tools/mutants.py` says why."
           f"{again}\n")
    yield "| room | seen | survived | equivalent |\n| --- | --- | --- | --- |"
    for room, row in (*sorted(rooms.items()), ("**all**", total)):
        yield f"| {room} | {row['seen']} | {row['survived']} | {row['equivalent']} |"
    changing = total["seen"] + total["survived"]
    yield f"\n{100.0 * total['seen'] / max(changing, 1):.0f} % of the faults that change behaviour are seen.\n"
    left = [(room, f) for room, f in faults if f.outcome == "survived"]
    if left:
        yield "## Not seen\n\n| place | fault | line | |\n| --- | --- | --- | --- |"
    for _, fault in sorted(left, key=lambda item: (item[1].path, item[1].line)):
        why = reason(fault)
        yield (f"| `{fault.path}:{fault.line}` | {cell(fault.kind)} | `{cell(fault.before)}` | "
               f"{cell('equivalent: ' + why) if why else cell(fault.seen_by) or 'survived'} |")


def number_of_commits():
    return int(subprocess.run(["git", "rev-list", "--count", "HEAD"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout)


def drawn_from_rooms(build, number, names):
    """(the number of commits, [(room, fault)...])"""
    seed = number_of_commits()
    room_of = {library: room for room in names for library in ROOMS[room][0]}
    paths = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        of_library = UNITY.search(entry["file"])
        if of_library and of_library[1] in room_of:
            paths.update((path, room_of[of_library[1]]) for path in sources_of(pathlib.Path(entry["file"])))
    chosen = drawn(sorted(paths), number, random.Random(seed))
    for i, fault in enumerate(chosen):
        fault.number = i
    return seed, [(paths[f.path], f) for f in chosen]


def try_all(build, asked, last):
    """Tries what is drawn, room by room, and keeps what is known after each room."""
    seed, chosen = drawn_from_rooms(build, int(asked[0]), asked[1:] or list(ROOMS))
    started = time.monotonic()
    done = []
    for room in asked[1:] or list(ROOMS):
        of_room = [f for of, f in chosen if of == room]
        if not of_room:
            continue
        scratch = build / "mutants" / room.replace("/", "_")
        shutil.rmtree(scratch, ignore_errors=True)  # objects of another run
        scratch.mkdir(parents=True)
        print(f"mutants: {len(of_room)} in {room}  [{time.monotonic() - started:.0f} s]", flush=True)
        try_library(room, build, scratch, of_room)
        done += [{"room": room, **dataclasses.asdict(f)} for f in of_room if f.outcome in ("seen", "survived")]
        last.write_text(json.dumps({"seed": seed, "asked": asked, "faults": done}, indent=1), encoding="utf-8")


def try_again(build, last):
    """The survivors of the last run that are not known to be equivalent."""
    run = json.loads(last.read_text(encoding="utf-8"))
    faults = [(entry["room"], Fault(**{k: v for k, v in entry.items() if k != "room"})) for entry in run["faults"]]
    for room in ROOMS:
        left = [f for of, f in faults if of == room and f.outcome == "survived" and not f.by_itself and not reason(f)]
        if left:
            try_survivors(room, build, build / "mutants" / room.replace("/", "_"), left)
    run |= {"again": number_of_commits(), "faults": [{"room": room, **dataclasses.asdict(f)} for room, f in faults]}
    last.write_text(json.dumps(run, indent=1), encoding="utf-8")


def main():
    build, target, asked = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), sys.argv[3:]
    last = build / "mutants" / "last.json"
    if asked == ["again"]:
        try_again(build, last)
    else:
        try_all(build, asked, last)
    run = json.loads(last.read_text(encoding="utf-8"))
    faults = [(entry.pop("room"), Fault(**entry)) for entry in run["faults"]]
    target.write_text("\n".join(page(faults, run)) + "\n", encoding="utf-8")
    for _, fault in faults:
        if fault.outcome == "survived" and not reason(fault):
            print(f"survived: {fault.path}:{fault.line}: {fault.before}\n  as: {fault.after}")


if __name__ == "__main__":
    main()
