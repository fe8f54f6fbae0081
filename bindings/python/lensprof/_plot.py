"""Charts, where matplotlib is installed."""
from __future__ import annotations

from typing import Any

import numpy as np


def plot_profile(profile: Any) -> Any:
    """The response, and the relative illuminance from the centre to the corner with its standard error."""
    from matplotlib.figure import Figure  # type: ignore[import,unused-ignore]

    figure = Figure(figsize=(9, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    light, radii = np.linspace(0.0, 1.0, 256), np.linspace(0.0, 1.0, 101)
    left.plot(light, [profile.response[0].eval(x) for x in light])
    left.set(xlabel="irradiance", ylabel="grey value", title="response")
    colours = ("tab:blue",) if len(profile.vignetting) == 1 else ("tab:red", "tab:green", "tab:blue")
    for channel, colour in enumerate(colours):
        falloff = [profile.radial_falloff(r, channel) for r in radii]
        values = np.array([m for m, _ in falloff])
        sigmas = np.array([sigma or 0.0 for _, sigma in falloff])
        right.plot(radii, values, color=colour)
        right.fill_between(radii, values - sigmas, values + sigmas, color=colour, alpha=0.25)
    right.set(xlabel="radius, half diagonals", ylabel="relative illuminance", title="vignetting", ylim=(0.0, 1.05))
    return figure
