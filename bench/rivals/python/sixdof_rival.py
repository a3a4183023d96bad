"""The server loop of an algorithm in Python: serve(Query, ...) answers the protocol of lib/sixdof/process/README.md.

A query is a class. Its constructor prepares a pair of meshes; its methods answer for one pose:

    class Query:
        def __init__(self, a, b, settings): ...  # two Mesh objects, a dict of texts; raise BadMesh or BadArgument
        def collide(self, pose): ...             # bool
        def distance(self, pose): ...            # float, or (float, closest point of A, closest point of B)
        def respond(self, pose): ...             # dict of penalty, force, torque, reference and, optional, volume
        def cast(self, motion): ...              # None for no contact, t, or a dict of t and, optional, a, b, normal
        def contacts(self, pose, most): ...      # (points, normals from A to B, depths), at most `most` of each
        def empty(self, pose): ...               # optional: all of a query but the library's search
        def footprint(self): ...                 # optional: (bytes, {"name": count})
        def pose_of(numbers): ...                # optional, static: the pose that methods take, of the NumPy array
        def motion_of(motion): ...               # optional, static: the motion that cast() takes, of a Motion

It needs the methods that it answers only. The pose is a NumPy array of the twelve numbers, a list where NumPy is
missing; a Motion has such a pose, its start, and lists of three numbers. Points and forces are in A's frame. What a method returns may be of NumPy's types. raise Failed(words) where
the library gives up; any other exception counts as failed, too.

A method is timed from the twelve numbers of the pose, or what pose_of() makes of them, to its return. The count
`empty_call_ns` of prepare is the median time of a call of empty(), or of a method that does nothing: what Python adds to
each query.
"""

import array
import itertools
import json
import math
import mmap
import os
import statistics
import sys
import time

try:
    import numpy
except ImportError:
    numpy = None

KINDS = ("collide", "distance", "respond", "cast")  # that are asked by a place alone; contacts have a number besides
EMPTY_CALLS = 1001
NOT_FINITE = object()  # In place of a pose that holds a NaN or an infinity: many libraries would answer.


class BadMesh(Exception):
    """The algorithm cannot use a mesh."""


class BadArgument(Exception):
    """A setting has a value that is not allowed."""


class Failed(Exception):
    """No answer for this pose. `status` is one of query/README.md."""

    def __init__(self, words, status="failed"):
        super().__init__(words)
        self.status = status


class Mesh:
    """`vertices` (float64) and `triangles` (uint32): NumPy arrays of rows of three, flat array.array without NumPy."""

    def __init__(self, place):
        self.name = place["name"]
        self.vertices = self._read(place["vertices"], "d", place["vertex_count"])
        self.triangles = self._read(place["triangles"], "I", place["triangle_count"])

    @staticmethod
    def _read(path, kind, count):
        values = array.array(kind)
        with open(path, "rb") as file:
            values.frombytes(file.read(3 * count * values.itemsize))
        if len(values) != 3 * count:
            raise ValueError(f"{path}: fewer than {count} rows")
        if sys.byteorder == "big":
            values.byteswap()
        return values if numpy is None else numpy.frombuffer(values, dtype=kind).reshape(-1, 3)

    def box_centre(self):
        """Of the vertices: where torques on B are taken about, by convention."""
        flat = self.vertices if numpy is None else self.vertices.ravel()
        return [(min(flat[i::3]) + max(flat[i::3])) / 2 for i in range(3)]


class Motion:
    """Of B from t = 0 to 1: the point `reference` of B's mesh frame moves by t `translation`, and B rotates about it by t
    times the vector `rotation` (radians); both in A's axes."""

    def __init__(self, pose, translation, rotation, reference):
        self.pose, self.translation, self.rotation, self.reference = pose, translation, rotation, reference


def moved(pose, point):
    """The point of B in A's frame, as a list."""
    return [float(pose[3 * i] * point[0] + pose[3 * i + 1] * point[1] + pose[3 * i + 2] * point[2] + pose[9 + i])
            for i in range(3)]


def choice(name, meaning, default, choices):
    """A parameter with a few values, for serve()."""
    return {"name": name, "meaning": meaning, "unit": "1", "default": default, "choices": choices}


