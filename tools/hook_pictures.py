#!/usr/bin/env python3
"""Draws docs/images/hooks/NAME.jpg, what each hook can change, for the plugin guide.

    tools/hook_pictures.py [RELEVO]     the program; default: build/release/bin/relevo
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEM = ROOT / "data/dem/jacksboro.tif"
WITHIN = ["--eye", "36.30,-84.20,900", "--heading", "300", "--pitch", "-4", "--time", "2026-06-21T18:30-04:00"]
OUTSIDE = ["--view", "az=200,el=25", "--time", "2026-06-21T18:30-04:00"]

# Name, what it does in the picture, and the function's body.
HOOKS = {
    "displace": "position_m += 60.0 * sin(v.ground_m.x / 150.0) * v.up;",
    "albedo": "s.diffuse = s.ambient = mix(vec3(0.7, 0.2, 0.1), vec3(0.9, 0.8, 0.3), s.height_unit);",
    "normal": "s.normal = normalize(s.normal + 0.5 * s.tangent * sin(s.ground_m.x / 40.0));",
    "material": "s.diffuse = mix(s.diffuse, vec3(0.8), smoothstep(0.8, 0.95, dot(s.normal, s.up)));",
    "facing": "factor = step(0.5, dot(s.normal, to_sun));",
    "visibility": "factor *= step(0.0, sin(s.ground_m.x / 300.0) * sin(s.ground_m.y / 300.0));",
    "brdf": "return s.diffuse * floor(4.0 * max(dot(s.normal, to_sun), 0.0)) / 4.0;",
    "ambient": "irradiance *= vec3(0.2, 0.6, 3.0);",
    "lit": "radiance = mix(radiance, vec3(dot(radiance, vec3(0.33))), 0.9);",
    "atmosphere": "radiance = mix(vec3(0.25, 0.22, 0.2), radiance, exp(-s.distance_m / 4000.0));",
    "display": "overlay = vec4(0.1, 0.3, 0.7, 1.0) * 0.7 * step(s.height_m, 400.0);",
    "side": "return mix(vec3(0.12, 0.08, 0.05), vec3(0.03), floor(8.0 * down) / 8.0);",
    "backdrop": "return mix(vec3(0.02, 0.03, 0.08), vec3(0.15, 0.12, 0.2), at.y);",
    "image": "radiance *= vec3(1.6, 0.9, 0.5);",
    "tonemap": "colour = floor(5.0 * colour / (1.0 + colour) + 0.5) / 5.0;",
    "finish": "colour *= 1.0 - 0.9 * dot(2.0 * p.at - 1.0, 2.0 * p.at - 1.0) / 2.0;",
    "overlay": "over = vec4(1.0, 1.0, 1.0, 1.0) * 0.5 * step(fract(p.at_px.x / 40.0), 0.05);",
    "sky": "float cloud = smoothstep(0.2, 0.8, sin(14.0 * direction.x / max(direction.z, 0.05)) + direction.z);\n"
           "radiance = mix(radiance, vec3(0.25), cloud); transmittance *= 1.0 - cloud;",
    "background_radiance": "return mix(vec3(0.3, 0.12, 0.05), vec3(0.02, 0.03, 0.12), sqrt(max(direction.z, 0.0)));",
}
DISPLACES = ', "displaces": {"down_m": 60, "up_m": 60}'


def signatures():
    """The signature of each hook, from the guide's table."""
    found = {}
    for line in (ROOT / "docs/plugin-guide.md").read_text().splitlines():
        if line.startswith("| vertex | `") or line.startswith("| fragment | `") or line.startswith("| post | `") \
                or line.startswith("| service | `"):
            signature = line.split("`")[1]
            name = signature.split("(")[0].split()[-1]
            found[name] = signature.replace(f" {name}(", f" show_on_{name}(")
    return found


def without_metadata(jpeg):
    """A JPEG without its scene, which has paths of this machine."""
    kept, at = bytearray(jpeg[:2]), 2
    while jpeg[at + 1] != 0xDA:  # the beginning of the picture
        end = at + 2 + int.from_bytes(jpeg[at + 2:at + 4], "big")
        if jpeg[at + 1] not in (0xE1, 0xFE):  # XMP, Exif and comments
            kept += jpeg[at:end]
        at = end
    return bytes(kept) + jpeg[at:]


def draw(relevo, folder, name, body, signature):
    plugin = folder / "show"
    plugin.mkdir(exist_ok=True)
    (plugin / "plugin.json").write_text(
        '{"format": 1, "id": "show", "name": "Show", "version": "1", "provides": ["sky"], "exclusive": ["sky"]'
        if name == "background_radiance" else '{"format": 1, "id": "show", "name": "Show", "version": "1"')
    with open(plugin / "plugin.json", "a") as manifest:
        manifest.write((DISPLACES if name == "displace" else "") + ', "after": ["materials", "sky", "haze"]}\n'
                       if name != "background_radiance" else "}\n")
    (plugin / "show.glsl").write_text(f"{signature} {{\n{body}\n}}\n")
    others = {"background_radiance": "cover,haze", "side": "cover", "backdrop": "cover"}.get(name, "cover,sky,haze")
    view = OUTSIDE if name in ("side", "backdrop") else WITHIN
    target = ROOT / f"docs/images/hooks/{name}.jpg"
    target.parent.mkdir(exist_ok=True)
    subprocess.run([relevo, "-q", "capture", DEM, "-o", target, "--overwrite", "--device", "software", "--size",
                    "300x200", "--plugin-path", folder, "--only", f"show,{others}", *view], check=True)
    target.write_bytes(without_metadata(target.read_bytes()))


def main():
    relevo = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/release/bin/relevo")
    known = signatures()
    with tempfile.TemporaryDirectory() as folder:
        for name, body in HOOKS.items():
            draw(relevo, pathlib.Path(folder), name, body, known[name])


if __name__ == "__main__":
    main()
