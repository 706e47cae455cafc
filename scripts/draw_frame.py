"""Draws docs/how-a-frame-is-made.svg: the passes of a frame in their order, and the buffers between them.

    python scripts/draw_frame.py            # writes the picture
    python scripts/draw_frame.py --check    # fails where the picture is not what would be written

Passes and buffers are those of Frame.plan_for, so that the picture cannot differ from what the library does.
"""
from __future__ import annotations

from pathlib import Path

import lightband
from written_file import write_or_check

TARGET = Path(__file__).parent.parent / "docs" / "how-a-frame-is-made.svg"
GROUPS = (  # title, passes, colour of the box
    ("Geometry", ("gbuffer", "covered"), "#e8eef6"),
    ("Prediction", ("environment", "bandwidth"), "#e6f3ea"),
    ("Control set", ("control", "pilot", "recheck", "replace"), "#fbf1dd"),
    ("Each round",
     ("pyramids", "classify", "list", "shade", "upsample", "estimate"), "#f6e7ea"),
    ("End", ("combine", "background"), "#eeeaf5"),
)
ROW, GAP, MARGIN, NAME, COLUMN = 26, 30, 16, 118, 62  # pixels
FONT = "font-family='Helvetica, Arial, sans-serif'"


def passes_of_a_frame() -> dict[str, tuple[list[str], list[str]]]:
    """What each pass reads and writes, of a frame that is asked for an error, with all passes."""
    context = lightband.Context(device="software")
    scene = context.scene()
    scene.environment = context.environment([[[1.0, 1.0, 1.0]]])
    scene.camera(eye=(0, 0, 2), target=(0, 0, 0))
    scene.add(context.builtin_mesh("sphere", 8), context.lambert(0.5))
    frame = context.frame(64, 64, target_error=0.05, background="environment", allocation="constant_variance")
    passes = {}
    for line in frame.plan_for(scene).splitlines():
        name, *rest = line.split("; ")
        found = {part.split(" ", 1)[0]: part.split(" ", 1)[1].split(", ") for part in rest if part.startswith(("reads ", "writes "))}
        passes[name.split()[0]] = found.get("reads", []), found.get("writes", [])
    return passes


def drawing(passes: dict[str, tuple[list[str], list[str]]]) -> str:
    buffers = []
    for _, writes in passes.values():
        buffers += [name for name in writes if name not in buffers]
    left = MARGIN + NAME
    width = left + COLUMN * len(buffers) + MARGIN
    lines, y, rows = [], 112, {}
    for title, names, colour in GROUPS:
        height = ROW * len(names) + 26
        lines.append(f"<rect x='{MARGIN / 2}' y='{y}' width='{width - MARGIN}' height='{height}' rx='6' fill='{colour}'/>")
        lines.append(f"<text x='{MARGIN}' y='{y + 17}' {FONT} font-size='12' font-weight='bold' fill='#333'>{title}</text>")
        for i, name in enumerate(names):
            rows[name] = y + 26 + ROW * i + ROW / 2
            lines.append(f"<text x='{MARGIN + 8}' y='{rows[name] + 4}' {FONT} font-size='13' fill='#111'>{name}</text>")
        y += height + GAP / 2
    for i, buffer in enumerate(buffers):
        x = left + COLUMN * i + COLUMN / 2
        used = [rows[name] for name, (reads, writes) in passes.items() if buffer in reads + writes]
        lines.append(f"<line x1='{x}' y1='{min(used)}' x2='{x}' y2='{max(used)}' stroke='#999' stroke-width='1.5'/>")
        lines.append(f"<text x='{x}' y='104' transform='rotate(-50 {x} 104)' {FONT} font-size='12' fill='#333'>{buffer}</text>")
        for name, (reads, writes) in passes.items():
            if buffer in writes:
                lines.append(f"<circle cx='{x}' cy='{rows[name]}' r='5.5' fill='#b5322e'/>")
            elif buffer in reads:
                lines.append(f"<circle cx='{x}' cy='{rows[name]}' r='4.5' fill='white' stroke='#2b6ca3' stroke-width='2'/>")
    key = y + 12
    lines.append(f"<circle cx='{MARGIN + 8}' cy='{key}' r='5.5' fill='#b5322e'/>"
                 f"<text x='{MARGIN + 20}' y='{key + 4}' {FONT} font-size='12' fill='#333'>writes</text>"
                 f"<circle cx='{MARGIN + 78}' cy='{key}' r='4.5' fill='white' stroke='#2b6ca3' stroke-width='2'/>"
                 f"<text x='{MARGIN + 90}' y='{key + 4}' {FONT} font-size='12' fill='#333'>reads</text>")
    body = "\n".join(lines)
    return (f"<svg xmlns='http://www.w3.org/2000/svg' width='{width + 40}' height='{key + 20}' viewBox='0 0 {width + 40} {key + 20}'>\n"
            f"<rect width='100%' height='100%' fill='white'/>\n{body}\n</svg>\n")


if __name__ == "__main__":
    write_or_check(__doc__, TARGET, drawing(passes_of_a_frame()))
