"""The book as a site: a page for each chapter and each notebook, and the reference of the scene file from its schema.

    python book/site.py OUT [--stickslip PROGRAM] [--run]

With --run the notebooks are executed, and their pages have what their cells show; this takes the package installed, and
a while. Formulas become MathML, which browsers draw without a script. A link that leads nowhere ends it with exit code
1. Needs markdown-it-py, mdit-py-plugins and latex2mathml; the schema is that of PROGRAM, by default `stickslip`.
"""

from __future__ import annotations

import argparse
import ast
import base64
import contextlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert
from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.dollarmath import dollarmath_plugin

BOOK = Path(__file__).parent
REPOSITORY = BOOK.parent
OUTPUT = "output of a cell"
"""Marks blocks that are HTML as it is."""
STYLE = """
:root { color-scheme: light dark; --line: #8884; }
body { font: 16px/1.55 system-ui, sans-serif; margin: 0; display: flex; }
nav { width: 17em; flex: none; height: 100vh; overflow: auto; position: sticky; top: 0; padding: 1em;
      box-sizing: border-box; border-right: 1px solid var(--line); }
nav a { display: block; padding: .15em 0; text-decoration: none; } nav a.here { font-weight: bold; }
main { max-width: 50em; padding: 1em 2.5em 4em; min-width: 0; flex: 1; }
pre { overflow: auto; padding: .8em; border: 1px solid var(--line); border-radius: 4px; }
code { font-size: .9em; } img { max-width: 100%; } table { border-collapse: collapse; display: block; overflow: auto; }
td, th { border: 1px solid var(--line); padding: .25em .6em; text-align: left; vertical-align: top; }
.math.block { display: flex; align-items: center; } a { color: #2a6fb0; }
math[display=block] { margin: 1em 0; overflow: auto hidden; flex: 1; }
@media (max-width: 50em) { body { display: block; } nav { width: auto; height: auto; position: static; } }
"""


def slug(heading: str) -> str:
    """The anchor of a heading, as GitHub makes it."""
    kept = re.sub(r"[^\w\- ]", "", heading.replace("`", "").lower())
    return kept.replace(" ", "-")


def math(text: str, options: dict[str, Any]) -> str:
    """A formula of TeX as MathML; the number of an equation stands beside it."""
    tag = re.search(r"\\tag\{([^}]*)\}", text)
    body = re.sub(r"\\tag\{[^}]*\}", "", text).strip()
    drawn = convert(body, display="block" if options["display_mode"] else "inline")
    return drawn + (f"<span>({escape(tag[1])})</span>" if tag else "")


def reader() -> MarkdownIt:
    """What reads a chapter."""
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    return markdown.use(dollarmath_plugin, renderer=math, allow_space=True)


class Page:
    """A chapter: its text, its title, its anchors and where its links lead."""

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        self.tokens = reader().parse(text)
        for token in self.tokens:
            if token.type == "fence" and token.info == OUTPUT:
                token.type = "html_block"
        self.anchors: set[str] = set()
        self.title = name
        for opening, inline in zip(self.tokens, self.tokens[1:]):
            if opening.type == "heading_open":
                anchor = slug(inline.content)
                opening.attrSet("id", anchor)
                self.anchors.add(anchor)
                if opening.tag == "h1":
                    self.title = inline.content

    @property
    def file(self) -> str:
        """Its file in the site."""
        return "index.html" if self.name == "SUMMARY.md" else f"{Path(self.name).stem}.html"

    def links(self) -> Iterator[tuple[Token, str]]:
        """What leads elsewhere, and the attribute that says where."""
        for token in (child for token in self.tokens for child in token.children or []):
            if token.type in ("link_open", "image"):
                yield token, "href" if token.type == "link_open" else "src"

    def html(self) -> str:
        """Its contents."""
        markdown = reader()
        return markdown.renderer.render(self.tokens, markdown.options, {})


def displayed(value: Any) -> str:
    """What a notebook shows of a value, as HTML."""
    for way in ("_repr_html_", "_repr_svg_"):
        shown = getattr(value, way, lambda: None)()
        if shown is not None:
            return str(shown)
    png = getattr(value, "_repr_png_", lambda: None)()
    if png is not None:
        return f'<img src="data:image/png;base64,{base64.b64encode(png).decode()}">'
    return "" if value is None else f"<pre>{escape(repr(value))}</pre>"


def output(source: str, names: dict[str, Any]) -> str:
    """Executes a cell with the names that those before it made, and gives what it shows, as HTML."""
    code = ast.parse(source)
    last = code.body.pop() if code.body and isinstance(code.body[-1], ast.Expr) else None
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "cell", "exec"), names)
        value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None
    text = printed.getvalue()
    return (f"<pre>{escape(text)}</pre>" if text else "") + displayed(value)


def text_of(name: str, run: bool) -> str:
    """A chapter, or a notebook as one: its code in blocks, and the notebook itself behind a link."""
    text = (BOOK / name).read_text(encoding="utf-8")
    if not name.endswith(".ipynb"):
        return text
    parts: list[str] = []
    names: dict[str, Any] = {}
    here = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for cell in json.loads(text)["cells"]:
                source = "".join(cell["source"])
                if cell["cell_type"] == "markdown":
                    parts.append(source)
                    continue
                parts.append(f"```python\n{source}\n```")
                shown = output(source, names) if run else ""
                parts += [f"```{OUTPUT}\n{shown}\n```"] if shown else []
        finally:
            os.chdir(here)
    file = Path(name).name
    return "\n\n".join([*parts, f"This page is a notebook, [{file}]({file}), which the tests run."])


