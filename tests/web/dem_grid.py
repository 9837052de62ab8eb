"""Heights and the coarse grid of a DEM, as the page's data have them, for tests."""

import math

import numpy as np
import rasterio
from rasterio.warp import transform


def places(dem, columns, rows):
    """Latitude and longitude [degrees] of posts, WGS 84."""
    x, y = dem.transform * (np.asarray(columns) + 0.5, np.asarray(rows) + 0.5)
    lon, lat = transform(dem.crs, "EPSG:4326", list(np.ravel(x)), list(np.ravel(y)))
    return np.array(lat), np.array(lon)


def metres(lat0, lon0, lat1, lon1):
    """East and north [m] between two near places on WGS 84."""
    phi, e2, a = math.radians((lat0 + lat1) / 2), 0.00669437999014, 6378137.0
    w = 1 - e2 * math.sin(phi) ** 2
    return (math.radians(lon1 - lon0) * a / math.sqrt(w) * math.cos(phi),
            math.radians(lat1 - lat0) * a * (1 - e2) / w ** 1.5)


def corner(dem, column, row):
    """Place, bearing of the rows' up direction [degrees] and metres of a step along columns and rows."""
    lat, lon = places(dem, [column, column + 1, column], [row, row, row - 1])
    right, up = metres(lat[0], lon[0], lat[1], lon[1]), metres(lat[0], lon[0], lat[2], lon[2])
    return {"lat": lat[0], "lon": lon[0], "convergence": math.degrees(math.atan2(*up)),
            "metres": [math.hypot(*right), math.hypot(*up)]}


def read(path):
    """Heights [m] (rows x columns, NaN: void) and the four corners, row by row."""
    with rasterio.open(path) as dem:
        heights = dem.read(1, masked=True).astype("float32").filled(np.nan)
        rows, columns = heights.shape
        return heights, [corner(dem, c, r) for r in (0, rows - 1) for c in (0, columns - 1)]
