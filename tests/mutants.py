#!/usr/bin/env python3
"""Plants bugs in a copy of the sources and reports which test catches each. By hand: all bugs take one build.

  tests/mutants.py [TEXT…]      the bugs whose list's or own name contains one TEXT (all by default)
  tests/mutants.py --jobs 1     compile and test on one core (all cores by default)

tests/mutants/*.mutants hold the bugs: a name, the file, the program that should fail, and the lines that are
replaced (they must occur once):

  == a PE answers a report twice
  file: runtime/pe/completion/completion.cpp
  test: test_runtime_parts [completion]
  - old line
  + new line

All bugs are planted at once: the function that holds the lines gets a body per bug, and the environment variable
PLANTED_BUG chooses one when the test runs. A bug outside of functions is planted alone, with a build of its own.
Each bug meets its test as the quick tier runs it first (20 seeds; not at all if the program is not QUICK), then with all seeds.
The build in build/mutants is kept, and ninja rebuilds what a change of the sources or of the bugs makes old.
"""
import argparse
import collections
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build/mutants"
COPY = WORK / "source"
BUILD = COPY / "build/release"
MOST_SECONDS = 600  # of a test without a bug
QUICK_SEEDS = 20

SWITCH = """#pragma once
#include <cstdlib>
#include <type_traits>
namespace planted {
inline int chosen() {
  static const int number = std::getenv("PLANTED_BUG") ? std::atoi(std::getenv("PLANTED_BUG")) : 0;
  return number;
}
constexpr bool bug(int number) {
  if (std::is_constant_evaluated()) return false;
  return chosen() == number;
}
}  // namespace planted
"""


@dataclasses.dataclass
class Bug:
    number: int
    list: str
    name: str
    file: str = ""
    test: tuple = ()
    old: str = ""
    new: str = ""
    span: tuple = None  # what is replaced in the file
    body: tuple = None  # of the function around it; None outside of functions
    verdict: str = None
    quick: bool = False  # the quick tier finds it
    why: str = ""


def read_bugs():
    bugs = []
    for path in sorted((ROOT / "tests/mutants").glob("*.mutants")):
        for line in path.read_text().split("\n"):
            if line.startswith("== "):
                # The number stays if bugs are added, so that files without a new bug are not compiled again.
                bugs.append(Bug(zlib.crc32(line.encode()) >> 1 | 1, path.stem, line[3:]))
            elif line.startswith("file: "):
                bugs[-1].file = line[6:]
            elif line.startswith("test: "):
                bugs[-1].test = tuple(shlex.split(line[6:]))
            elif re.match(r"-( |$)", line):
                bugs[-1].old += line[2:] + "\n"
            elif re.match(r"\+( |$)", line):
                bugs[-1].new += line[2:] + "\n"
    return bugs


# What is no code: comments, raw strings, strings, characters.
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)
TYPE = re.compile(r"(?:(?:inline|extern|typedef|static|constexpr)\s+)*(namespace|class|struct|union|enum|extern)\b")


def bodies(text):
    """The bodies of the outermost functions: positions behind { and before }."""
    code = NO_CODE.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    code = re.sub(r"^\s*#[^\n]*(?:\\\n[^\n]*)*", lambda m: re.sub(r"[^\n]", " ", m.group()), code, flags=re.M)
    found, stack, parens, begin = [], [], 0, 0  # begin: where the declaration before { begins
    for at, c in enumerate(code):
        if c in "([":
            parens += 1
        elif c in ")]":
            parens -= 1
        elif c == "{":
            head = re.sub(r"^(\s*(public|private|protected)\s*:)*\s*", "", code[begin:at])
            head = re.sub(r"^template\s*<(?:[^<>]|<(?:[^<>]|<[^<>]*>)*>)*>\s*(requires [^\n]*\n)?\s*", "", head)
            if "function" in stack or parens > 0 or not code[at - 1].isspace() or head.rstrip().endswith("="):
                kind = "block"  # inside of a function, or an initialiser
            elif TYPE.match(head):
                kind = "type"
            else:
                kind = "function" if "(" in head else "block"
            stack.append(kind)
            if kind == "function":
                found.append([at + 1, None])
            if kind != "block":
                begin = at + 1
        elif c == "}":
            kind = stack.pop()
            if kind == "function":
                found[-1][1] = at
            if kind != "block":
                begin = at + 1
        elif c == ";" and parens == 0:
            begin = at + 1
    return [tuple(one) for one in found]


