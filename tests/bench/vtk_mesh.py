#!/usr/bin/env python3
"""What VTK takes for a frame of a DEM as one shaded mesh; bench_terrain.py and frame.py run it.

Usage: vtk_mesh.py HEIGHTS.raw COLUMNS ROWS SPACING_M FRAMES [OUT.png] [--size 1280x1024] [--zoom 1]

Prints one JSON object: milliseconds of each frame after one that uploads, the triangles and the device.
"""

import argparse
import json
import time

import vtkmodules.all as vtk


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path")
    for name, kind in (("columns", int), ("rows", int), ("spacing_m", float), ("frames", int)):
        parser.add_argument(name, type=kind)
    parser.add_argument("picture", nargs="?")
    parser.add_argument("--size", default="1280x1024")
    parser.add_argument("--zoom", type=float, default=1, help="how much nearer than the whole mesh the camera stands")
    arguments = parser.parse_args()
    columns, rows, spacing_m, frames = arguments.columns, arguments.rows, arguments.spacing_m, arguments.frames
    reader = vtk.vtkImageReader2()
    reader.SetFileName(arguments.path)
    reader.SetFileDimensionality(2)
    reader.SetDataScalarTypeToFloat()
    reader.SetDataByteOrderToLittleEndian()
    reader.FileLowerLeftOff()
    reader.SetDataExtent(0, columns - 1, 0, rows - 1, 0, 0)
    reader.SetDataSpacing(spacing_m, spacing_m, 1)
    surface = vtk.vtkImageDataGeometryFilter()
    surface.SetInputConnection(reader.GetOutputPort())
    warp = vtk.vtkWarpScalar()
    warp.SetInputConnection(surface.GetOutputPort())
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(warp.GetOutputPort())
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(triangles.GetOutputPort())
    normals.SplittingOff()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    renderer = vtk.vtkRenderer()
    renderer.AddActor(actor)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*map(int, arguments.size.split("x")))
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetViewUp(0, 0, 1)
    camera.SetPosition(-1, -1, 0.66)
    camera.SetFocalPoint(0, 0, 0)
    renderer.ResetCamera()
    camera.Dolly(arguments.zoom)
    renderer.ResetCameraClippingRange()
    window.Render()
    times = []
    processor_began = time.process_time()
    for _ in range(frames):
        camera.Azimuth(0.01)
        renderer.ResetCameraClippingRange()
        began = time.perf_counter()
        window.Render()
        window.WaitForCompletion()
        times.append((time.perf_counter() - began) * 1e3)
    processor_ms = (time.process_time() - processor_began) * 1e3 / frames
    if arguments.picture:
        shot = vtk.vtkWindowToImageFilter()
        shot.SetInput(window)
        writer = vtk.vtkPNGWriter()
        writer.SetInputConnection(shot.GetOutputPort())
        writer.SetFileName(arguments.picture)
        writer.Write()
    device = next((line for line in window.ReportCapabilities().splitlines() if "renderer string" in line), "")
    print(json.dumps({"times_ms": times, "processor_ms": processor_ms, "triangles": normals.GetOutput().GetNumberOfPolys(),
                      "device": device.split(":")[-1].strip(), "version": vtk.vtkVersion().GetVTKVersion()}))


if __name__ == "__main__":
    main()
