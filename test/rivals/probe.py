"""An algorithm whose answers are easy to foretell, and which fails where it is told to: see loops_test.py."""

import math

import sixdof_rival


class Query:
    def __init__(self, a, b, settings):
        if settings["mode"] == "bad_mesh":
            raise sixdof_rival.BadMesh("a bad mesh")
        if settings["mode"] == "bad_argument":
            raise sixdof_rival.BadArgument("a bad argument")
        sums = [sum(float(x) for row in rows for x in (row if hasattr(row, "__len__") else [row]))
                for rows in (a.vertices, b.triangles)]
        self.sum = sums[0] + sums[1]
        self.copies = float(a is b)

    def collide(self, pose):
        return pose[9] < 0.0

    def distance(self, pose):
        command = pose[10]
        if command == 1.0:
            raise sixdof_rival.Failed("gave up")
        if command == 2.0:
            return math.nan
        if command == 3.0:
            print("a library prints")
        if command == 4.0:
            raise IndexError("a library throws")
        return pose[9] + self.sum, [pose[9], 0.0, 0.0], [0.0, 0.0, self.copies]

    def cast(self, motion):
        command = motion.pose[10]
        if command == 1.0:
            raise sixdof_rival.Failed("gave up")
        if motion.rotation[2] > 0.0:
            return None
        return {"t": math.nan if command == 2.0 else motion.translation[0], "a": motion.reference,
                "b": motion.rotation, "normal": [0.0, 0.0, 1.0]}

    def contacts(self, pose, most):
        depth = math.nan if pose[10] == 2.0 else pose[9]
        return [[pose[9], float(i), 0.0] for i in range(most)], [[0.0, 0.6, 0.8]] * most, [depth] * most

    def footprint(self):
        return 12, {"things": 3}


sixdof_rival.serve(Query, name="probe", version="1.0", summary="a probe", answers=["collide", "distance", "cast", "contacts"], depth="point",
                   parameters=[sixdof_rival.choice("mode", "what fails", "none", ["none", "bad_mesh", "bad_argument"])])
