#!/usr/bin/env python3
"""Checks that the code keeps to the map of the rooms in lib/README.md.

usage: test/architecture/architecture.py [--root FOLDER] [--build FOLDER]

Reads the table of rooms (first column: a folder; a row may use the rows below it) and every #include, and reports
- an include of a room above, or of a file that does not exist;
- a folder with code that the table does not name, and a row of the table without code;
- files that include each other in a circle;
- a source without a test of its name that test/README.md does not give to another test, and a row there that is wrong;
- with --build, a header that does not compile alone. A header that is the first include of a source in
  FOLDER/compile_commands.json was compiled alone by the build; the others are compiled here with the flags of that file
  (files *-inl.h are parts of others and are left out).
Exits with 1 if anything is reported.
"""

import argparse
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

CODE = {".h", ".cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]')
ROOM_ROW = re.compile(r"^\|\s*`([\w/.]+/)`\s*\|")
GENERATED = {"sixdof_commit.h"}  # made by the build
EVERYWHERE = "test/"  # tests may use every room, nobody may use tests


class Problem(Exception):
    """The map itself cannot be read."""


@dataclasses.dataclass
class Build:
    """How headers are compiled: the compiler with its flags, and the sources (relative to the root) the build compiles."""

    command: list
    sources: set


def read_rooms(readme):
    """Folders of the table of rooms, from the top down."""
    rooms = [match.group(1) for line in readme.read_text().splitlines() if (match := ROOM_ROW.match(line))]
    if not rooms:
        raise Problem(f"{readme}: no table of rooms: rows read | `folder/` | what lives there |")
    return rooms


def code_files(root):
    """Every source and header under lib, bench and test, relative to the root."""
    found = []
    for top in ("lib", "bench", "test"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in CODE and path.is_file():
                found.append(path.relative_to(root).as_posix())
    return found


def includes_of(root, file):
    """(line, quote, name) of every include."""
    for number, line in enumerate((root / file).read_text(errors="replace").splitlines(), 1):
        if match := INCLUDE.match(line):
            yield number, match.group(1), match.group(2)


def resolve(root, file, quote, name):
    """The included file of this project relative to the root, or None for another library's."""
    if name.startswith("sixdof/"):
        return f"lib/{name}"
    if quote == '"' and name not in GENERATED:
        beside = os.path.normpath(os.path.join(os.path.dirname(file), name))
        return beside if (root / beside).exists() else name
    return None


def room_of(rooms, file):
    """The longest folder of the table that holds the file."""
    holding = [room for room in rooms if file.startswith(room)]
    return max(holding, key=len) if holding else None


def check_includes(root, rooms, files):
    """Problems of single includes, and the graph of files."""
    problems, graph = [], {}
    for file in files:
        room = room_of(rooms, file)
        if room is None:
            problems.append(f"{file}: lies in no room of the table")
        graph[file] = []
        for line, quote, name in includes_of(root, file):
            target = resolve(root, file, quote, name)
            if target is None:
                continue
            if not (root / target).is_file():
                problems.append(f"{file}:{line}: includes {name}, which is not there")
                continue
            graph[file].append(target)
            target_room = room_of(rooms, target)
            if room is None or target_room is None or room == EVERYWHERE:
                continue
            if target_room == EVERYWHERE or rooms.index(target_room) < rooms.index(room):
                problems.append(f"{file}:{line}: room {room} includes {target} of room {target_room}, which is above it")
    return problems, graph


def check_rooms(rooms, files):
    """Every row of the table has code."""
    return [f"lib/README.md: room {room} has no code" for room in rooms if not any(f.startswith(room) for f in files)]


def find_circles(graph):
    """One message per circle between files. A source that includes itself (SIMD targets) is none."""
    problems, state, trail = [], {}, []

    def visit(file):
        state[file] = "open"
        trail.append(file)
        for target in graph.get(file, []):
            if target == file:
                continue
            if state.get(target) == "open":
                problems.append("circle: " + " -> ".join(trail[trail.index(target):] + [target]))
            elif target not in state:
                visit(target)
        trail.pop()
        state[file] = "done"

    sys.setrecursionlimit(10000)
    for file in graph:
        if file not in state:
            visit(file)
    return problems


def read_build(root, folder):
    """The compiler with every include path that the library and the programs are compiled with, and the sources."""
    commands = folder / "compile_commands.json"
    if not commands.is_file():
        raise Problem(f"{commands}: not there; configure with CMAKE_EXPORT_COMPILE_COMMANDS")
    command, sources = [], set()
    for entry in json.loads(commands.read_text()):
        file = os.path.relpath(entry["file"], root)
        if "cmake_pch" not in entry["command"]:  # what is precompiled comes before a source's own includes
            sources.add(file)
        if not file.startswith(("lib/", "bench/")):
            continue
        words = shlex.split(entry["command"])
        if not command:
            first_flag = next(i for i, word in enumerate(words) if word.startswith("-"))
            command = words[:first_flag] + ["-std=c++20"]
        for i, word in enumerate(words):
            if word == "-isystem" and words[i + 1] not in command:
                command += [word, words[i + 1]]
            elif word.startswith("-I") and word not in command:
                command.append(word)
    if not command:
        raise Problem(f"{commands}: no file of lib/ or bench/")
    return Build(command, sources)


def compile_alone(root, header, command):
    """What the compiler says of a source that is nothing but an include of the header, or None."""
    include = f"<{header.removeprefix('lib/')}>" if header.startswith("lib/") else f'"{header}"'
    words = [*command, f"-I{root / 'lib'}", f"-I{root}", "-fsyntax-only", "-xc++", "-"]
    done = subprocess.run(words, input=f"#include {include}\n", capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return None
    errors = [line for line in done.stderr.splitlines() if "error" in line] or done.stderr.splitlines() or ["no words"]
    return f"{header}: does not compile alone: {errors[0]}"


def first_include(root, file):
    """The file that a source includes first, relative to the root, or None."""
    for _, quote, name in includes_of(root, file):
        return resolve(root, file, quote, name)
    return None


OPTIONAL = "lib/python/"  # needs headers of Python, without which nothing of it is built


def is_built(header, build):
    """Whether the build has what the header needs."""
    return not header.startswith(OPTIONAL) or any(source.startswith(OPTIONAL) for source in build.sources)


def check_headers(root, files, build):
    """Headers of rooms and programs, each compiled alone: by the build, or else here."""
    compiled = {first_include(root, file) for file in files if file in build.sources}
    headers = [f for f in files if f.endswith(".h") and not f.endswith("-inl.h") and not f.startswith(EVERYWHERE)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wanted = [header for header in headers if header not in compiled and is_built(header, build)]
        found = pool.map(lambda header: compile_alone(root, header, build.command), wanted)
        return [problem for problem in found if problem]


# A statement of its own, so that nobody looks at what it returns.
IGNORED_CALL = re.compile(r"^\s*(static_cast<void>\()?H5[A-Z][A-Za-z]*[a-z0-9_]+\(")
ANY_CALL = re.compile(r"\bH5[A-Z]{1,2}[a-z][a-z0-9_]*\(|\bH5open\(")
HDF5_FILES = ("lib/sixdof/base/hdf5.h", "lib/sixdof/base/hdf5.cpp")
# Where a destructor gives the handler of errors back: there is nobody left to tell.
HDF5_EXCEPTION = "  static_cast<void>(H5Eset_auto2(H5E_DEFAULT, old_handler_, old_data_));"


def check_hdf5(root, files):
    """HDF5 is called in one place, and no result of it is ignored: chunks of a set are written as it is closed."""
    problems = []
    for file in files:
        if file.startswith("test/"):
            continue
        for number, line in enumerate((root / file).read_text(errors="replace").splitlines(), 1):
            if line.lstrip().startswith("//") or line == HDF5_EXCEPTION:
                continue
            if file not in HDF5_FILES and ANY_CALL.search(line):
                problems.append(f"{file}:{number}: calls HDF5, which {HDF5_FILES[0]} is for")
            elif IGNORED_CALL.match(line) and line.rstrip().endswith(";"):
                problems.append(f"{file}:{number}: ignores a result of HDF5: {line.strip()}")
    return problems


SIMD_TARGETS = "#include <sixdof/base/simd_targets.h>"
FOR_EACH_TARGET = "#include <hwy/foreach_target.h>"
QUALIFIED_DISPATCH = re.compile(r"HWY_DYNAMIC_DISPATCH\([^)]*::")


def check_simd(root, files):
    """SIMD code compiles for ARM, too: not for instruction sets of unknown vector length, and where NEON is the only one."""
    problems = []
    for file in files:
        lines = (root / file).read_text(errors="replace").splitlines()
        for number, line in enumerate(lines, 1):
            if line.startswith(FOR_EACH_TARGET) and SIMD_TARGETS not in lines[:number]:
                problems.append(f"{file}:{number}: needs {SIMD_TARGETS} before it")
            if QUALIFIED_DISPATCH.search(line):
                problems.append(f"{file}:{number}: dispatches by a qualified name, which one instruction set alone does not know")
    return problems


COVERED_ROW = re.compile(r"^\|\s*`(\S+_test\.(?:cpp|py))`\s*\|\s*`([\w/.]+/)`\s*\|(.+)\|\s*$")
TEMPLATES = "bench/new_algorithm/"  # written into projects of others


def test_folder(source):
    """Where a source's own test lies, relative to test/."""
    folder = os.path.dirname(source)
    if folder.startswith("lib/sixdof"):
        return folder.removeprefix("lib/sixdof").lstrip("/")
    return {"bench/cli": "cli", "bench/study": "study"}.get(folder, "bench")


def read_covered(readme):
    """The test that covers a source, by source, for all rows of the table; and sources that stand there twice."""
    covered, twice = {}, []
    for line in readme.read_text().splitlines() if readme.is_file() else []:
        if match := COVERED_ROW.match(line):
            for stem in re.findall(r"`(\w+)`", match.group(3)):
                source = f"{match.group(2)}{stem}.cpp"
                if source in covered:
                    twice.append(source)
                covered[source] = match.group(1)
    return covered, twice


def check_tests(root, files):
    """Every source has a test of its name, or a row in test/README.md."""
    readme = "test/README.md"
    covered, twice = read_covered(root / readme)
    problems = [f"{readme}: {source} stands there twice" for source in twice]
    sources = [f for f in files if f.endswith(".cpp") and not f.startswith((EVERYWHERE, TEMPLATES))]
    for source in sources:
        stem = pathlib.PurePath(source).stem
        own = [f"test/{test_folder(source)}/{stem}_test{end}".replace("//", "/") for end in (".cpp", ".py")]
        has_own = any((root / test).is_file() for test in own)
        if not has_own and source not in covered:
            problems.append(f"{source}: no {own[0]}, and no row in {readme} names the test that covers it")
        elif has_own and source in covered:
            problems.append(f"{readme}: {source} has a test of its own; remove it from the table")
    for source, test in covered.items():
        if source not in sources:
            problems.append(f"{readme}: {source} is not there")
        if not (root / "test" / test).is_file():
            problems.append(f"{readme}: test/{test}, which is to cover {source}, is not there")
    return problems


def check(root, build=None):
    """All problems of a tree, in words."""
    rooms = read_rooms(root / "lib" / "README.md")
    files = code_files(root)
    problems, graph = check_includes(root, rooms, files)
    problems += check_rooms(rooms, files)
    problems += check_hdf5(root, files)
    problems += check_simd(root, files)
    problems += check_tests(root, files)
    problems += find_circles(graph)
    if build:
        problems += check_headers(root, files, build)
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--build", type=pathlib.Path, help="build folder: headers are compiled alone, too")
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    try:
        problems = check(root, read_build(root, arguments.build.resolve()) if arguments.build else None)
    except Problem as problem:
        problems = [str(problem)]
    for problem in problems:
        print(problem)
    print(f"{len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
