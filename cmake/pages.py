#!/usr/bin/env python3
"""Refuses links of .md files that lead nowhere, and rows of tables of more than 160 characters.

    pages.py [ROOT]

A link is relative to its file; behind # stands a heading of the page that it names, as GitHub writes it.
Fenced blocks are not looked at. Exit code 1 if anything is refused.
"""
import pathlib
import re
import sys

LONGEST_ROW = 160


def prose(path):
    """(line number, line) outside of fenced blocks."""
    fenced = False
    for number, line in enumerate(path.read_text().split("\n"), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, line


def anchors(path):
    headings = (line.lstrip("#") for _, line in prose(path) if line.startswith("#"))
    return {re.sub(r"[^\w -]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}


def faults(path):
    for number, line in prose(path):
        if line.startswith("|") and len(line) > LONGEST_ROW:
            yield number, f"a row of {len(line)} characters, at most {LONGEST_ROW}: say it below the table"
        for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            if "://" in link:
                continue
            file, _, anchor = link.partition("#")
            target = (path.parent / file).resolve() if file else path
            if not target.exists():
                yield number, f"there is no {link}"
            elif anchor and (target.suffix != ".md" or anchor not in anchors(target)):
                yield number, f"{file or path.name} has no heading #{anchor}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    pages = [path for path in sorted(root.rglob("*.md")) if "build" not in path.relative_to(root).parts]
    found = [f"{path.relative_to(root)}:{number}: {fault}" for path in pages for number, fault in faults(path)]
    print("\n".join(found + [f"pages: {len(pages)} pages, {len(found)} faults"]))
    sys.exit(1 if found or not pages else 0)


main()
