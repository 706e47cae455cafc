"""Pages that follow from the library are what it says: docs/how-a-frame-is-made.md with its picture, docs/settings.md.
No page names a file that does not exist."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "how-a-frame-is-made.md").read_text()


def test_every_file_that_is_named_exists():
    named = re.findall(r"`((?:src|scripts)/[\w/.]+|[\w]+\.(?:glsl|vert|frag))`", PAGE)
    assert len(named) > 30
    for name in named:
        path = ROOT / name if "/" in name else ROOT / "shaders" / name
        assert path.exists() or path.with_suffix(".h").exists(), name


PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_and_file_names_exist(page):
    text = page.read_text()
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", text):
        assert (page.parent / target).exists(), target
    for name in re.findall(r"(?<![\w/])((?:src|shaders|tests|bench|scripts|docs)/[\w./-]*\w)", text):
        path = ROOT / name
        exists = path.exists() or path.with_suffix(".h").exists()
        assert exists or list(path.parent.glob(f"{path.name}-*.md")), name  # a decision is cited by its number


def test_every_pass_is_explained(context, scene):
    frame = context.frame(8, 8, target_error=0.05, background="environment")
    for line in frame.plan_for(scene).splitlines():
        assert f"| `{line.split()[0]}` |" in PAGE


@pytest.mark.parametrize("script", ["draw_frame.py", "write_settings.py", "write_constants.py"])
def test_what_a_script_writes_is_up_to_date(script):
    subprocess.run([sys.executable, str(ROOT / "scripts" / script), "--check"], check=True)