def reference(schema: dict[str, Any]) -> str:
    """The scene file from its schema, as Markdown: a table of keys for each of its tables."""
    definitions = schema.get("$defs", {})
    done: set[str] = set()
    lines = ["# Reference of the scene file", "", "Every key, from `stickslip schema`. [The chapter](02-scene-file.md)",
             "explains them, with defaults and examples.", ""]

    def resolved(node: Any) -> dict[str, Any]:
        while isinstance(node, dict) and "$ref" in node:
            node = {**definitions[node["$ref"].rsplit("/", 1)[1]], **{k: v for k, v in node.items() if k != "$ref"}}
        return node if isinstance(node, dict) else {}

    def kind(node: dict[str, Any]) -> str:
        words = [str(choice["const"]) for choice in node.get("oneOf", []) if "const" in choice]
        words += list(map(str, node.get("enum", [])))
        if words:
            return ", ".join(f"`{word}`" for word in words)
        found = node.get("type", [resolved(choice).get("type", "") for choice in node.get("anyOf", [])])
        names = [found] if isinstance(found, str) else [name for name in found if isinstance(name, str) and name]
        return " or ".join(dict.fromkeys(name for name in names if name != "null"))

    def inner(node: dict[str, Any]) -> Iterator[dict[str, Any]]:
        yield node
        for choice in [*node.get("anyOf", []), *node.get("oneOf", [])]:
            yield resolved(choice)
        for below in ("items", "additionalProperties"):
            if isinstance(node.get(below), dict):
                yield from inner(resolved(node[below]))

    def table(path: str, node: dict[str, Any]) -> None:
        key = json.dumps(node.get("properties", {}), sort_keys=True)
        if not node.get("properties") or key in done:
            return
        done.add(key)
        lines.extend([f"## {path or 'Top of the file'}", "", node.get("description", "").replace("\n", " "), ""])
        lines.extend(["| key | value | what it is |", "|---|---|---|"])
        below = []
        for name, entry in node["properties"].items():
            entry = resolved(entry)
            about = entry.get("description", "").replace("\n", " ").replace("|", "\\|")
            needed = " Required." if name in node.get("required", []) else ""
            lines.append(f"| `{name}` | {kind(entry)} | {about}{needed} |")
            below.append((f"{path}.{name}".lstrip("."), entry))
        lines.append("")
        for place, entry in below:
            for part in inner(entry):
                table(place, part)

    table("", resolved(schema))
    return "\n".join(lines)


def site(out: Path, program: str, run: bool = False) -> list[str]:
    """Writes the site, its notebooks executed or as they are, and tells which links lead nowhere."""
    summary = (BOOK / "SUMMARY.md").read_text(encoding="utf-8")
    names = re.findall(r"^- \[[^\]]*\]\(([^)]*\.md)\)", summary, re.MULTILINE)
    names += re.findall(r"\]\(([^)]*\.ipynb)\)", summary)
    pages = [Page("SUMMARY.md", summary), *(Page(name, text_of(name, run)) for name in names)]
    schema = subprocess.run([program, "schema"], capture_output=True, text=True, encoding="utf-8", check=True)
    pages.append(Page("reference.md", reference(json.loads(schema.stdout))))
    by_name = {page.name: page for page in pages}
    out.mkdir(parents=True, exist_ok=True)
    wrong = []
    for page in pages:
        for token, attribute in page.links():
            target = str(token.attrGet(attribute))
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            place = os.path.normpath(Path(page.name).parent / path)
            other = by_name.get(place) if path else page
            file = (BOOK / place).resolve()
            # A notebook's link to itself leads to its file.
            if other is not None and (other is not page or not path):
                if anchor and anchor not in other.anchors:
                    wrong.append(f"{page.name}: {target} has no such heading")
                token.attrSet(attribute, other.file + (f"#{anchor}" if anchor else ""))
            elif not file.exists() or not file.is_relative_to(REPOSITORY.resolve()):
                wrong.append(f"{page.name}: {target} is not there")
            elif file.is_file():
                # What lies in the repository comes along.
                copy = out / "files" / file.relative_to(REPOSITORY.resolve())
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, copy)
                token.attrSet(attribute, copy.relative_to(out).as_posix())
    for page in pages:
        (out / page.file).write_text(whole(page, pages), encoding="utf-8")
    return wrong


def whole(page: Page, pages: list[Page]) -> str:
    """A page with the list of all beside it."""

    def entry(other: Page) -> str:
        here = ' class="here"' if other is page else ""
        return f'<a href="{other.file}"{here}>{escape(other.title)}</a>'

    head = f"<!DOCTYPE html><html lang=en><meta charset=utf-8><title>{escape(page.title)}</title>"
    view = '<meta name=viewport content="width=device-width, initial-scale=1">'
    return f"{head}{view}<style>{STYLE}</style><nav>{''.join(map(entry, pages))}</nav><main>{page.html()}</main></html>\n"


def main() -> int:
    """Makes the site."""
    parser = argparse.ArgumentParser(description="The book as a site")
    parser.add_argument("out", type=Path, help="folder of the site")
    parser.add_argument("--stickslip", default="stickslip", help="the program whose schema is shown")
    parser.add_argument("--run", action="store_true", help="execute the notebooks, and show what their cells do")
    given = parser.parse_args()
    wrong = site(given.out.absolute(), given.stickslip, given.run)
    for line in wrong:
        print(f"error: {line}", file=sys.stderr)
    print(f"{given.out / 'index.html'} is written")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
