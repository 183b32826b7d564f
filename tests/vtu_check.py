#!/usr/bin/env python3
"""Opens the .vtu files of runs with meshio and with VTK, and compares them with a decoder of its own.

    python3 tests/vtu_check.py [--require] RUN...

RUN is the folder of a run with `frames.pvd`, and with `surface.pvd` if surfaces were exported. The decoder follows the format of
VTK and uses the standard library alone: an error in an offset, a header or a type of the writer shows as a difference between the
readers. Values are compared bit for bit. Without meshio and VTK the script prints that it is skipped; with --require it fails.
"""

import re
import struct
import sys
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

try:
    import meshio
except ImportError:
    meshio = None
try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    vtkXMLUnstructuredGridReader = None

TYPES = {"Float32": "f", "UInt32": "I", "Int64": "q", "UInt8": "B"}
CELL_TYPES = {1: "vertex", 5: "triangle"}


def decode(path):
    """The arrays of a file: a dictionary from (element, name) to (components, bytes)."""
    text, appended = path.read_bytes().split(b'<AppendedData encoding="raw">\n_', 1)
    root = ElementTree.fromstring(text + b"</VTKFile>")
    assert root.attrib["compressor"] == "vtkZLibDataCompressor" and root.attrib["header_type"] == "UInt64"
    arrays = {}
    for parent in root.find("UnstructuredGrid/Piece"):
        for array in parent:
            start = int(array.attrib["offset"])
            count, size, partial = struct.unpack_from("<3Q", appended, start)
            sizes = struct.unpack_from(f"<{count}Q", appended, start + 24)
            at, data = start + 24 + 8 * count, b""
            for number, compressed in enumerate(sizes):
                block = zlib.decompress(appended[at : at + compressed])
                assert len(block) == (partial if partial and number + 1 == count else size), f"{path}: block of {array.attrib}"
                data, at = data + block, at + compressed
            kind = TYPES[array.attrib["type"]]
            assert len(data) % struct.calcsize(kind) == 0
            arrays[parent.tag, array.attrib["Name"]] = (int(array.attrib.get("NumberOfComponents", 1)), kind, data)
    return arrays


def same(path, reader, name, components, kind, data, found):
    """Compares an array of numpy with the decoded bytes."""
    count = len(data) // struct.calcsize(kind) // components
    shape = (count,) if components == 1 else (count, components)
    assert tuple(found.shape) == shape, f"{path}: {reader}: {name} has the shape {found.shape}, not {shape}"
    assert found.astype(found.dtype.newbyteorder("<")).tobytes() == data, f"{path}: {reader}: {name} has other values"


def check_with_vtk(path, arrays):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, f"{path}: VTK cannot read it"
    grid = reader.GetOutput()
    fields = grid.GetPointData()
    names = [name for parent, name in arrays if parent == "PointData"]
    assert [fields.GetArrayName(i) for i in range(fields.GetNumberOfArrays())] == names, f"{path}: VTK: other fields"
    for name in names:
        same(path, "VTK", name, *arrays["PointData", name], vtk_to_numpy(fields.GetArray(name)))
    points = vtk_to_numpy(grid.GetPoints().GetData())
    same(path, "VTK", "points", *arrays["Points", "Points"], points)
    cells = grid.GetCells()
    same(path, "VTK", "connectivity", *arrays["Cells", "connectivity"], vtk_to_numpy(cells.GetConnectivityArray()))
    # VTK's own array begins with 0.
    same(path, "VTK", "offsets", *arrays["Cells", "offsets"], vtk_to_numpy(cells.GetOffsetsArray())[1:])
    types = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
    assert bytes(types) == arrays["Cells", "types"][2], f"{path}: VTK: other cell types"


def check_with_meshio(path, arrays):
    mesh = meshio.read(path)
    same(path, "meshio", "points", *arrays["Points", "Points"], mesh.points)
    fields = {name: array for (parent, name), array in arrays.items() if parent == "PointData"}
    assert set(mesh.point_data) == set(fields), f"{path}: meshio: other fields"
    for name, array in fields.items():
        same(path, "meshio", name, *array, mesh.point_data[name])
    types = set(arrays["Cells", "types"][2])
    assert {block.type for block in mesh.cells} == {CELL_TYPES[kind] for kind in types}, f"{path}: meshio: other cells"
    data = b"".join(block.data.astype("<i8").tobytes() for block in mesh.cells)
    assert data == arrays["Cells", "connectivity"][2], f"{path}: meshio: other connectivity"


def main(words):
    required = "--require" in words
    runs = [Path(word) for word in words if word != "--require"]
    if not runs:
        sys.exit(__doc__)
    if meshio is None and vtkXMLUnstructuredGridReader is None:
        print("skipped: neither meshio nor vtk is installed (pip install meshio vtk)")
        sys.exit(1 if required else 0)
    files = []
    for run in runs:
        lists = [run / name for name in ("frames.pvd", "surface.pvd") if (run / name).exists()]
        for file in lists:
            files += [run / name for name in re.findall(r' file="([^"]+)"', file.read_text())]
    assert files, "there are no frames in " + ", ".join(map(str, runs))
    for path in files:
        arrays = decode(path)
        points = len(arrays["Points", "Points"][2]) // 12
        if vtkXMLUnstructuredGridReader is not None:
            check_with_vtk(path, arrays)
        if meshio is not None and points > 0:
            check_with_meshio(path, arrays)
    readers = [name for name, there in (("meshio", meshio), ("VTK", vtkXMLUnstructuredGridReader)) if there is not None]
    print(f"{len(files)} files: the same values with {' and '.join(readers)}")


main(sys.argv[1:])
