#!/usr/bin/env python3
"""Writes the meshes of the effect `trees` as Wavefront OBJ: a conifer and a broadleaf tree in two levels each.

Usage: tree_meshes.py FOLDER. Metres, y up, standing on y = 0. Colours are factors on the reflectance of a tree;
their mean over the surface is MEAN at every level, so that levels are equally bright.
"""

import math
import pathlib
import random
import sys

MEAN = 0.8
TRUNK = (0.55, 0.42, 0.30)


class Mesh:
    def __init__(self):
        self.points, self.colours, self.faces = [], [], []
        self.chance = random.Random(1)

    def point(self, x, y, z, shade):
        self.points.append((x, y, z))
        self.colours.append((shade,) * 3 if isinstance(shade, float) else shade)
        return len(self.points)

    def ring(self, sides, radius, y, shade, turn=0.0, wave=0.0, rough=0.0):
        """Points around the axis.

        wave: every other one is nearer to it and higher by this share of the radius
        rough: all are moved and shaded by chance, by up to this share
        """
        at = []
        for i in range(sides):
            angle = 2 * math.pi * i / sides + turn
            chance = self.chance.uniform(-rough, rough)
            r = radius * (1 - wave * (i % 2)) * (1 + chance)
            lift = radius * (0.6 * wave * (i % 2) + self.chance.uniform(-rough, rough))
            tone = shade if isinstance(shade, tuple) else shade * (1 + 1.5 * chance)
            at.append(self.point(r * math.cos(angle), y + lift, r * math.sin(angle), tone))
        return at

    def fan(self, ring, top, upwards=True):
        for i, a in enumerate(ring):
            b = ring[(i + 1) % len(ring)]
            self.faces.append((b, a, top) if upwards else (a, b, top))

    def band(self, low, high):
        for i, a in enumerate(low):
            j = (i + 1) % len(low)
            self.faces += [(low[j], a, high[i]), (low[j], high[i], high[j])]

    def trunk(self, radius, height):
        self.band(self.ring(4, radius, 0.0, TRUNK), self.ring(4, 0.8 * radius, height, TRUNK))

    def scale_colours(self):
        """Makes the mean over the surface MEAN."""
        area = total = 0.0
        for face in self.faces:
            a, b, c = (self.points[i - 1] for i in face)
            u, v = ([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)])
            cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            size = math.sqrt(sum(x * x for x in cross)) / 2
            area += size
            total += size * sum(self.colours[i - 1][1] for i in face) / 3
        factor = MEAN * area / total
        self.colours = [tuple(min(1.0, factor * x) for x in colour) for colour in self.colours]

    def write(self, file):
        self.scale_colours()
        lines = ["# made by tools/tree_meshes.py"]
        for point, colour in zip(self.points, self.colours):
            lines.append("v " + " ".join(f"{x:.4g}" for x in point + colour))
        lines += ["f " + " ".join(map(str, face)) for face in self.faces]
        file.write_text("\n".join(lines) + "\n")


def conifer(tiers, sides, trunk):
    """Cones one over the other, 16 m high and 5 m wide."""
    mesh = Mesh()
    if trunk:
        mesh.trunk(0.22, 2.0)
    low, high = 1.2, 16.0
    for tier in range(tiers):
        t = tier / tiers
        foot = low + (high - low) * t
        top = high if tier == tiers - 1 else foot + 1.7 * (high - low) / tiers
        radius = 2.5 * (1 - t) ** 0.85
        wave, rough = (0.3, 0.06) if sides > 6 else (0.0, 0.0)
        ring = mesh.ring(sides, radius, foot, 0.55, turn=0.7 * tier, wave=wave, rough=rough)
        mesh.fan(ring, mesh.point(0.0, top, 0.0, 1.0))
    return mesh


def blob(mesh, centre, radius, half, rings, sides, rough=0.0, low=1.6, high=12.0):
    """An ellipsoid; its colour is that of its height in the crown."""
    x, middle, z = centre

    def shade(y):
        return 0.4 + 0.6 * (y - low) / (high - low)

    first = len(mesh.points)
    before = None
    for ring in range(1, rings + 1):
        angle = math.pi * (ring / (rings + 1) - 0.5)
        y = middle + half * math.sin(angle)
        at = mesh.ring(sides, radius * math.cos(angle) ** 0.8, y, shade(y), turn=math.pi / sides * (ring % 2),
                       rough=rough)
        if before:
            mesh.band(before, at)
        else:
            mesh.fan(at, mesh.point(0.0, middle - half, 0.0, shade(middle - half)), upwards=False)
        before = at
    mesh.fan(before, mesh.point(0.0, middle + half, 0.0, shade(middle + half)))
    for i in range(first, len(mesh.points)):
        px, py, pz = mesh.points[i]
        mesh.points[i] = (px + x, py, pz + z)


def broadleaf(detailed):
    """A crown on a trunk, 12 m high and 9 m wide: boughs of leaves, or one rough ellipsoid."""
    mesh = Mesh()
    if not detailed:
        blob(mesh, (0.0, 6.8, 0.0), 4.4, 5.1, 5, 10, rough=0.17)
        return mesh
    mesh.trunk(0.3, 4.0)
    blob(mesh, (0.0, 8.2, 0.0), 3.0, 3.8, 3, 8, rough=0.1)
    for i in range(6):
        angle = 2 * math.pi * i / 6 + 0.3 * (i % 2)
        out, middle = (2.5, 5.2) if i % 2 else (2.3, 7.0)
        blob(mesh, (out * math.cos(angle), middle, out * math.sin(angle)), 2.2, 2.3 + 0.5 * (i % 2), 3, 7, rough=0.12)
    return mesh


def main():
    folder = pathlib.Path(sys.argv[1])
    for level, (tiers, sides, trunk) in enumerate([(7, 10, True), (4, 8, False)]):
        conifer(tiers, sides, trunk).write(folder / f"conifer_{level}.obj")
    for level, detailed in enumerate([True, False]):
        broadleaf(detailed).write(folder / f"broadleaf_{level}.obj")


if __name__ == "__main__":
    main()
