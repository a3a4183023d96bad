"""What bench/scripts/collection and bench/scripts/growth say on stderr while they measure."""

import math
import sys
import time


class Progress:
    """Lines on stderr: how many units there are and how long they will take, each that ends with the share of the whole and
    the time left, and at the end what the budget left out. Work of a unit is its number of triangles."""

    def __init__(self, budget, points):
        """@param points (triangles, seconds) of units that are measured already"""
        self.budget, self.points = budget, list(points)
        self.work = self.done = self.units = self.ended = 0
        self.begun = time.monotonic()

    @staticmethod
    def say(text):
        print(text, file=sys.stderr, flush=True)

    def seconds(self, work):
        """An estimate for so many triangles with the jobs of the run; None where no unit is measured."""
        measured = sum(triangles for triangles, _ in self.points)
        if not measured:
            return None
        return work * sum(seconds for _, seconds in self.points) / measured / self.budget.jobs

    def begin(self, units):
        self.units, self.work = len(units), sum(unit.triangles for unit in units)
        if not units:
            return
        about = self.seconds(self.work)
        self.say(f"pairs to measure: {self.units}, {self.budget.jobs} at a time" +
                 (f"; about {duration(about)} in all, by those that are measured" if about else "") +
                 ("" if self.budget.end == math.inf else f"; the budget is {duration(self.budget.remaining())}"))

    def finished(self, unit):
        self.ended += 1
        self.done += unit.triangles
        all_s = (time.monotonic() - self.begun) * self.work / self.done
        left = max(0, min(all_s * (1 - self.done / self.work), self.budget.remaining()))
        if self.ended == 1 and not self.points:
            self.say(f"about {duration(all_s)} in all, by the first one")
        self.say(f"{self.ended} of {self.units}: {unit.name}: {100 * self.done // self.work} % done, {duration(left)} left")

    def end(self, left_out):
        """@param left_out units"""
        if not left_out:
            return
        triangles = sum(unit.triangles for unit in left_out)
        elapsed = time.monotonic() - self.begun
        needs = elapsed * triangles / self.done if self.done else self.seconds(triangles)
        names = ", ".join(unit.name for unit in left_out[:5]) + (", ..." if len(left_out) > 5 else "")
        self.say(f"the budget left out {len(left_out)} of {self.units} pairs" +
                 (f", about {duration(needs)} more" if needs else "") + f": {names}; the same command continues")


def duration(seconds):
    """As a person reads it: 35 s, 2.5 min, 3.1 h."""
    unit, factor = ("s", 1) if seconds < 60 else ("min", 60) if seconds < 3600 else ("h", 3600)
    return f"{max(seconds, 0) / factor:.3g} {unit}"
