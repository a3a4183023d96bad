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
    "test/a_test.cpp": '#include "helper.h"\n#include <sixdof/upper/b.h>\n',
    "test/helper.h": "#pragma once\n",
}

COMPILER = "c++"


class Architecture(unittest.TestCase):
    def check(self, changes, compile_headers=False):
        """Problems of the sound tree with some files changed (None: removed)."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {**TREE, **changes}.items():
                if text is None:
                    continue
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return architecture.check(root, [COMPILER] if compile_headers else None, root / "work")

    def expect(self, changes, *words, compile_headers=False):
        problems = self.check(changes, compile_headers)
        self.assertEqual(len(problems), 1, problems)
        for word in words:
            self.assertIn(word, problems[0])

    def test_a_tree_without_faults(self):
        self.assertEqual(self.check({}, compile_headers=True), [])

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
                    "lib/sixdof/upper/c.h", "does not compile alone", compile_headers=True)

    def test_a_map_without_a_table(self):
        with self.assertRaises(architecture.Problem):
            self.check({"lib/README.md": "# The rooms\n"})


if __name__ == "__main__":
    if len(sys.argv) > 1:
        COMPILER = sys.argv.pop(1)
    unittest.main()
