"""Colours of Relevo's overlays (core/chart/ramp.cpp), in equal steps."""

from __future__ import annotations

from typing import Dict, List, Tuple

# (red, green, blue, opacity): hexadecimal, and 0 to 1.
RAMPS: Dict[str, List[Tuple[str, float]]] = {
    "sun": [(rgb, 1.0) for rgb in ("1f2a50", "3c3f7a", "6d4c90", "a35a8c", "d5706f", "f39a4f", "fccb57", "fdf3a8")],
    "shade": [("14224d", 0.62), ("14224d", 0.0)],
    "steel": [(rgb, 1.0) for rgb in ("10151f", "35455c", "6d86a3", "b0c6d8", "f4f8fa")],
    "viridis": [(rgb, 1.0) for rgb in ("440154", "472d7b", "3b528b", "2c728e", "21918c", "28ae80", "5ec962", "addc30",
                                       "fde725")],
}  # fmt: skip


def usual_ramp(name: str, unit: str, low: float, high: float) -> Tuple[str, float, float]:
    """The ramp that Relevo itself takes for a band (usual_ramp() of core/session/overlay.cpp), and the values at its ends.

    name, unit: of the band
    low, high: smallest and largest value
    """
    if name in ("direct sun", "visible fraction of the solar disc"):
        return "shade", 0.0, 1.0
    if name == "sky-view factor":
        return "steel", min(low, 0.5), 1.0
    if unit == "h":
        return "sun", 0.0, max(high, 1.0)
    return "viridis", low, high if high > low else low + 1
