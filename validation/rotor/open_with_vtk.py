"""Opens a run with VTK as ParaView does: fields (.foam), rock (.pvd), the turning head (.pvd), soil and feed (.vtp), and asks that they agree
in time and place.

usage: open_with_vtk.py RUN_DIRECTORY; exit codes: 0 they agree, 1 they do not, 77 VTK's Python package is not there
"""
import csv
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

try:
    from vtkmodules.vtkIOGeometry import vtkOpenFOAMReader, vtkSTLReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    from vtkmodules.vtkCommonDataModel import vtkStaticPointLocator
except ImportError as missing:
    print(f"skipped: {missing}. VTK for Python is missing (Debian: apt-get install python3-vtk9)")
    sys.exit(77)

ROCK_ARRAYS = {"id": 1, "diameter": 1, "velocity": 3, "hydrodynamic_force": 3, "contact_force": 3, "fate": 1}
failures = []


def expect(holds, text):
    if not holds:
        failures.append(text)


def series(file):
    """Files of a .pvd by time."""
    sets = ElementTree.parse(file).getroot().iter("DataSet")
    return {float(item.get("timestep")): file.parent / item.get("file") for item in sets}


def poly_data(file):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    expect(reader.GetErrorCode() == 0, f"{file} cannot be read")
    return reader.GetOutput()


def fields_at(reader, time):
    """Blocks of the mesh by name."""
    reader.UpdateTimeStep(time)
    reader.Update()
    blocks, result = [reader.GetOutput()], {}
    while blocks:
        block = blocks.pop()
        for i in range(block.GetNumberOfBlocks()):
            child, name = block.GetBlock(i), block.GetMetaData(i).Get(block.NAME())
            if child is None:
                continue
            if hasattr(child, "GetNumberOfBlocks"):
                blocks.append(child)
            result[name] = child
    return result


def open_fields(run):
    name = next(run.glob("*.foam"), run / "run.foam")
    name.touch()
    reader = vtkOpenFOAMReader()
    reader.SetFileName(str(name))
    reader.UpdateInformation()
    reader.EnableAllPatchArrays()
    reader.EnableAllCellArrays()
    reader.SkipZeroTimeOff()
    reader.UpdateInformation()
    times = reader.GetTimeValues()
    return reader, [times.GetValue(i) for i in range(times.GetNumberOfValues())]


def largest_distance(points, surface):
    """Of any of the points from the nearest corner of a surface."""
    locator = vtkStaticPointLocator()
    locator.SetDataSet(surface)
    locator.BuildLocator()
    largest = 0.0
    for i in range(points.GetNumberOfPoints()):
        point = points.GetPoint(i)
        nearest = surface.GetPoint(locator.FindClosestPoint(point))
        largest = max(largest, sum((a - b) ** 2 for a, b in zip(point, nearest)) ** 0.5)
    return largest


def check_rock(rock, mesh_bounds, time):
    data = rock.GetPointData()
    for name, components in ROCK_ARRAYS.items():
        array = data.GetArray(name)
        expect(array is not None and array.GetNumberOfComponents() == components and array.GetNumberOfTuples() == rock.GetNumberOfPoints(),
               f"t = {time}: the rock has no array {name} of {components} component(s)")
    if rock.GetNumberOfPoints() > 0:
        largest = data.GetArray("hydrodynamic_force").GetMaxNorm()
        expect(0.0 < largest < 100.0, f"t = {time}: the water pushes rock of 11 g with {largest} N")
    for i in range(rock.GetNumberOfPoints()):
        inside = all(mesh_bounds[2 * k] <= rock.GetPoint(i)[k] <= mesh_bounds[2 * k + 1] for k in range(3))
        expect(inside, f"t = {time}: a rock lies outside the mesh")


def feed_of_events(run):
    """Rows of the rock that came in."""
    rows = []
    for file in sorted(run.glob("postProcessing/rock/*/events.csv")):
        with open(file, newline="") as text:
            rows += [row for row in csv.DictReader(text) if row["surface"] == "feed"]
    return rows


def check_feed(run):
    rows, feed = feed_of_events(run), poly_data(run / "report/head/feed.vtp")
    expect(feed.GetNumberOfPoints() == len(rows) > 0 and feed.GetNumberOfVerts() == len(rows),
           f"{feed.GetNumberOfPoints()} points of the feed, {len(rows)} rocks came in")
    arrays = {name: feed.GetPointData().GetArray(name) for name in ("id", "time", "diameter")}
    expect(all(arrays.values()), "the feed lacks an array")
    for i, row in enumerate(rows[:feed.GetNumberOfPoints()]):
        distance = max(abs(feed.GetPoint(i)[k] - float(row[name])) for k, name in enumerate(("x_m", "y_m", "z_m")))
        expect(distance < 1e-6, f"rock {row['id']} came in {distance:.2g} m from its point of the feed")
        expect(arrays["id"].GetValue(i) == int(row["id"]), f"point {i} of the feed is not rock {row['id']}")


def check_bank(run):
    """The soil's file and that of the report are one surface."""
    given, shown = vtkSTLReader(), poly_data(run / "report/head/bank.vtp")
    given.SetFileName(str(run / "geometry/bank.stl"))
    given.Update()
    soil = given.GetOutput()
    expect(soil.GetNumberOfPolys() > 0 and shown.GetNumberOfPolys() == soil.GetNumberOfPolys(), "the soil lacks triangles")
    size = max(soil.GetBounds()[2 * k + 1] - soil.GetBounds()[2 * k] for k in range(3))
    off = max(abs(a - b) for a, b in zip(soil.GetBounds(), shown.GetBounds()))
    expect(off < 1e-4 * size, f"the soil is {off:.2g} m off its place")


def main():
    run = pathlib.Path(sys.argv[1])
    rocks, heads = series(run / "postProcessing/rock/rocks.pvd"), series(run / "report/head/head.pvd")
    reader, times = open_fields(run)
    expect(len(rocks) >= 2, "fewer than two pictures of the rock")
    check_feed(run)
    check_bank(run)
    for name, known in (("field", times), ("head", list(heads))):
        missing = [time for time in rocks if not any(abs(time - other) <= 1e-6 * max(1.0, time) for other in known)]
        expect(not missing, f"times of the rock without a {name}: {missing}")
    moved, seen = [], 0
    for time, file in rocks.items():
        blocks, rock, head = fields_at(reader, time), poly_data(file), poly_data(heads[min(heads, key=lambda other: abs(other - time))])
        seen += rock.GetNumberOfPoints()
        check_rock(rock, blocks["internalMesh"].GetBounds(), time)
        expect(blocks["internalMesh"].GetCellData().GetArray("U") is not None, f"t = {time}: no velocity")
        # The mesh's cutter and the series' were made from one surface; each turned by its own program.
        distance = largest_distance(blocks["cutter"], head)
        expect(distance < 1e-5, f"t = {time}: the mesh's cutter is {distance:.2g} m from the head of the series")
        moved.append(head.GetPoint(0))
    expect(seen > 0, "no rock in any picture")
    expect(len(set(moved)) == len(moved), "the head does not turn")
    for text in dict.fromkeys(failures):
        print(text)
    print(f"{len(rocks)} times of fields, rock and head opened, {seen} rocks, soil and feed")
    sys.exit(1 if failures else 0)


main()
