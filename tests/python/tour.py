"""Runs the cells of apps/python/TOUR.md in order, in one process, and compares what they print with the page.

    tour.py PAGE [--write]: draws the pictures beside the page, and writes the outputs into it
"""
import contextlib
import difflib
import io
import os
import pathlib
import re
import sys
import tempfile

page = pathlib.Path(sys.argv[1]).resolve()
writes = "--write" in sys.argv
text = page.read_text(encoding="utf-8")
cells = list(re.finditer(r"```python\n(.*?)```\n```text\n(.*?)```\n", text, re.S))
pictures = re.findall(r"!\[.*?\]\((.*?\.svg)\)", text)
if len(cells) < 5 or len(pictures) != 4 or len(cells) != text.count("```python"):
    sys.exit(f"tour: {page} has {len(cells)} cells with outputs and {len(pictures)} pictures; write a text block below each")
names, failed, out = {}, False, text
with tempfile.TemporaryDirectory() as scratch:
    os.chdir(page.parent if writes else scratch)
    for number, cell in enumerate(cells, 1):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(cell[1], f"{page.name}, cell {number}", "exec"), names)
        out = out.replace(cell[0], f"```python\n{cell[1]}```\n```text\n{printed.getvalue()}```\n")
        if printed.getvalue() != cell[2] and not writes:
            failed = True
            print(f"tour: cell {number} prints something else (tour.py --write writes it into the page):")
            print("\n".join(difflib.unified_diff(cell[2].splitlines(), printed.getvalue().splitlines(), "page", "run", "", "", 9, "")))
    for picture in pictures:
        drawn = pathlib.Path(picture).read_text(encoding="utf-8")
        if len(re.findall("<(?:rect|path|text)", drawn)) < 12 or not drawn.endswith("</svg>\n"):
            sys.exit(f"tour: {picture} is no picture")
        if not (page.parent / picture).exists():
            sys.exit(f"tour: {picture} is missing beside the page; run tour.py --write")
        kept = (page.parent / picture).read_text(encoding="utf-8")
        if abs(len(drawn) - len(kept)) > 0.02 * len(kept):  # another machine rounds other numbers
            failed = True
            print(f"tour: {picture} is another picture now; run tour.py --write")
    os.chdir("/")
if writes:
    page.write_text(out, encoding="utf-8")
print(f"tour: {len(cells)} cells, {len(pictures)} pictures")
sys.exit(failed)
