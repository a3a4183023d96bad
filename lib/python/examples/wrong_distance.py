#!/usr/bin/env python3
"""How wrong is my distance? Compares an algorithm of your own with the truth, and measures it.

usage: wrong_distance.py
"""

import numpy
import sixdof


class BoundingSpheres(sixdof.Algorithm):
    """Distance of the boxes' bounding spheres."""

    def prepare(self):
        self.reach = (self.a.diagonal + self.b.diagonal) / 2

    def distance(self, pose):
        centre_b = pose[:3, :3] @ self.b.center + pose[:3, 3]
        return max(0.0, float(numpy.linalg.norm(centre_b - self.a.center)) - self.reach)


if __name__ == "__main__":
    tool, part = sixdof.load("cone-1k"), sixdof.load("torus-1k")
    poses = sixdof.pose([0.8, 0.0, 0.6, 0.0], numpy.linspace([0.0, 0.3, 1.5], [0.5, 0.3, 9.0], 50))
    truth = sixdof.prepare("exact", tool, part).distance(poses).distance
    mine = sixdof.prepare(BoundingSpheres, tool, part).distance(poses).distance
    worst = int(numpy.argmax(abs(mine - truth)))
    print(f"largest error {abs(mine - truth)[worst]:.3f} at pose {worst}, where the distance is {truth[worst]:.3f}")
    print(sixdof.bench(BoundingSpheres, pairs=[(tool, part)], queries=["distance"], sample=32, budget=10).table())
