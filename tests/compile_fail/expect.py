#!/usr/bin/env python3
"""Checks that each misuse fails to compile with its sentence.

    expect.py FOLDER COMPILER OPTION…

A misuse begins with a line "// expect: SENTENCE" in FOLDER/*.cpp and ends at the next empty line. Where
the sentence is the compiler's own, the second line has that of clang: "// expect of clang: SENTENCE".
An error that a line of the misuse makes, or leads to in a header, must contain the sentence. A line
"// control: SENTENCE" begins code without such an error, which this check must notice.

All misuses are compiled at once, each file in a namespace, since the compiler spends most of its time
on the precompiled header. A misuse that seems to have no such error is compiled again with fewer others,
and at last alone, which decides: the compiler reports an error of one instantiation only once.
"""
import os
import pathlib
import re
import subprocess
import sys
from dataclasses import dataclass

folder, compiler = pathlib.Path(sys.argv[1]), sys.argv[2:]
environment = dict(os.environ, LC_ALL="C.UTF-8")  # error texts are not translated


def output_of(command, text=""):
    return subprocess.run(command, input=text, env=environment, encoding="utf-8", errors="replace",
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout


is_clang = "clang" in output_of([compiler[0], "--version"])
# No error is left out, and no line of those that lead to an error.
compiler += ["-fsyntax-only", "-ferror-limit=0" if is_clang else "-fmax-errors=0",
             "-ftemplate-backtrace-limit=0", "-x", "c++", "-"]
sources = {path.name: path.read_text(encoding="utf-8").splitlines() for path in sorted(folder.glob("*.cpp"))}


@dataclass(frozen=True)
class Misuse:
    file: str
    first: int  # its lines, from 1
    last: int
    is_control: bool
    sentence: str


def misuses_of(file, lines):
    for number, line in enumerate(lines, 1):
        begins = re.fullmatch(" *// (expect|control): (.+)", line)
        if not begins:
            continue
        last = next(n for n in range(number, len(lines) + 1) if n == len(lines) or not lines[n])
        of_clang = re.fullmatch(" *// expect of clang: (.+)", lines[number]) if is_clang else None
        sentence = of_clang[1] if of_clang else begins[2]
        yield Misuse(file, number, last, begins[1] == "control", sentence)


every = [misuse for file, lines in sources.items() for misuse in misuses_of(file, lines)]


def source(misuses):
    """All files, without the lines of other misuses. Their headers come first, outside the namespaces."""
    left_out = {(one.file, n) for one in every if one not in misuses for n in range(one.first, one.last + 1)}
    headers = {line for lines in sources.values() for line in lines if line.startswith("#include")}
    text = "\n".join(sorted(headers)) + "\n"
    for file, lines in sources.items():
        text += f'namespace {pathlib.Path(file).stem} {{\n#line 1 "{file}"\n'
        for number, line in enumerate(lines, 1):
            text += ("" if line.startswith("#") or (file, number) in left_out else line) + "\n"
        text += "}\n"
    return text


def errors(output, misuses):
    """The errors of each misuse. An error in a header belongs to the line that instantiates it, or to a class
    that the misuse defines: gcc names them before the error, clang in notes after it. Neither repeats it for
    further errors of the same instantiation."""
    if len(misuses) == 1:
        return {misuses[0]: [line for line in output.splitlines() if "error: " in line]}
    names = {}
    for one in misuses:
        for number, line in enumerate(sources[one.file][one.first:one.last], one.first + 1):
            names[f"{one.file}:{number}"] = one
            for name in re.findall(r"^(?:struct|class) (\w+)", line):
                names[f"{pathlib.Path(one.file).stem}::{name}"] = one
    place = re.compile(r"\w+\.cpp:\d+|(?:" + "|".join(pathlib.Path(file).stem for file in sources) + r")::\w+")
    found = {one: [] for one in [*misuses, None]}
    owner, error = None, None
    for line in output.splitlines():
        named = next((names[text] for text in place.findall(line) if text in names), None)
        if "error: " in line:
            owner = named or owner
            error = line
            found[owner].append(error)
        elif ": In " in line or ": At " in line:  # another function or instantiation
            owner = named
        elif named and re.search("required (from|by substitution)", line):
            owner = named
        elif named and error and line.endswith("requested here"):  # clang
            found[owner].remove(error)
            owner = named
            found[owner].append(error)
    return found


def unfulfilled(misuses):
    """The misuses without an error that contains their sentence, and the compiler's output."""
    output = output_of(compiler, source(misuses))
    found = errors(output, misuses)
    return [one for one in misuses if not any(one.sentence in error for error in found[one])], output


def check(misuses, controls=()):
    """The number of misuses that do not fail with their sentence."""
    missing, output = unfulfilled([*misuses, *controls])
    not_noticed = set(controls) - set(missing)
    if not_noticed:
        sys.exit(f"this check finds sentences that are not there: {not_noticed}\n{output}")
    missing = [one for one in missing if not one.is_control]
    if len(misuses) > 1:
        half = (len(missing) + 1) // 2
        return sum(check(part) for part in (missing[:half], missing[half:]) if part)
    for one in missing:
        what = "does not fail with" if "error: " in output else "compiles, but should not"
        print(f"{one.file}:{one.first} {what}: {one.sentence}\n{output[:3000]}")
    if not missing:
        print(f"{misuses[0].file}:{misuses[0].first} fails as expected, but only when compiled alone")
    return len(missing)


misuses, controls = [[one for one in every if one.is_control == wanted] for wanted in (False, True)]
if not misuses or not controls:
    sys.exit(f"{folder} has no misuses, or none to control this check")
n_failed = check(misuses, controls)
print(f"{len(misuses)} misuses, {n_failed} without their sentence")
sys.exit(n_failed > 0)
