#!/usr/bin/env python3
"""Turns equations.txt into one MathML file for each equation, for inclusion in doc comments.

Needs the package latex2mathml; see README.md. With --check, writes nothing and fails if a file is
missing, stale or left over.
"""

import html
import pathlib
import re
import sys

import latex2mathml.converter

# What browsers find on the common systems; `math` is whatever the reader has chosen.
FONTS = "math, STIX Two Math, Cambria Math, Latin Modern Math, serif"
HERE = pathlib.Path(__file__).parent


def read(path):
    """The equations as name -> TeX; a line that starts with a space continues the one before."""
    equations = {}
    name = None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            name = None
        elif line.startswith(" ") and name:
            equations[name] += " " + line.strip()
        elif match := re.fullmatch(r"([a-z][a-z0-9_]*) = (.*)", line):
            name = match[1]
            if name in equations:
                sys.exit(f"{path}:{number}: `{name}` is defined twice")
            equations[name] = match[2].strip()
        else:
            sys.exit(f"{path}:{number}: expected `name = TeX` or an indented continuation")
    return equations


def keep_side(match):
    """An attribute of a table as CSS: the cell of a left side ends where that of its right begins."""
    if match[1] != "columnalign":
        return ""
    if "right" in match[0]:
        # Chromium aligns a cell of MathML only by its own keyword; others drop it.
        return ' style="text-align: right; text-align: -webkit-right; padding: 0.3em 0 0.3em 0.7em"'
    return ' style="text-align: left; padding: 0.3em 0.8em 0.3em 0"'


def page(name, tex):
    """The HTML of one equation: no blank line, so that Markdown passes it through whole."""
    mathml = latex2mathml.converter.convert(tex, display="block")
    if re.search(r"<m[ior]>(\\|&(amp;)?<)", mathml):
        sys.exit(f"{name}: a command was not understood: {mathml}")
    body = re.sub(r"^<math[^>]*>|</math>$", "", mathml)
    # Characters instead of references, but for the three that HTML keeps.
    body = re.sub(
        r"&#x([0-9A-Fa-f]+);",
        lambda m: html.escape(chr(int(m[1], 16)), quote=False),
        body,
    )
    # TeX sets capital Greek letters and the d of a derivative upright; one-letter <mi> is italic.
    body = re.sub(r"<mi>([ΓΔΠΣΩ])</mi>", r'<mi mathvariant="normal">\1</mi>', body)
    if r"\mathrm{d}" in tex:
        body = body.replace("<mi>d</mi>", '<mi mathvariant="normal">d</mi>')
    # Browsers take alignment from CSS, not from the old attributes.
    body = re.sub(r' (rowspacing|columnspacing|columnalign)="[^"]*"(?=[^<]*>)', keep_side, body)
    # A row of a table on a line of its own keeps differences readable.
    body = body.replace("<mtr>", "\n<mtr>")
    alt = html.escape(re.sub(r"\s+", " ", tex), quote=True)
    return (
        '<div style="overflow: auto hidden; margin: 1em 0">\n'
        f'<math display="block" style="font-family: {FONTS}" alttext="{alt}">\n{body}\n</math>\n</div>\n'
    )


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(f"usage: {sys.argv[0]} [--check]")
    equations = read(HERE / "equations.txt")
    wanted = {HERE / f"{name}.html": page(name, tex) for name, tex in equations.items()}
    wrong = [path for path in HERE.glob("*.html") if path not in wanted]
    if check:
        for path, text in wanted.items():
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                wrong.append(path)
        if wrong:
            sys.exit("run build.py: " + ", ".join(sorted(path.name for path in wrong)))
        return
    for path in wrong:
        path.unlink()
    for path, text in wanted.items():
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
