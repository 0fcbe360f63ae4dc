#!/usr/bin/env python3
"""read_vtp.py FILE.vtp FILE.csv DIM TIME: read a particle file with the reader that ParaView uses
and compare every array with the comma-separated values of the same particles."""
import csv
import struct
import sys

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

vtp, table, dim, time = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
reader = vtkXMLPolyDataReader()
reader.SetFileName(vtp)
reader.Update()
data = reader.GetOutput()
with open(table, newline="") as file:
    names, *lines = list(csv.reader(file))
rows = [[float(cell) for cell in line] for line in lines]
column = {name: k for k, name in enumerate(names)}
point_data = data.GetPointData()


def near(got, want, single):
    if single:
        want = struct.unpack("f", struct.pack("f", want))[0]
    return got == want


def expect(what, got, want, single=False):
    if not near(got, want, single):
        sys.exit(f"{what}: {got!r}, not {want!r}")


def plain(name, columns, array):
    single = array.GetDataTypeAsString() == "float"
    for i, row in enumerate(rows):
        for c, which in enumerate(columns):
            want = row[column[which]] if which else 0.0
            expect(f"{name}[{i}][{c}]", array.GetComponent(i, c), want, single)


def tensor(name):
    letters = "xyz"[:dim]
    columns = []
    for a in "xyz":
        for b in "xyz":
            full, packed = f"{name}_{a}{b}", f"{name}_{min(a, b)}{max(a, b)}"
            known = full if full in column else packed
            columns.append(known if a in letters and b in letters else None)
    return columns


expect("points", data.GetNumberOfPoints(), len(rows))
expect("vertices", data.GetNumberOfVerts(), len(rows))
expect("time", data.GetFieldData().GetArray("TimeValue").GetValue(0), time)
vectors = {"v", "x0", "a"}
seen = 0
for k in range(point_data.GetNumberOfArrays()):
    array = point_data.GetArray(k)
    name, width = array.GetName(), array.GetNumberOfComponents()
    if name in vectors:
        columns = [f"{name}_{a}" if a in "xyz"[:dim] else None for a in "xyz"]
    elif f"{name}_xx" in column:
        columns = tensor(name)
    else:
        columns = [name] if width == 1 else [f"{name}_{c}" for c in range(width)]
    expect(f"width of {name}", width, len(columns))
    plain(name, columns, array)
    seen += sum(c is not None for c in set(columns))
points = data.GetPoints().GetData()
plain("Points", [f"x_{a}" if a in "xyz"[:dim] else None for a in "xyz"], points)
expect("columns", seen + dim, len(names))
for i in range(len(rows)):
    expect("cell", data.GetCell(i).GetPointId(0), i)
