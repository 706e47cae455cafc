"""Renders a built-in material under a map, and looks at the bandwidths that the renderer predicted.

    python look_at_bandwidth.py [map.exr] [sheet.png]

The map defaults to the one in data/; the sheet of all fields needs Matplotlib.
"""

import sys
from pathlib import Path

import numpy as np

import lightband
from lightband import pictures

default_map = Path(__file__).resolve().parents[2] / "data" / "courtyard.exr"
map_path = sys.argv[1] if len(sys.argv) > 1 else default_map
sheet_path = sys.argv[2] if len(sys.argv) > 2 else "bandwidth.png"

# What is seen: two shapes of two materials under one map.
context = lightband.Context(device="any")
scene = context.scene()
scene.environment = context.load_environment(map_path)
scene.camera(eye=(0, 0.3, 2.4), target=(0, 0, 0))
left = np.eye(4)
left[0, 3] = -0.6  # metres
right = np.eye(4)
right[0, 3] = 0.6
scene.add(context.builtin_mesh("knot"), context.builtin_brdf("rough-gold"), left)
scene.add(context.builtin_mesh("sphere"), context.builtin_brdf("blue-rubber"), right)

# The picture, at 64 light samples per shaded pixel on average.
frame = context.frame(512, 320, samples=64, background="environment", pass_times="on")
frame.render(scene, progress=lambda fraction: print(f"\r{100 * fraction:3.0f} %", end=""))
print(f"\ron {context.device_name}\n{frame.plan}")

# The fields are NumPy arrays: how much of each material may be interpolated, and why.
material, bandwidth, shaded = frame.material, frame.bandwidth_image, frame.shaded
for index, name in enumerate(["rough-gold", "blue-rubber"]):
    pixels = material == index + 1
    median = np.median(bandwidth[pixels])
    print(f"{name}: {pixels.sum()} pixels, median bandwidth {median:.3f} cycles/pixel, {shaded[pixels].mean():.0%} shaded")

# Predicted and measured variance can be compared where at least two samples were drawn.
drawn = frame.sample_count >= 2
agreement = pictures.rank_correlation(frame.variance_predicted[drawn], frame.variance_measured[drawn])
print(f"variance of one sample: rank correlation of prediction and measurement {agreement:.2f}")

pictures.draw_fields(frame, sheet_path)
print(f"all fields: {sheet_path}")
