"""A program of the protocol (lib/sixdof/process/README.md) that is asked line by line, and meshes as it reads them."""

import array
import importlib.machinery
import importlib.util
import json
import os
import select
import subprocess
import sys

LONGEST_ANSWER = 120  # s; only a program that hangs takes that long


def load_setup(rivals):
    """bench/rivals/setup as a module."""
    loader = importlib.machinery.SourceFileLoader("setup", str(rivals / "setup"))
    sys.dont_write_bytecode = True
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("setup", loader))
    loader.exec_module(module)
    return module


class Mesh:
    """Files of a mesh. `vertices` and `triangles` are lists of rows."""

    def __init__(self, folder, name, vertices, triangles):
        self.place = {"name": name, "vertex_count": len(vertices), "triangle_count": len(triangles)}
        for key, kind, rows in (("vertices", "d", vertices), ("triangles", "I", triangles)):
            path = os.path.join(folder, f"{name}.{key}")
            with open(path, "wb") as file:
                array.array(kind, [x for row in rows for x in row]).tofile(file)
            self.place[key] = path


class Program:
    """Ends with the block that uses it."""

    def __init__(self, command):
        self.process = subprocess.Popen(command, shell=isinstance(command, str), stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        try:
            self.process.wait(LONGEST_ANSWER)
        finally:
            self.process.kill()
            self.process.stdout.close()
            self.process.stderr.close()

    def say(self, line):
        """The reply to a line, or to a request."""
        text = line if isinstance(line, str) else json.dumps(line)
        self.process.stdin.write(text.encode() + b"\n")
        self.process.stdin.flush()
        if not select.select([self.process.stdout], [], [], LONGEST_ANSWER)[0]:
            raise TimeoutError(f"no reply to {text[:200]}")
        reply = self.process.stdout.readline()
        if not reply:
            raise EOFError(self.process.stderr.read().decode(errors="replace")[-2000:])
        return json.loads(reply)

    def hello(self):
        return self.say({"do": "hello", "protocol": 1})

    def prepare(self, a, b, progress, **settings):
        return self.say({"do": "prepare", "a": a.place, "b": b.place, "settings": settings, "progress": progress})

    def ask(self, query, pose):
        return self.say({"do": "ask", "query": query, "pose": pose})


def end(runner_program):
    """Exit code of a test program: 77 where every test was skipped."""
    result = runner_program.result
    if result.wasSuccessful() and len(result.skipped) >= max(1, result.testsRun):
        for reason in sorted({reason for _, reason in result.skipped}):
            print(f"skipped: {reason}")
        sys.exit(77)
    sys.exit(not result.wasSuccessful())