def locate(bugs):
    """Finds the replaced text of each bug, without what old and new share, and the function around it."""
    texts, functions = {}, {}
    for bug in bugs:
        path = ROOT / bug.file
        if bug.file not in texts:
            texts[bug.file] = path.read_text() if path.is_file() else ""
            functions[bug.file] = bodies(texts[bug.file])
        text, old, new = texts[bug.file], bug.old, bug.new
        if not old or text.count(old) != 1:
            bug.verdict, bug.why = "stale", f"its lines do not occur once in {bug.file}"
            continue
        head = len(os.path.commonprefix([old, new]))
        tail = len(os.path.commonprefix([old[head:][::-1], new[head:][::-1]]))
        begin = text.index(old) + head
        end = begin + len(old) - head - tail
        bug.span, bug.new = (begin, end), new[head : len(new) - tail]
        bug.body = next((b for b in functions[bug.file] if b[0] <= begin and end <= b[1]), None)
    return texts


def planted(text, bugs):
    """The text with a body per bug in each function, and the first and last line of each such body."""
    out, at, lines = ['#include "planted.hpp"\n'], 0, {}
    by_body = collections.defaultdict(list)
    for bug in bugs:
        by_body[bug.body].append(bug)
    for (begin, end), inside in sorted(by_body.items()):
        out.append(text[at:begin])
        for bug in inside:
            out.append(f" if (::planted::bug({bug.number})) {{\n")
            first = "".join(out).count("\n") + 1
            out.append(text[begin : bug.span[0]] + bug.new + text[bug.span[1] : end])
            lines[bug.number] = (first, "".join(out).count("\n") + 1)
            out.append("\n} else")
        out.append(" {\n" + text[begin:end] + "\n}\n")
        at = end
    out.append(text[at:])
    return "".join(out), lines


def write(path, text):
    if not path.is_file() or path.read_bytes() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text)


def copy_sources(planted_files):
    """Makes the copy equal to the sources, except for the planted files; what is equal keeps its time."""
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, text=True, check=True,
                           capture_output=True).stdout.split("\n")
    names = {name for name in names if name and (ROOT / name).is_file()}
    kept = names | {"planted.hpp"}  # all planted files include it, so it keeps its time
    for path in list(COPY.rglob("*")) if COPY.exists() else []:
        name = str(path.relative_to(COPY))
        if path.is_file() and not name.startswith("build/") and name not in kept:
            path.unlink()
    for name in sorted(names):
        if name in planted_files:
            write(COPY / name, planted_files[name].encode())
        else:
            write(COPY / name, (ROOT / name).read_bytes())
            os.chmod(COPY / name, (ROOT / name).stat().st_mode)
    write(COPY / "planted.hpp", SWITCH.encode())


# ccache returns objects of older sources, together with a precompiled header.
ENVIRONMENT = {**os.environ, "CCACHE_DISABLE": "1"}


def build(targets, jobs):
    """Builds as much as compiles; returns what the compiler printed, or None if all does."""
    done = subprocess.run(["cmake", "--build", "--preset", "release", "-j", str(jobs), "--target", *sorted(targets), "--",
                           "-k", "0"], cwd=COPY, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=ENVIRONMENT)
    (WORK / "build.log").write_text(done.stdout)
    return done.stdout if done.returncode != 0 else None


def plant_all(bugs, texts, targets, jobs):
    """Builds with all bugs that can be chosen at run time; those that do not compile get their verdict."""
    while True:
        files, lines = {}, {}
        for file in {bug.file for bug in bugs if bug.body and not bug.verdict}:
            files[file], inside = planted(texts[file], [b for b in bugs if b.file == file and b.body and not b.verdict])
            lines |= inside
        copy_sources(files)
        if not (BUILD / "build.ninja").exists():
            subprocess.run(["cmake", "--preset", "release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -w", "-DTESS_WARNINGS_AS_ERRORS=OFF",
                            *shlex.split(os.environ.get("MUTANTS_CMAKE", ""))], cwd=COPY, check=True, stdout=subprocess.DEVNULL)
        log = build(targets, jobs)
        if log is None:
            return
        guilty = set()
        for what in (r"error:", r"required from|in .constexpr. expansion"):  # the place of the error, or the way to it
            for file, line in re.findall(rf"^(?:{re.escape(str(COPY))}/)?(\S+?):(\d+)(?::\d+)?:\s+(?:fatal )?(?:{what})", log, re.M):
                guilty |= {b.number for b in bugs if b.file == file and b.number in lines
                           and lines[b.number][0] <= int(line) <= lines[b.number][1]}
            if guilty:
                break
        if not guilty:
            sys.exit("mutants.py: does not compile without a bug:\n" + "\n".join(re.findall(r".*error:.*", log)[:3]))
        for bug in bugs:
            if bug.number in guilty:
                bug.verdict, bug.why = "stale", "does not compile"


