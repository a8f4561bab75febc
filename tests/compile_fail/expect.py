#!/usr/bin/env python3
"""Checks that each misuse fails to compile with its sentence.

    expect.py FOLDER COMPILER OPTION…

The first line of each FOLDER/*.cpp is "// expect: SENTENCE". Where the sentence is the compiler's own,
the second line has that of clang: "// expect of clang: SENTENCE". One of the errors of the file must
contain the sentence.

All files are compiled at once, each in a namespace that has its name, since the compiler spends most
of its time on the precompiled header. A file that seems to have no such error there is compiled again
with fewer others, and at last alone and outside a namespace, which decides. A file needs that if it
specialises templates, or if another file makes the same error in the same instantiation, which the
compiler reports only once.

FOLDER/control/*.cpp are compiled with the others and must be reported: what each lacks is its sentence.
"""
import os
import pathlib
import re
import subprocess
import sys

folder, compiler = pathlib.Path(sys.argv[1]), sys.argv[2:]
environment = dict(os.environ, LC_ALL="C.UTF-8")  # error texts are not translated


def output_of(command, text=""):
    return subprocess.run(command, input=text, env=environment, encoding="utf-8", errors="replace",
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout


is_clang = "clang" in output_of([compiler[0], "--version"])
# No error is left out, and no line of those that lead to an error.
compiler += ["-fsyntax-only", "-ferror-limit=0" if is_clang else "-fmax-errors=0",
             "-ftemplate-backtrace-limit=0", "-x", "c++", "-"]


def sentence_of(file):
    lines = file.read_text(encoding="utf-8").splitlines() + ["", ""]
    first = re.fullmatch("// expect: (.+)", lines[0])
    of_clang = re.fullmatch("// expect of clang: (.+)", lines[1])
    if not first:
        sys.exit(f"{file}: the first line names no sentence: // expect: …")
    return (of_clang if is_clang and of_clang else first)[1]


def source(files):
    if len(files) == 1:
        return f'#include "{files[0]}"\n'
    # The headers come first: inside a namespace they are included again, which does nothing.
    headers = {line for file in files for line in file.read_text(encoding="utf-8").splitlines()
               if line.startswith("#include")}
    return "\n".join(sorted(headers)) + "\n" + "".join(
        f'namespace {file.stem} {{\n#include "{file}"\n}}\n' for file in files)


def errors(output, files):
    """The errors of each file. An error in a header belongs to the file that instantiates it, which is
    named by its path or as a namespace: gcc names it before the error, clang in notes after it. Neither
    repeats it for further errors of the same instantiation."""
    if len(files) == 1:
        return {files[0]: [line for line in output.splitlines() if "error: " in line]}
    names = {str(file): file for file in files} | {f"{file.stem}::": file for file in files}
    name = re.compile("|".join(r"(?<!\w)" + re.escape(text) for text in names))
    found = {file: [] for file in [*files, None]}
    owner, error = None, None
    for line in output.splitlines():
        named = names[name.search(line)[0]] if name.search(line) else None
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


def unfulfilled(files):
    """The files without an error that contains their sentence, and the compiler's output."""
    output = output_of(compiler, source(files))
    found = errors(output, files)
    return [file for file in files if not any(sentence_of(file) in error for error in found[file])], output


def check(files, controls=()):
    """The number of files that do not fail with their sentence."""
    missing, output = unfulfilled([*files, *controls])
    not_reported = set(controls) - set(missing)
    if not_reported:
        sys.exit(f"this check finds sentences that are not there: {', '.join(map(str, not_reported))}\n{output}")
    missing = [file for file in missing if file not in controls]
    if len(files) > 1:
        half = (len(missing) + 1) // 2
        return sum(check(part) for part in (missing[:half], missing[half:]) if part)
    for file in missing:
        if "error: " in output:
            print(f"{file} does not fail with: {sentence_of(file)}\n{output[:3000]}")
        else:
            print(f"{file} compiles, but should not: {sentence_of(file)}\n{output[:3000]}")
    if not missing:
        print(f"{files[0]} fails as expected, but only when compiled alone")
    return len(missing)


misuses, controls = sorted(folder.glob("*.cpp")), sorted(folder.glob("control/*.cpp"))
if not misuses or not controls:
    sys.exit(f"{folder} has no misuses, or none to control this check")
n_failed = check(misuses, controls)
print(f"{len(misuses)} misuses, {n_failed} without their sentence")
sys.exit(n_failed > 0)
