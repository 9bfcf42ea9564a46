"""Prints what VTK's own reader, the one inside ParaView, finds in series of snapshots, as JSON.

usage: read_with_vtk.py SERIES.pvd...

For each series a list with, for each snapshot that its .pvd file names: its time there, the fields of the file (with its own time),
the number of points, the points of the cells, the types of the cells, and every array of the points with the names of its
components and all its values. Complaints of the reader are printed too, so that the test can insist on none.
"""

import json
import sys
import xml.etree.ElementTree
from pathlib import Path

import vtk
from vtk.util.numpy_support import vtk_to_numpy


def read(path):
    complaints = []

    @vtk.calldata_type(vtk.VTK_STRING)
    def complain(_caller, _event, message):
        complaints.append(message)

    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.AddObserver("ErrorEvent", complain)
    reader.AddObserver("WarningEvent", complain)
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    fields = grid.GetFieldData()
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): describe(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    return {
        "complaints": complaints,
        "fields": {fields.GetArrayName(i): fields.GetArray(i).GetValue(0) for i in range(fields.GetNumberOfArrays())},
        "points": grid.GetNumberOfPoints(),
        "cells": vtk_to_numpy(grid.GetCells().GetConnectivityArray()).tolist(),
        "cell_types": sorted({grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}),
        "arrays": {"points": describe(grid.GetPoints().GetData()), **arrays},
    }


def describe(array):
    components = range(array.GetNumberOfComponents())
    return {
        "components": [array.GetComponentName(i) for i in components],
        "values": vtk_to_numpy(array).ravel().tolist(),
    }


def read_series(series):
    entries = xml.etree.ElementTree.parse(series).getroot().iter("DataSet")
    return [{"time": float(entry.get("timestep")), **read(series.parent / entry.get("file"))} for entry in entries]


json.dump([read_series(Path(series)) for series in sys.argv[1:]], sys.stdout)
