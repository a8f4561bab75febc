"""rewrite_vtu.py FOLDER/: reads out.vtu with VTK and writes it in every encoding that VTK has."""
import sys

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

folder = sys.argv[1]
reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(folder + "out.vtu")
reader.Update()
grid = reader.GetOutput()
assert grid.GetNumberOfCells() > 0 and reader.GetErrorCode() == 0, "VTK cannot read out.vtu"
assert grid.GetPointData().GetArray("u").GetNumberOfComponents() == 3
assert grid.GetFieldData().GetArray("TimeValue").GetValue(0) == 0.5
for mode in ("ascii", "binary", "appended_raw", "appended_base64"):
    for more in ("", "_zlib", "_wide", "_big"):
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(folder + mode + more + ".vtu")
        writer.SetInputData(grid)
        if mode == "ascii":
            writer.SetDataModeToAscii()
        elif mode == "binary":
            writer.SetDataModeToBinary()
        else:
            writer.SetDataModeToAppended()
            writer.SetEncodeAppendedData(mode == "appended_base64")
        writer.SetCompressorTypeToZLib() if more == "_zlib" else writer.SetCompressorTypeToNone()
        writer.SetBlockSize(1000)
        if more == "_wide":
            writer.SetHeaderTypeToUInt64()
        else:
            writer.SetHeaderTypeToUInt32()
        if more == "_big":
            writer.SetByteOrderToBigEndian()
        assert writer.Write() == 1
