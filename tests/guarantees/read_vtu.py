"""Prints what VTK's own reader finds in the files of a time series: `read_vtu.py SERIES.pvd`.

The list is read as XML, for VTK without ParaView has no reader of it.
"""

import os
import sys
import xml.etree.ElementTree as xml

from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

complaints = vtkStringOutputWindow()
vtkOutputWindow.SetInstance(complaints)


def show(name, array):
    size = range(array.GetNumberOfTuples())
    tuples = [" ".join(f"{x!r}" for x in array.GetTuple(i)) for i in size]
    print(f"{name} {array.GetDataTypeAsString()}: {' | '.join(tuples)}")


for entry in xml.parse(sys.argv[1]).getroot().iter("DataSet"):
    file = os.path.join(os.path.dirname(sys.argv[1]), entry.get("file"))
    reader = vtkXMLUnstructuredGridReader()
    assert reader.CanReadFile(file), file
    reader.SetFileName(file)
    reader.Update()
    grid = reader.GetOutput()
    kinds = {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}
    points, cells = grid.GetNumberOfPoints(), grid.GetNumberOfCells()
    print(f"t {float(entry.get('timestep'))!r}: {points} points, {cells} cells of types {kinds or '{}'}")
    if points:
        show("Points", grid.GetPoints().GetData())
    for data in [grid.GetPointData(), grid.GetFieldData()]:
        for i in range(data.GetNumberOfArrays()):
            show(data.GetArrayName(i), data.GetArray(i))
assert not complaints.GetOutput(), complaints.GetOutput()
