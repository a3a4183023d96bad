"""The architecture check finds every kind of planted fault, and says nothing about a tree without one.

Usage: architecture_test.py COMPILER
"""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import architecture  # pylint: disable=wrong-import-position

README = """# The rooms
| room | what lives there |
|---|---|
| `bench/` | programs |
| `lib/sixdof/upper/` | uses lower |
| `lib/sixdof/lower/` | uses nothing |
| `test/` | tests |
"""

TREE = {
    "lib/README.md": README,
    "bench/main.cpp": '#include "bench/words.h"\n#include <sixdof/upper/b.h>\n#include <vector>\n',
    "bench/words.h": "#pragma once\n",
    "lib/sixdof/upper/b.h": "#pragma once\n#include <sixdof/lower/a.h>\ninline A twice(A a) { return {2 * a.x}; }\n",
    "lib/sixdof/upper/b.cpp": "#include <sixdof/upper/b.h>\n#include <sixdof/upper/b.cpp>\n",  # as SIMD targets do
    "lib/sixdof/lower/a.h": "#pragma once\nstruct A { int x; };\n",
    "lib/sixdof/lower/part-inl.h": "Unknown part;\n",
    "test/bench/main_test.py": "",
    "test/README.md": "| test | folder | sources |\n|---|---|---|\n| `upper/all_test.cpp` | `lib/sixdof/upper/` | `b` |\n",
    "test/upper/all_test.cpp": "\n",
    "test/a_test.cpp": '#include "helper.h"\n#include <sixdof/upper/b.h>\n',
    "test/helper.h": "#pragma once\n",
}

COMPILER = "c++"


