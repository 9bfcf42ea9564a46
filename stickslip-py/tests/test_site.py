"""The book becomes a site, notebooks as pages of it, and no link leads nowhere."""

from __future__ import annotations

import importlib.util
import re
from types import ModuleType, SimpleNamespace

import pytest
from conftest import REPOSITORY

for package in ("markdown_it", "mdit_py_plugins", "latex2mathml"):
    pytest.importorskip(package)


@pytest.fixture
def maker() -> ModuleType:
    """`book/site.py`."""
    spec = importlib.util.spec_from_file_location("site_of_the_book", REPOSITORY / "book/site.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_cells_show_what_notebooks_do(maker):
    names: dict = {}
    assert maker.output("x = 2", names) == ""
    assert maker.output("print('a < b')\nx + 1", names) == "<pre>a &lt; b\n</pre><pre>3</pre>"
    names["picture"] = SimpleNamespace(_repr_png_=lambda: b"\x89PNG")
    shown = maker.output("picture", names)
    assert shown == '<img src="data:image/png;base64,iVBORw==">'
    page = maker.Page("any.md", f"# Any\n\n```{maker.OUTPUT}\n{shown}\n```\n\n```text\n{shown}\n```")
    assert page.html().count(shown) == 1, "of outputs alone"


def test_chapters_and_notebooks_are_pages(maker, command, tmp_path):
    assert maker.site(tmp_path, command) == [], "links that lead nowhere"
    index = (tmp_path / "index.html").read_text(encoding="utf-8")
    notebooks = sorted((REPOSITORY / "book/tutorials").glob("*.ipynb"))
    chapters = sorted((REPOSITORY / "book").glob("[0-9]*.md"))
    assert notebooks and chapters
    for path in [*chapters, *notebooks]:
        assert f'href="{path.stem}.html"' in index, path
    for path in notebooks:
        page = (tmp_path / f"{path.stem}.html").read_text(encoding="utf-8")
        assert 'class="language-python"' in page and "import stickslip as ss" in page and "<h1" in page
        (copy,) = re.findall(r'href="(files/[^"]*\.ipynb)"', page)
        assert (tmp_path / copy).read_bytes() == path.read_bytes(), "the notebook itself comes along"