def serve(query_class, *, name, version, summary, answers, law="none", depth="none", body="mesh", limits=(), parameters=()):
    """Answers requests until the input ends. What the library prints to standard output goes to standard error."""
    hello = {"protocol": 1, "name": name, "version": version, "summary": summary, "answers": list(answers), "law": law,
             "depth": depth, "body": body, "limits": list(limits), "parameters": list(parameters), "can": ["time", "progress", "again"]}
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    server = _Server(query_class, hello)
    for line in sys.stdin:
        replies.write(json.dumps(server.reply(line), allow_nan=False) + "\n")
        replies.flush()


class _Server:
    def __init__(self, query_class, hello):
        self.query_class, self.hello = query_class, hello
        self.pose_of = getattr(query_class, "pose_of", lambda numbers: numbers)
        self.motion_of = getattr(query_class, "motion_of", lambda motion: motion)
        self.query, self.progress = None, None

    def reply(self, line):
        try:
            request = json.loads(line)
            handle = {"hello": self.greet, "prepare": self.prepare, "ask": self.ask, "time": self.time}
            return handle[request["do"]](request)
        except Exception as e:
            kind = {BadMesh: "bad_mesh", BadArgument: "bad_argument"}.get(type(e), "error")
            return {"error": _words(e), "kind": kind}

    def greet(self, request):
        if request["protocol"] != 1:
            raise ValueError(f"not version {request['protocol']} of the protocol")
        return self.hello

    def prepare(self, request):
        self.query, self.progress = None, _Progress(request.get("progress"))
        a = Mesh(request["a"])
        same = all(request["a"][key] == request["b"][key] for key in ("vertices", "triangles"))
        b = a if same else Mesh(request["b"])
        settings = {each["name"]: each["default"] for each in self.hello["parameters"]}
        settings.update(request["settings"])
        wall, cpu = time.perf_counter_ns(), time.process_time_ns()
        self.query = self.query_class(a, b, settings)
        reply = {"prepared": True, "ns": time.perf_counter_ns() - wall, "cpu_ns": time.process_time_ns() - cpu}
        size, counts = self.query.footprint() if hasattr(self.query, "footprint") else (0, {})
        return reply | {"bytes": size, "counts": counts | {"empty_call_ns": self.empty_call_ns()}}

    def pose(self, numbers):
        pose = _pose(numbers)
        return self.pose_of(pose) if all(map(math.isfinite, pose)) else NOT_FINITE

    def motion(self, request):
        vectors = [[float(x) for x in request[key]] for key in ("translation", "rotation", "reference")]
        if any(len(vector) != 3 for vector in vectors):
            raise ValueError("a motion does not have three vectors of three numbers")
        pose = _pose(request["pose"])
        if not all(map(math.isfinite, sum(vectors, list(pose)))):
            return NOT_FINITE
        return self.motion_of(Motion(pose, *vectors))

    def empty_call_ns(self):
        method = getattr(self.query, "empty", lambda pose: None)
        pose = self.pose([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0])
        times = []
        for _ in range(EMPTY_CALLS):
            start = time.perf_counter_ns()
            method(pose)
            times.append(time.perf_counter_ns() - start)
        return statistics.median(times)

    def method(self, kind):
        if self.query is None:
            raise BadArgument("nothing is prepared")
        if kind not in KINDS:
            raise BadArgument(f'"{kind}" is no kind of query')
        if kind not in self.hello["answers"]:
            return None
        return getattr(self.query, kind)

    def ask(self, request):
        kind = request["query"]
        if kind == "contacts":
            return self.ask_contacts(self.pose(request["pose"]), int(request["most"]))
        method = self.method(kind)
        took, reply = timed(method, kind, self.motion(request) if kind == "cast" else self.pose(request["pose"]))
        return reply | {"ns": took}

    def ask_contacts(self, pose, most):
        if self.query is None:
            raise BadArgument("nothing is prepared")
        find = getattr(self.query, "contacts") if "contacts" in self.hello["answers"] else None
        took, reply = timed(find and (lambda pose: find(pose, most)), "contacts", pose)
        return reply | {"ns": took}

    def time(self, request):
        kind, poses = request["query"], [self.pose(pose) for pose in request["poses"]]
        method = self.method(kind)
        return (self.time_each if request["each"] else self.time_passes)(request, method, kind, poses)

    def time_each(self, request, method, kind, poses):
        passes, failed, begun = [], {}, 0
        buffer = bytearray(b"\1") * request["evict_bytes"]
        for _ in range(request["passes"]):
            times = []
            for place, pose in enumerate(poses):
                begun += 1
                self.progress.set(begun)
                buffer.count(b"\0")  # reads all of it
                took, reply = timed(method, kind, pose)
                times.append(took)
                if "status" in reply:
                    failed.setdefault(place, [place, reply["status"], reply["words"]])
            passes.append(times)
        return {"once_ns": passes[0], "least_ns": [min(times) for times in zip(*passes)],
                "failed": list(failed.values())}

    def time_passes(self, request, method, kind, poses):
        begun = 0
        wall, cpu = time.perf_counter_ns(), time.process_time_ns()
        for _ in range(request["passes"]):
            for pose in poses:
                begun += 1
                self.progress.set(begun)
                try:
                    method(pose)
                except Exception:
                    pass  # time_each() says which
        return {"wall_ns": time.perf_counter_ns() - wall, "cpu_ns": time.process_time_ns() - cpu}