class Architecture(unittest.TestCase):
    def check(self, changes, build=None, tested=True):
        """Problems of the valid tree with some files changed (None: removed); new sources have a test if `tested`."""
        tests = {f"test/{architecture.test_folder(name)}/{pathlib.PurePath(name).stem}_test.cpp": "\n"
                 for name in changes if tested and name.startswith(("lib/", "bench/")) and name.endswith(".cpp")}
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {**TREE, **tests, **changes}.items():
                if text is None:
                    continue
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return architecture.check(root, build)

    def expect(self, changes, *words, build=None, tested=True):
        problems = self.check(changes, build, tested)
        self.assertEqual(len(problems), 1, problems)
        for word in words:
            self.assertIn(word, problems[0])

    def test_a_tree_without_faults(self):
        self.assertEqual(self.check({}, architecture.Build([COMPILER], set())), [])

    def test_a_source_without_a_test(self):
        self.expect({"lib/sixdof/lower/c.cpp": "\n"}, "lib/sixdof/lower/c.cpp", "test/lower/c_test.cpp", "no row", tested=False)
        self.assertEqual(self.check({"lib/sixdof/lower/c.cpp": "\n", "test/lower/c_test.cpp": "\n"}, tested=False), [])
        self.expect({"bench/cli/c.cpp": "\n", "test/bench/c_test.cpp": "\n"}, "bench/cli/c.cpp", "test/cli/c_test.cpp",
                    tested=False)
        self.assertEqual(self.check({"bench/new_algorithm/c.cpp": "\n"}, tested=False), [])

    def test_a_row_that_is_wrong(self):
        table = TREE["test/README.md"]
        self.expect({"test/README.md": table.replace("`b`", "`b` `c`")}, "lib/sixdof/upper/c.cpp", "not there")
        self.expect({"test/upper/all_test.cpp": None}, "test/upper/all_test.cpp", "not there")
        self.expect({"test/upper/b_test.cpp": "\n"}, "upper/b.cpp", "test of its own")
        self.expect({"test/README.md": table.replace("`b`", "`b` `b`")}, "upper/b.cpp", "twice")

    def test_hdf5_elsewhere_and_ignored(self):
        file = "lib/sixdof/base/hdf5.cpp"
        rooms = {"lib/README.md": README.replace("| `test/`", "| `lib/sixdof/base/` | files |\n| `test/`")}
        self.expect({**rooms, file: "void f(long id) {\n  H5Dclose(id);\n}\n"}, f"{file}:2", "ignores", "H5Dclose")
        self.expect({**rooms, file: "void f(long id) {\n  static_cast<void>(H5Pset_shuffle(id));\n}\n"}, "ignores")
        self.assertEqual(self.check({**rooms, file: "void f(long id) {\n  check(H5Dclose(id));\n}\n"}), [])
        self.expect({"lib/sixdof/lower/a.cpp": "bool f(long id) { return H5Dclose(id) < 0; }\n"}, "a.cpp:1", "calls HDF5")

    def test_simd_that_arm_does_not_compile(self):
        loop = "#include <hwy/foreach_target.h>\n"
        self.expect({"lib/sixdof/lower/c.cpp": loop}, "lib/sixdof/lower/c.cpp:1", "simd_targets.h")
        header = {"lib/sixdof/base/simd_targets.h": "#pragma once\n",
                  "lib/README.md": README.replace("| `test/`", "| `lib/sixdof/base/` | files |\n| `test/`")}
        targets = "#include <sixdof/base/simd_targets.h>\n"
        self.expect({**header, "lib/sixdof/lower/a.cpp": loop + targets}, "lib/sixdof/lower/a.cpp:1", "before it")
        call = "int f() { return HWY_DYNAMIC_DISPATCH(inner::g)(1); }\n"
        self.expect({**header, "lib/sixdof/lower/a.cpp": targets + loop + call}, "lib/sixdof/lower/a.cpp:3", "qualified")

    def test_a_room_above(self):
        self.expect({"lib/sixdof/lower/c.h": "#pragma once\n#include <sixdof/upper/d.h>\n",
                     "lib/sixdof/upper/d.h": "#pragma once\n"}, "lib/sixdof/lower/c.h:2", "lib/sixdof/upper/", "above")

    def test_a_program_from_a_room(self):
        self.expect({"lib/sixdof/lower/c.cpp": '#include "bench/words.h"\n'}, "lib/sixdof/lower/c.cpp:1", "bench/words.h")

    def test_a_test_from_a_room(self):
        self.expect({"lib/sixdof/lower/c.cpp": '#include "test/helper.h"\n'}, "lib/sixdof/lower/c.cpp:1", "test/helper.h")

    def test_a_file_that_is_not_there(self):
        self.expect({"lib/sixdof/upper/c.cpp": "\n#include <sixdof/lower/none.h>\n"}, "c.cpp:2", "not there")

    def test_a_room_that_the_table_does_not_name(self):
        self.expect({"lib/sixdof/new/c.cpp": "\n"}, "lib/sixdof/new/c.cpp", "no room")

    def test_a_room_without_code(self):
        self.expect({"lib/README.md": README + "| `lib/sixdof/ghost/` | nobody |\n"}, "lib/sixdof/ghost/", "no code")

    def test_a_circle(self):
        self.expect({"lib/sixdof/lower/c.h": "#pragma once\n#include <sixdof/lower/d.h>\n",
                     "lib/sixdof/lower/d.h": "#pragma once\n#include <sixdof/lower/e.h>\n",
                     "lib/sixdof/lower/e.h": "#pragma once\n#include <sixdof/lower/c.h>\n"},
                    "circle", "c.h", "d.h", "e.h")

    def test_a_header_that_needs_another(self):
        self.expect({"lib/sixdof/upper/c.h": "#pragma once\ninline A none() { return {0}; }\n"},
                    "lib/sixdof/upper/c.h", "does not compile alone", build=architecture.Build([COMPILER], set()))

    def test_a_header_that_its_source_includes_second(self):
        self.expect({"lib/sixdof/upper/c.h": "#pragma once\ninline A none() { return {0}; }\n",
                     "lib/sixdof/upper/c.cpp": "#include <sixdof/lower/a.h>\n#include <sixdof/upper/c.h>\n"},
                    "lib/sixdof/upper/c.h", "does not compile alone",
                    build=architecture.Build([COMPILER], {"lib/sixdof/upper/c.cpp"}))

    def test_a_header_whose_source_is_not_built(self):
        self.expect({"lib/sixdof/upper/c.h": "#pragma once\ninline A none() { return {0}; }\n",
                     "lib/sixdof/upper/c.cpp": "#include <sixdof/upper/c.h>\n"},
                    "lib/sixdof/upper/c.h", "does not compile alone", build=architecture.Build([COMPILER], set()))

    def test_a_header_that_the_build_has_compiled_is_not_compiled_again(self):
        sources = {file for file in TREE if file.endswith(".cpp")} | {"lib/sixdof/lower/a.cpp", "bench/words.cpp"}
        changes = {"lib/sixdof/lower/a.cpp": "#include <sixdof/lower/a.h>\n",
                   "bench/words.cpp": '#include "bench/words.h"\n'}
        self.assertEqual(self.check(changes, architecture.Build(["/no/such/compiler"], sources)), [])

    def test_a_build_without_commands(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(architecture.Problem):
            architecture.read_build(pathlib.Path(folder), pathlib.Path(folder))

    def test_a_map_without_a_table(self):
        with self.assertRaises(architecture.Problem):
            self.check({"lib/README.md": "# The rooms\n"})


if __name__ == "__main__":
    if len(sys.argv) > 1:
        COMPILER = sys.argv.pop(1)
    unittest.main()
