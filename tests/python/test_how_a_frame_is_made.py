"""docs/how-a-frame-is-made.md names files that exist and every pass; its picture is what the plan draws."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "how-a-frame-is-made.md").read_text()


def test_every_file_that_is_named_exists():
    named = re.findall(r"`((?:src|scripts)/[\w/.]+|[\w]+\.(?:glsl|vert|frag))`", PAGE)
    assert len(named) > 30
    for name in named:
        path = ROOT / name if "/" in name else ROOT / "shaders" / name
        assert path.exists() or path.with_suffix(".h").exists(), name


def test_every_pass_is_explained(context, scene):
    frame = context.frame(8, 8, target_error=0.05, background="environment")
    for line in frame.plan_for(scene).splitlines():
        assert f"| `{line.split()[0]}` |" in PAGE


def test_the_picture_is_what_the_plan_draws():
    subprocess.run([sys.executable, str(ROOT / "scripts" / "draw_frame.py"), "--check"], check=True)
