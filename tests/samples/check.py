#!/usr/bin/env python3
"""Compares the code samples in headers and READMEs with the sources that they are taken from.

    check.py [--self-test] [ROOT]

In a header, a comment line "// Sample: PATH" precedes a sample, the comment lines that follow with an
indent of at least four columns:

    // Sample: tests/samples/transfer.cpp
    //
    //     co_await transfer(source, target, options, &summary);

In a README, the line "<!-- Sample: PATH -->" precedes a fenced block. The lines of the sample must
stand in PATH in one piece; the indent of the whole piece may differ. PATH must be listed in a
CMakeLists.txt (a source that is not compiled proves nothing). Exit code 1 if a sample differs.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap


def dedented(lines):
    lines = [line.rstrip() for line in lines]
    return textwrap.dedent("\n".join(lines)).strip("\n").split("\n")


def stands_in(sample, source):
    wanted = dedented(sample)
    for first in range(len(source) - len(wanted) + 1):
        piece = source[first : first + len(wanted)]
        if piece[0].lstrip() == wanted[0].lstrip() and dedented(piece) == wanted:
            return True
    return False


def samples_of_header(lines):
    """Yields (line number, path, sample)."""
    for at, line in enumerate(lines):
        found = re.match(r"\s*///? Sample: (\S+)$", line)
        if not found:
            continue
        sample = []
        for follower in lines[at + 1 :]:
            text = re.match(r"\s*///?(| .*)$", follower)
            if text is None or (text[1].strip() and not text[1].startswith("     ")):
                break
            sample.append(text[1])
        yield at + 1, found[1], sample


def samples_of_readme(lines):
    for at, line in enumerate(lines):
        found = re.match(r"<!-- Sample: (\S+) -->$", line)
        if not found:
            continue
        rest = lines[at + 1 :]
        sample = []
        if rest and rest[0].startswith("```"):
            end = rest.index("```") if "```" in rest else len(rest)
            sample = rest[1:end]
        yield at + 1, found[1], sample


def is_compiled(root, path):
    for folder in pathlib.PurePosixPath(path).parents:
        script = root / folder / "CMakeLists.txt"
        if script.exists() and str(pathlib.PurePosixPath(path).relative_to(folder)) in script.read_text():
            return True
    return False


def check(root, files):
    n_samples, failures = 0, []
    for name in files:
        lines = (root / name).read_text().split("\n")
        find = samples_of_readme if name.endswith(".md") else samples_of_header
        for number, path, sample in find(lines):
            n_samples += 1
            where = f"{name}:{number}"
            source = root / path
            if not any(line.strip() for line in sample):
                failures.append(f"{where}: no code follows; indent it by four columns, or fence it in a README")
            elif not source.exists():
                failures.append(f"{where}: {path} does not exist")
            elif not is_compiled(root, path):
                failures.append(f"{where}: {path} is in no CMakeLists.txt above it; compile it")
            elif not stands_in(sample, [line.rstrip() for line in source.read_text().split("\n")]):
                failures.append(f"{where}: the sample is not in {path}; copy it from there")
    return n_samples, failures


def self_test():
    """A right sample passes; every kind of wrong one is found."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "CMakeLists.txt").write_text("SOURCES a.cpp\n")
        (root / "a.cpp").write_text("void f() {\n  int x = 1;\n  if (x)\n    g();\n}\n")
        (root / "b.cpp").write_text("int x = 1;\n")
        good = "// Sample: a.cpp\n//\n//     int x = 1;\n//     if (x)\n//       g();\n//\n// Prose.\n"
        cases = {
            "good.hpp": (good, 0),
            "good.md": ("<!-- Sample: a.cpp -->\n```cpp\nint x = 1;\nif (x)\n  g();\n```\n", 0),
            "changed.hpp": (good.replace("x = 1", "x = 2"), 1),
            "longer.hpp": (good.replace("g();\n", "g();\n//     h();\n"), 1),
            "indent.hpp": (good.replace("  g();", "g();"), 1),
            "empty.hpp": ("// Sample: a.cpp\n//\n// Prose.\n", 1),
            "absent.hpp": (good.replace("a.cpp", "c.cpp"), 1),
            "not_compiled.hpp": ("// Sample: b.cpp\n//     int x = 1;\n", 1),
        }
        for name, (text, wanted) in cases.items():
            (root / name).write_text(text)
            n_samples, failures = check(root, [name])
            if n_samples != 1 or len(failures) != wanted:
                sys.exit(f"self-test: {name}: {n_samples} samples, failures {failures}")


def main():
    arguments = sys.argv[1:]
    if "--self-test" in arguments:
        arguments.remove("--self-test")
        self_test()
    root = pathlib.Path(arguments[0] if arguments else ".").resolve()
    listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard", "*.hpp", "*.md"],
                            capture_output=True, text=True, check=True).stdout.split("\n")
    n_samples, failures = check(root, [name for name in listed if name and (root / name).exists()])
    for failure in failures:
        print(failure)
    print(f"samples: {n_samples}, of which {len(failures)} differ")
    sys.exit(1 if failures or n_samples == 0 else 0)


main()
