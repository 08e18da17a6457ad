"""Opens an export in ParaView as described in its README.txt, and draws it without a display.

pvpython --force-offscreen-rendering render_paraview.py FOLDER_OF_REPLICA PICTURE; prints the data that it read, as
JSON.
"""
import glob
import json
import sys

from paraview.simple import (ColorBy, CreateRenderView, ExtractSurface, GetActiveCamera, GetColorTransferFunction,
                             GetScalarBar, Glyph, OpenDataFile, Render, SaveScreenshot, Show, Tube)

folder, picture = sys.argv[1:3]


def series(name):
    reader = OpenDataFile(sorted(glob.glob(f"{folder}/{name}_*.hdf")))
    reader.UpdatePipeline(reader.TimestepValues[-1])
    return reader


view = CreateRenderView(ViewSize=[700, 600], Background=[1, 1, 1], OrientationAxesVisibility=0,
                        UseColorPaletteForBackground=0)
grains, contacts, forces, walls = map(series, ("grains", "contacts", "forces", "walls"))
view.ViewTime = grains.TimestepValues[-1]

spheres = Glyph(grains, GlyphType="Sphere", OrientationArray="No orientation array", ScaleArray=["POINTS", "diameter"],
                GlyphMode="All Points")
spheres.ScaleFactor = 1
spheres.GlyphType.Radius = 0.5
spheres.GlyphType.ThetaResolution = spheres.GlyphType.PhiResolution = 24
shown = Show(spheres, view)
shown.Opacity = 0.3
shown.ColorArrayName = [None, ""]
shown.DiffuseColor = shown.AmbientColor = [0.4, 0.55, 0.8]

tubes = Tube(ExtractSurface(contacts), Scalars=["POINTS", "force_magnitude"], VaryRadius="By Scalar", Radius=0.0004, RadiusFactor=6)
shown = Show(tubes, view)
ColorBy(shown, ("POINTS", "force_magnitude"))
shown.SetScalarBarVisibility(view, True)
colours = GetColorTransferFunction("force_magnitude")
colours.RescaleTransferFunction(*contacts.PointData["force_magnitude"].GetRange())
bar = GetScalarBar(colours, view)
bar.TitleColor = bar.LabelColor = [0, 0, 0]

arrows = Glyph(forces, GlyphType="Arrow", OrientationArray=["POINTS", "force"], ScaleArray=["POINTS", "force"],
               GlyphMode="All Points")
arrows.ScaleFactor = 0.02 / forces.PointData["force_magnitude"].GetRange()[1]
shown = Show(arrows, view)
shown.ColorArrayName = [None, ""]
shown.DiffuseColor = shown.AmbientColor = [0.1, 0.1, 0.1]
shown = Show(walls, view)
shown.Opacity = 0.15
shown.ColorArrayName = [None, ""]

view.ResetCamera()
camera = GetActiveCamera()
camera.SetViewUp(0, 0, 1)
focus = camera.GetFocalPoint()
camera.SetPosition(focus[0] + 1, focus[1] - 2, focus[2] + 0.7)
view.ResetCamera()
Render(view)
SaveScreenshot(picture, view)
print(json.dumps({"scans": len(grains.TimestepValues), "grains": grains.GetDataInformation().GetNumberOfPoints(),
                  "contacts": contacts.GetDataInformation().GetNumberOfCells(),
                  "strongest": contacts.PointData["force_magnitude"].GetRange()[1],
                  "spheres_wide": spheres.GetDataInformation().GetBounds()[1] - spheres.GetDataInformation().GetBounds()[0],
                  "arrows": forces.GetDataInformation().GetNumberOfPoints(),
                  "walls": walls.GetDataInformation().GetNumberOfCells(),
                  "tubes": tubes.GetDataInformation().GetNumberOfCells()}))
