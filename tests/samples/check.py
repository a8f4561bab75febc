#!/usr/bin/env python3
"""Compares the code samples in headers and .md files with the sources that they are taken from.

    check.py [--self-test] [ROOT]

In a header, a comment line "// Sample: PATH" precedes a sample, the comment lines that follow with an
indent of at least four columns:

    // Sample: tests/samples/transfer.cpp
    //
    //     const TransferSummary summary = co_await transfer(source, target, options);

In an .md file, the line "<!-- Sample: PATH -->" precedes a fenced block. The lines of the sample must
stand in PATH in one piece; the indent of the whole piece may differ. A line "// …" in a sample leaves
lines out: the pieces before and after it stand in PATH in this order. PATH must be listed in a
CMakeLists.txt (a source that is not compiled proves nothing), or be a CMakeLists.txt.

Each ```cpp and ```cmake block of an .md file needs such a line. Code of another system has the line
"<!-- Not compiled: REASON -->" instead. Exit code 1 if a sample differs or has no marker.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap

LEFT_OUT = "// …"


def dedented(lines):
    lines = [line.rstrip() for line in lines]
    return textwrap.dedent("\n".join(lines)).strip("\n").split("\n")


def pieces(sample):
    """The parts of a sample between the lines that leave something out."""
    piece, all_pieces = [], []
    for line in sample + [LEFT_OUT]:
        if line.strip() != LEFT_OUT:
            piece.append(line)
        elif piece:
            all_pieces.append(dedented(piece))
            piece = []
    return all_pieces


def stands_in(sample, source):
    at = 0
    for wanted in pieces(sample):
        for first in range(at, len(source) - len(wanted) + 1):
            piece = source[first : first + len(wanted)]
            if piece[0].lstrip() == wanted[0].lstrip() and dedented(piece) == wanted:
                at = first + len(wanted)
                break
        else:
            return False
    return True


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


def samples_of_text(lines):
    """Yields (line number, path, sample) of an .md file; path None for code without a marker."""
    fence = None
    for at, line in enumerate(lines):
        before = lines[at - 1] if at > 0 else ""
        found = re.match(r"<!-- Sample: (\S+) -->$", line)
        if found and not (at + 1 < len(lines) and lines[at + 1].startswith("```")):
            yield at + 1, found[1], []
        opened = re.match(r"\s*(`{3,})(.*)$", line)
        if fence is not None:
            if line.strip() == fence:
                fence = None
        elif opened:
            fence = opened[1]
            rest = [follower.strip() for follower in lines[at + 1 :]]
            end = at + 1 + rest.index(fence) if fence in rest else len(lines)
            named = re.match(r"<!-- Sample: (\S+) -->$", before)
            if named:
                yield at, named[1], lines[at + 1 : end]
            elif opened[2].strip() in ("cpp", "c++", "cxx", "cmake") and not re.match(r"<!-- Not compiled: .+ -->$", before):
                yield at + 1, None, lines[at + 1 : end]


def is_compiled(root, path):
    """A CMakeLists.txt above lists the source: by its path, or by its name where a loop adds ${name}.cpp."""
    path = pathlib.PurePosixPath(path)
    if path.name == "CMakeLists.txt":
        return True
    looped = False
    for folder in path.parents:
        script = root / folder / "CMakeLists.txt"
        if script.exists():
            text = script.read_text()
            looped = looped or "}.cpp" in text
            words = re.split(r"[\s()\"]+", text)
            if str(path.relative_to(folder)) in words or (looped and path.stem in words):
                return True
    return False


def check(root, files):
    n_samples, failures = 0, []
    for name in files:
        lines = (root / name).read_text().split("\n")
        find = samples_of_text if name.endswith(".md") else samples_of_header
        for number, path, sample in find(lines):
            n_samples += 1
            where = f"{name}:{number}"
            if path is None:
                failures.append(f"{where}: code without a marker; precede it by <!-- Sample: PATH -->")
                continue
            source = root / path
            if not any(line.strip() for line in sample):
                failures.append(f"{where}: no code follows; indent it by four columns, or fence it in an .md file")
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
        text = "<!-- Sample: a.cpp -->\n```cpp\nint x = 1;\nif (x)\n  g();\n```\n"
        parts = "<!-- Sample: a.cpp -->\n```cpp\nvoid f() {\n  // …\n  g();\n}\n```\n"
        cases = {
            "good.hpp": (good, 1, 0),
            "good.md": (text, 1, 0),
            "changed.hpp": (good.replace("x = 1", "x = 2"), 1, 1),
            "longer.hpp": (good.replace("g();\n", "g();\n//     h();\n"), 1, 1),
            "indent.hpp": (good.replace("  g();", "g();"), 1, 1),
            "empty.hpp": ("// Sample: a.cpp\n//\n// Prose.\n", 1, 1),
            "absent.hpp": (good.replace("a.cpp", "c.cpp"), 1, 1),
            "not_compiled.hpp": ("// Sample: b.cpp\n//     int x = 1;\n", 1, 1),
            "left_out.md": (parts.replace("  g();\n}", "    g();\n}"), 1, 0),
            "wrong_order.md": (parts.replace("  g();\n}", "void f() {"), 1, 1),
            "no_marker.md": (text.split("\n", 1)[1], 1, 1),
            "no_block.md": ("<!-- Sample: a.cpp -->\nProse.\n", 1, 1),
            "other_system.md": (text.replace("Sample: a.cpp", "Not compiled: another system's"), 0, 0),
            "other_text.md": ("```\nint y;\n```\n", 0, 0),
        }
        for name, (content, samples, wanted) in cases.items():
            (root / name).write_text(content)
            n_samples, failures = check(root, [name])
            if n_samples != samples or len(failures) != wanted:
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
    print(f"samples: {n_samples}, of which {len(failures)} differ or have no marker")
    sys.exit(1 if failures or n_samples == 0 else 0)


main()