def first_failure(log):
    """The first case, seed or check that the test's log names."""
    rule = False
    for line in log.split("\n"):
        if match := re.match(r"FAILED (.*)|protocol_fuzz: repeat with[^:]*: (.*)", line):
            return match.group(1) or match.group(2)
        if rule:
            return line.strip()
        rule = line.startswith("-----")
    return ""


def quick_programs():
    listed = json.loads(subprocess.run(["ctest", "--preset", "release", "-L", "quick", "--show-only=json-v1"], cwd=COPY,
                                       check=True, stdout=subprocess.PIPE, text=True).stdout)
    return {test["name"] for test in listed["tests"]}


def quick_form(test, programs):
    """The test as the quick tier runs it; None if it does not. Its test_protocols runs protocol_fuzz."""
    if test[0] == "protocol_fuzz":
        return tuple(re.sub(r"^(\d+):\d+$", lambda m: f"{m[1]}:{int(m[1]) + QUICK_SEEDS - 1}", word) for word in test)
    return test if test[0] in programs else None


def run(test, number, seconds, **environment):
    """Whether the test passes with this bug, its seconds, and its first failure."""
    begin = time.monotonic()
    try:
        # Catch ends with the first failure, and fails if no case has the name.
        abort = ["--abort", "--warn", "NoTests"] if test[0].startswith("test_") else []
        done = subprocess.run([BUILD / "bin" / test[0], *test[1:], *abort], cwd=COPY, timeout=seconds,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env={**ENVIRONMENT, "PLANTED_BUG": str(number), **environment})
        passes = done.returncode == 0
        by = first_failure(done.stdout.decode(errors="replace")) or f"exit code {done.returncode}"
    except subprocess.TimeoutExpired:
        passes, by = False, f"no end after {seconds:.0f} s"
    return passes, time.monotonic() - begin, "" if passes else by


def try_bug(bug, passes, programs):
    # A loaded machine is slow: a bug that lets a test run for ever is known by ten times its usual time.
    most = 20 + 10 * passes[bug.test]
    survives, seconds = True, 0.0
    if quick := quick_form(bug.test, programs):
        survives, seconds, by = run(quick, bug.number, most, TESS_SEEDS=str(QUICK_SEEDS))
        bug.quick = not survives
    if survives:
        survives, seconds, by = run(bug.test, bug.number, most)
    bug.verdict, bug.why = ("survives" if survives else "caught"), by
    report(bug, seconds)


def report(bug, seconds=0.0):
    why = f" ({bug.why})" if bug.why else ""
    print(f"{bug.verdict:<9} {'quick' if bug.quick else '':<5} {bug.test[0]:<22} {seconds:5.1f} s  {bug.list}: {bug.name}{why}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("texts", nargs="*", metavar="TEXT")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    bugs = read_bugs()
    chosen = [b for b in bugs if not options.texts or any(text in f"{b.list}: {b.name}" for text in options.texts)]
    if not chosen:
        print(f"mutants.py: no bug is named like {' '.join(options.texts)}: see the lists in tests/mutants", file=sys.stderr)
        sys.exit(2)
    texts = locate(bugs)
    targets = {bug.test[0] for bug in chosen}
    plant_all(bugs, texts, targets, options.jobs)
    programs = quick_programs()
    passes = {}
    for test in sorted({bug.test for bug in chosen}):
        passed, passes[test], by = run(test, 0, MOST_SECONDS)
        if not passed:
            sys.exit(f"mutants.py: fails without a bug: {' '.join(test)}: {by}")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(lambda bug: try_bug(bug, passes, programs), [b for b in chosen if b.body and not b.verdict]))
    for bug in [b for b in chosen if b.body is None and not b.verdict]:
        kept = (COPY / bug.file).read_bytes()
        text = texts[bug.file]
        write(COPY / bug.file, (text[: bug.span[0]] + bug.new + text[bug.span[1] :]).encode())
        if build({bug.test[0]}, options.jobs) is None:
            try_bug(bug, passes, programs)
        else:
            bug.verdict, bug.why = "stale", "does not compile"
        write(COPY / bug.file, kept)
    for bug in chosen:
        if bug.verdict == "stale":
            report(bug)
    print(f"{'list':<12} planted caught quick survived stale")
    for name in [*dict.fromkeys(b.list for b in chosen), "all"]:
        n = collections.Counter(b.verdict for b in chosen if name in (b.list, "all"))
        n_quick = sum(b.quick for b in chosen if name in (b.list, "all"))
        print(f"{name:<12} {n['caught'] + n['survives']:7} {n['caught']:6} {n_quick:5} {n['survives']:8} {n['stale']:5}")
    sys.exit(any(bug.verdict != "caught" for bug in chosen))


if __name__ == "__main__":
    main()
