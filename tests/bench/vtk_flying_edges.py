"""VTK's flying edges with normals on one thread, for `haptic_bench mesh`: prints one JSON object.

  vtk_flying_edges.py VOLUME.raw NX NY NZ SX SY SZ ISO RUNS     16 bit, little endian, x fastest; spacing in mm
"""

import json
import sys
import time

try:
    import vtkmodules.all as vtk
except ImportError:
    sys.exit("VTK is missing: deploy/install-deps --bench")


def main(path, dims, spacing, iso, runs):
    vtk.vtkSMPTools.Initialize(1)
    reader = vtk.vtkImageReader()
    reader.SetFileName(path)
    reader.SetFileDimensionality(3)
    reader.SetDataScalarTypeToUnsignedShort()
    reader.SetDataByteOrderToLittleEndian()
    reader.SetDataExtent(0, dims[0] - 1, 0, dims[1] - 1, 0, dims[2] - 1)
    reader.SetDataSpacing(*spacing)
    reader.Update()
    times_ms, triangles = [], 0
    for _ in range(runs):
        edges = vtk.vtkFlyingEdges3D()
        edges.SetInputData(reader.GetOutput())
        edges.SetValue(0, iso)
        edges.ComputeNormalsOn()
        edges.ComputeGradientsOff()
        edges.ComputeScalarsOff()
        start = time.perf_counter()
        edges.Update()
        times_ms.append(1e3 * (time.perf_counter() - start))
        triangles = edges.GetOutput().GetNumberOfPolys()
    print(json.dumps({"times_ms": times_ms, "triangles": triangles, "version": vtk.vtkVersion.GetVTKVersion(),
                      "threads": vtk.vtkSMPTools.GetEstimatedNumberOfThreads()}))


main(sys.argv[1], [int(a) for a in sys.argv[2:5]], [float(a) for a in sys.argv[5:8]], float(sys.argv[8]), int(sys.argv[9]))
