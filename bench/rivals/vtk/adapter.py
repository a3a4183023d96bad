"""VTK's vtkCollisionDetectionFilter: trees of oriented boxes (vtkOBBTree) down to the first contact; surfaces only."""

import sixdof_rival
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkFiltersModeling import vtkCollisionDetectionFilter


class Query:
    def __init__(self, a, b, settings):
        self.pose, self.search = vtkMatrix4x4(), vtkCollisionDetectionFilter()
        for place, mesh, matrix in ((0, a, vtkMatrix4x4()), (1, b, self.pose)):
            points, triangles, surface = vtkPoints(), vtkCellArray(), vtkPolyData()
            points.SetData(numpy_to_vtk(mesh.vertices, deep=True))
            triangles.SetData(3, numpy_to_vtkIdTypeArray(mesh.triangles.ravel().astype("int64"), deep=True))
            surface.SetPoints(points), surface.SetPolys(triangles)
            self.search.SetInputData(place, surface), self.search.SetMatrix(place, matrix)
        self.search.SetCollisionModeToFirstContact()

    def collide(self, pose):
        self.pose.DeepCopy([*pose[:3], pose[9], *pose[3:6], pose[10], *pose[6:9], pose[11], 0, 0, 0, 1])
        self.search.Modified()  # the same pose again is searched again
        self.search.Update()
        return self.search.GetNumberOfContacts() > 0


sixdof_rival.serve(Query, name="vtk", version=vtkVersion().GetVTKVersion(), answers=["collide"],
                   limits=["collide_of_surfaces"], summary="VTK from Python, trees of oriented boxes; surfaces only")
