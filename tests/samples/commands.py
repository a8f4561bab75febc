#!/usr/bin/env python3
"""Runs the commands that .md files print, and compares what they write with what the files print.

    commands.py [--self-test] ROOT BUILD [FILE.md…]

All .md files of the project are read, unless some are given.

A block of commands is fenced as ```console. A line "$ COMMAND" is run by bash; the lines below it, up to
the next command, are its whole output, standard output and error together:

    $ build/release/bin/tutorial_01_hello --sim pes=2,cost=100ns
    element 0 of 4 says hello to Ada
    …

"…" within a line stands for any text, a line "…" for any lines. A command that ends with an exit code
other than 0 must be followed by "$ echo $?". "<!-- Lines in any order -->" in the line before a block
compares sorted lines, "<!-- Not run: REASON -->" skips it. In the tutorial
other shell blocks (```sh) need such a reason, too.

The commands see ROOT's folders in an empty working folder, BUILD as build/release, and may write there.
Exit code 1 if a command prints something else.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def blocks(lines):
    """Yields (line number, marker before, language, lines) of the fenced blocks."""
    at = 0
    while at < len(lines):
        opened = re.match(r"```(\w*)$", lines[at])
        if opened:
            rest = lines[at + 1 :]
            end = rest.index("```") if "```" in rest else len(rest)
            yield at + 1, lines[at - 1] if at > 0 else "", opened[1], rest[:end]
            at += end + 1
        at += 1


def commands(block):
    """(command, expected lines) of a console block."""
    found = []
    for line in block:
        if line.startswith("$ "):
            found.append((line[2:], []))
        elif found and found[-1][0].endswith("\\"):
            found[-1] = (found[-1][0] + "\n" + line, [])
        elif found:
            found[-1][1].append(line)
    return found


def matches(expected, printed):
    pattern = ""
    for line in expected:
        if line.strip() == "…":
            pattern += r"(?:[^\n]*\n)*"
        else:
            pattern += r"[^\n]*".join(re.escape(part) for part in line.split("…")) + r"\n"
    return re.fullmatch(pattern, "".join(line + "\n" for line in printed)) is not None


def run_block(folder, block, any_order):
    """Returns the number of commands and a list of what was wrong."""
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1", LC_ALL="C.UTF-8")
    failures, code, asked = [], 0, commands(block)
    for i, (command, expected) in enumerate(asked):
        if command == "echo $?":
            if expected != [str(code)]:
                failures.append(f"exit code {code}, not {' '.join(expected)}")
            continue
        try:
            run = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True, timeout=120,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        except subprocess.TimeoutExpired:
            failures.append(f"{command}: runs for more than 120 s")
            break
        code, printed = run.returncode, [line.rstrip() for line in run.stdout.rstrip("\n").split("\n")]
        if printed == [""]:
            printed = []
        if any_order:
            expected, printed = sorted(expected), sorted(printed)
        if not matches(expected, printed):
            failures.append(f"{command}\n  printed\n    " + "\n    ".join(printed) + "\n  the text says\n    " + "\n    ".join(expected))
        if code != 0 and not (i + 1 < len(asked) and asked[i + 1][0] == "echo $?"):
            failures.append(f"{command}: exit code {code}, and the text does not show it by echo $?")
    return len(asked), failures


def check(root, build, name):
    complete = "tutorial" in name
    n_commands, failures = 0, []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for entry in root.iterdir():
            if entry.name != "build":
                (folder / entry.name).symlink_to(entry)
        (folder / "build").mkdir()
        (folder / "build" / "release").symlink_to(build)
        for number, marker, language, block in blocks((root / name).read_text().split("\n")):
            skipped = re.match(r"<!-- Not run: .+ -->$", marker)
            if language in ("sh", "bash", "shell") and complete and not skipped:
                failures.append(f"{name}:{number}: a shell block that is not run; make it ```console, or give a reason")
            if language != "console" or skipped:
                continue
            n, wrong = run_block(folder, block, marker == "<!-- Lines in any order -->")
            n_commands += n
            failures += [f"{name}:{number}: {text}" for text in wrong]
    return n_commands, failures


def self_test():
    """A right block passes; every kind of wrong one is found."""
    cases = [
        (["$ echo a; echo b", "a", "b"], False, 0),
        (["$ echo b; echo a", "a", "b"], True, 0),
        (["$ echo b; echo a", "a", "b"], False, 1),
        (["$ echo a; echo b; echo c; echo took 17 s", "a", "…", "took … s"], False, 0),
        (["$ echo a; echo b", "a"], False, 1),
        (["$ echo 1 + 1", "1 . 1"], False, 1),
        (["$ false", "$ echo $?", "1"], False, 0),
        (["$ false", "$ echo $?", "0"], False, 1),
        (["$ false"], False, 1),
        (["$ no_such_program_at_all"], False, 2),
        (["$ echo one \\", "  two", "one two"], False, 0),
    ]
    for block, any_order, wanted in cases:
        with tempfile.TemporaryDirectory() as folder:
            n, failures = run_block(folder, block, any_order)
            if n == 0 or len(failures) != wanted:
                sys.exit(f"self-test: {block}: {failures}")
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, wanted in (("a.md", 0), ("tutorial.md", 1)):
            (root / name).write_text("```console\n$ echo a\na\n```\n```sh\nrm -r x\n```\n")
            n, failures = check(root, root, name)
            if n != 1 or len(failures) != wanted:
                sys.exit(f"self-test: {name}: {failures}")


def main():
    arguments = sys.argv[1:]
    if "--self-test" in arguments:
        arguments.remove("--self-test")
        self_test()
    root, build, *names = arguments
    root, build = pathlib.Path(root).resolve(), pathlib.Path(build).resolve()
    if not names:
        listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard", "*.md"],
                                capture_output=True, text=True, check=True).stdout.split("\n")
        names = [name for name in listed if name and (root / name).exists()]
    n_commands, n_failures = 0, 0
    for name in names:
        n, failures = check(root, build, name)
        for failure in failures:
            print(failure)
        n_commands, n_failures = n_commands + n, n_failures + len(failures)
    print(f"commands: {n_commands} in {len(names)} files, {n_failures} failures")
    sys.exit(1 if n_failures or n_commands == 0 else 0)


main()