class _Progress:
    """The number that tells how many queries of a request have begun."""

    def __init__(self, path):
        self.value = memoryview(bytearray(8)).cast("Q")
        if path:
            with open(path, "r+b") as file:
                self.value = memoryview(mmap.mmap(file.fileno(), 8)).cast("Q")

    def set(self, value):
        self.value[0] = value


def _pose(numbers):
    values = [float(x) for x in numbers]  # "nan" and "inf" are texts
    if len(values) != 12:
        raise ValueError("a pose does not have twelve numbers")
    return values if numpy is None else numpy.array(values)


def _words(error):
    return (str(error) or type(error).__name__)[:400]


def timed(method, kind, pose):
    """Wall time of a query in ns, and its reply. @param pose, or a motion"""
    if method is None:
        return 0, {"status": "unsupported", "words": f"does not answer {kind}"}
    if pose is NOT_FINITE:
        return 0, {"status": "non_finite", "words": f"the {'motion' if kind == 'cast' else 'pose'} is not finite"}
    start = time.perf_counter_ns()
    try:
        answer = method(pose)
        took = time.perf_counter_ns() - start
    except Exception as e:
        took = time.perf_counter_ns() - start
        status = "out_of_memory" if isinstance(e, MemoryError) else getattr(e, "status", "failed")
        return took, {"status": status, "words": _words(e)}
    return took, _reply(kind, answer)


def _reply(kind, answer):
    if kind == "collide":
        return {"collide": bool(answer)}
    if kind == "contacts":
        points, normals, depths = answer
        reply = {"points": [_vector(p) for p in points], "normals": [_vector(n) for n in normals], "depths": _vector(depths)}
        numbers = itertools.chain(*reply["points"], *reply["normals"], reply["depths"])
        return reply if all(map(math.isfinite, numbers)) else {"status": "non_finite", "words": "the answer is not finite"}
    if kind == "distance":
        gap, a, b = answer if isinstance(answer, tuple) else (answer, None, None)
        reply = {"distance": float(gap)} | ({} if a is None else {"a": _vector(a), "b": _vector(b)})
    elif kind == "cast":
        if answer is None:
            return {"hit": False}
        values = answer if isinstance(answer, dict) else {"t": answer}
        reply = {"hit": True, "t": float(values["t"])}
        reply |= {key: _vector(values[key]) for key in ("a", "b", "normal") if values.get(key) is not None}
    else:
        reply = {key: _vector(answer[key]) for key in ("force", "torque", "reference")}
        reply |= {key: float(answer[key]) for key in ("penalty", "volume") if key in answer}
    for value in reply.values():
        if not all(map(math.isfinite, value if isinstance(value, list) else [value])):
            return {"status": "non_finite", "words": "the answer is not finite"}
    return reply


def _vector(values):
    return [float(x) for x in values]
