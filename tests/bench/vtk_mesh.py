#!/usr/bin/env python3
"""What VTK takes for a frame of a DEM as one shaded mesh; bench_terrain.py runs it.

Usage: vtk_mesh.py HEIGHTS.raw COLUMNS ROWS SPACING_M FRAMES [OUT.png]

Prints one JSON object: milliseconds of each frame after one that uploads, the triangles and the device.
"""

import json
import sys
import time

import vtkmodules.all as vtk


def main():
    path, columns, rows, spacing_m, frames = sys.argv[1], *map(float, sys.argv[2:6])
    columns, rows, frames = int(columns), int(rows), int(frames)
    reader = vtk.vtkImageReader2()
    reader.SetFileName(path)
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
    window.SetSize(1280, 1024)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetViewUp(0, 0, 1)
    camera.SetPosition(-1, -1, 0.66)
    camera.SetFocalPoint(0, 0, 0)
    renderer.ResetCamera()
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
    if len(sys.argv) > 6:
        shot = vtk.vtkWindowToImageFilter()
        shot.SetInput(window)
        writer = vtk.vtkPNGWriter()
        writer.SetInputConnection(shot.GetOutputPort())
        writer.SetFileName(sys.argv[6])
        writer.Write()
    device = next((line for line in window.ReportCapabilities().splitlines() if "renderer string" in line), "")
    print(json.dumps({"times_ms": times, "processor_ms": processor_ms, "triangles": normals.GetOutput().GetNumberOfPolys(),
                      "device": device.split(":")[-1].strip(), "version": vtk.vtkVersion().GetVTKVersion()}))


if __name__ == "__main__":
    main()
